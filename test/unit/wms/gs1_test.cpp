#include "lodestar/wms/gs1.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/measurement/sscc.hpp"

namespace lodestar {
namespace {

TEST(Gs1, CheckDigits) {
  EXPECT_TRUE(is_sscc("106141412345678908"));  // GS1 General Specifications, figure on SSCC
  EXPECT_FALSE(is_sscc("106141412345678907"));
  EXPECT_FALSE(is_sscc("10614141234567890"));
  EXPECT_FALSE(is_sscc("10614141234567890x"));
  EXPECT_FALSE(is_sscc(""));
  EXPECT_TRUE(valid_gln("4012345000115"));
  EXPECT_FALSE(valid_gln("4012345000116"));
}

TEST(Gs1, OneWrongDigitIsAlwaysFound) {
  const std::string good = "106141412345678908";
  for (std::size_t i = 0; i < good.size(); ++i)
    for (char digit = '0'; digit <= '9'; ++digit) {
      std::string text = good;
      text[i] = digit;
      EXPECT_EQ(is_sscc(text), text == good) << text;
    }
}

TEST(Gs1, WhatLabelsMayHoldAndMayNot) {
  for (const char* bad : {"'; DROP TABLE event; --", "<script>alert(1)</script>", " 106141412345678908", "1\n"})
    EXPECT_FALSE(is_sscc(bad)) << bad;
  EXPECT_FALSE(valid_giai("truck 7"));
  EXPECT_TRUE(valid_giai("4012345TRUCK-7"));
  EXPECT_FALSE(valid_giai(std::string(31, '1')));
  EXPECT_TRUE(valid_gln_extension("A-01/2"));
  EXPECT_FALSE(valid_gln_extension(""));
  EXPECT_FALSE(valid_gln_extension(std::string(21, 'A')));
  EXPECT_FALSE(valid_gln_extension("Tor 3"));
  EXPECT_TRUE(valid_uuid("00000000-0000-4000-8000-00000000002a"));
  EXPECT_FALSE(valid_uuid("00000000-0000-4000-8000-00000000002A"));
  EXPECT_FALSE(valid_uuid(std::string(10240, 'a')));
}

TEST(Gs1, UrisAreCanonicalAndEncoded) {
  EXPECT_EQ(sscc_uri("106141412345678908"), "https://id.gs1.org/00/106141412345678908");
  EXPECT_EQ(giai_uri("4012345(7)"), "https://id.gs1.org/8004/4012345%287%29");
  EXPECT_EQ(place_uri("4012345000115", "A/1"), "https://id.gs1.org/414/4012345000115/254/A%2F1");
  EXPECT_EQ(uuid_uri("x"), "urn:uuid:x");
}

}  // namespace
}  // namespace lodestar
