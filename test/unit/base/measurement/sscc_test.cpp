#include "lodestar/base/measurement/sscc.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

TEST(Sscc, has_the_check_digit_of_the_standard) {
  // The SSCC of the GS1 General Specifications' examples, and one from 7.9.1's own scheme worked out by hand.
  EXPECT_TRUE(is_sscc("106141412345678908"));
  EXPECT_TRUE(is_sscc("376104250021234569"));
  EXPECT_EQ(gs1_check_digit("37610425002123456"), '9');
}

TEST(Sscc, finds_every_wrong_digit_and_most_swaps) {
  const std::string good = "376104250021234569";
  for (std::size_t i = 0; i < good.size(); ++i)
    for (char c = '0'; c <= '9'; ++c) {
      std::string text = good;
      text[i] = c;
      EXPECT_EQ(is_sscc(text), text == good) << text;
    }
}

TEST(Sscc, is_eighteen_digits_and_nothing_else) {
  for (const std::string text : {"", "37610425002123456", "3761042500212345690", "37610425002123456X",
                                 " 76104250021234569", "'; DROP TABLE pal--"})
    EXPECT_FALSE(is_sscc(text)) << text;
  EXPECT_FALSE(is_sscc(std::string(10000, '0')));
}

}  // namespace
}  // namespace lodestar
