#include "lodestar/base/measurement/sscc.hpp"

#include <algorithm>

namespace lodestar {

char sscc_check_digit(const std::string& first_digits) {
  int sum = 0;
  for (std::size_t i = 0; i < first_digits.size(); ++i) sum += (first_digits[i] - '0') * (i % 2 == 0 ? 3 : 1);
  return static_cast<char>('0' + (10 - sum % 10) % 10);
}

bool is_sscc(const std::string& text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return text.size() == kSsccDigits && std::all_of(text.begin(), text.end(), is_digit) &&
         text.back() == sscc_check_digit(text.substr(0, kSsccDigits - 1));
}

}  // namespace lodestar
