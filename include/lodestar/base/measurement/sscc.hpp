#pragma once

#include <string>

namespace lodestar {

constexpr std::size_t kSsccDigits = 18;

/// The last digit of an SSCC or another GS1 key of digits, from those before it.
/// Source: GS1 General Specifications, 7.9.1 (modulo 10, weights 3 and 1 from the right).
char gs1_check_digit(const std::string& first_digits);

/// Whether the text is a GS1 Serial Shipping Container Code: 18 digits, the last of them the check digit of the others.
bool is_sscc(const std::string& text);

}  // namespace lodestar
