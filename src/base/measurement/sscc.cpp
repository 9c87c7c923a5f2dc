#include "lodestar/base/measurement/sscc.hpp"

#include <algorithm>

namespace lodestar {

char gs1_check_digit(const std::string& first_digits) {
  int sum = 0;
  int weight = 3;
  for (auto digit = first_digits.rbegin(); digit != first_digits.rend(); ++digit, weight = 4 - weight)
    sum += (*digit - '0') * weight;
  return static_cast<char>('0' + (10 - sum % 10) % 10);
}

bool is_sscc(const std::string& text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return text.size() == kSsccDigits && std::all_of(text.begin(), text.end(), is_digit) &&
         text.back() == gs1_check_digit(text.substr(0, kSsccDigits - 1));
}

}  // namespace lodestar
