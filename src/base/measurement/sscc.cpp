#include "lodestar/base/measurement/sscc.hpp"

#include <algorithm>

namespace lodestar {

bool is_sscc(const std::string& text) {
  constexpr std::size_t kDigits = 18;
  if (text.size() != kDigits) return false;
  if (!std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; })) return false;
  int sum = 0;
  for (std::size_t i = 0; i < kDigits; ++i) sum += (text[i] - '0') * (i % 2 == 0 ? 3 : 1);
  return sum % 10 == 0;
}

}  // namespace lodestar
