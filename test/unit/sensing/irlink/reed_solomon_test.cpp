#include "../src/sensing/irlink/reed_solomon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

extern "C" {
#include <fec.h>
}

namespace lodestar {
namespace {

/// The last 46 octets of a word of the full code that holds zeros but for `errors` octets of its first 209: with the
/// padding that a shortened word stands for, a word with `errors` errors, none of them among the octets sent.
ReedSolomon::Octets errors_in_the_padding(int errors) {
  const std::unique_ptr<void, void (*)(void*)> full(init_rs_char(8, 0x11D, 0, 1, ReedSolomon::kParityOctets, 0),
                                                    free_rs_char);
  std::array<std::uint8_t, 255> word{};
  for (int i = 0; i < errors; ++i) word[static_cast<std::size_t>(40 * i)] = static_cast<std::uint8_t>(17 + i);
  encode_rs_char(full.get(), word.data(), word.data() + word.size() - ReedSolomon::kParityOctets);
  ReedSolomon::Octets octets{};
  std::copy(word.end() - static_cast<std::ptrdiff_t>(octets.size()), word.end(), octets.begin());
  return octets;
}

TEST(ReedSolomon, errors_in_the_padding_are_not_mended) {
  for (int errors = 1; errors <= ReedSolomon::kMostErrors; ++errors) {
    ReedSolomon::Octets octets = errors_in_the_padding(errors);
    EXPECT_FALSE(ReedSolomon().correct(octets)) << errors;
  }
}

TEST(ReedSolomon, a_word_of_the_code_has_nothing_to_mend) {
  ReedSolomon::Octets octets = errors_in_the_padding(0);
  EXPECT_EQ(ReedSolomon().correct(octets), 0);
  octets[3] = 9;
  ReedSolomon().add_parity(octets);
  EXPECT_EQ(ReedSolomon().correct(octets), 0);
}

}  // namespace
}  // namespace lodestar
