#pragma once

#include <string>

namespace lodestar {

/// Whether the text is a GS1 Serial Shipping Container Code: 18 digits, the last of them the check digit of the others.
/// Source: GS1 General Specifications, 7.9.1 (check digit, modulo 10 with weights 3 and 1).
bool is_sscc(const std::string& text);

}  // namespace lodestar
