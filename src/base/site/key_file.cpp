#include "key_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace lodestar {

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<std::array<std::uint8_t, 16>> read_key_file(const std::string& path, std::string& why) {
  std::error_code error;
  std::ifstream stream;
  if (std::filesystem::is_regular_file(path, error)) stream.open(path);
  if (!stream.is_open()) {
    why = "cannot be read: check the path and the rights";
    return std::nullopt;
  }
  std::string digits;
  std::string more;
  stream >> digits >> more;
  const bool hex = std::all_of(digits.begin(), digits.end(), [](char c) { return hex_digit(c) >= 0; });
  if (digits.size() != 32 || !hex || !more.empty()) {
    why = "does not hold a key: give 32 hex digits, as `openssl rand -hex 16` prints them";
    return std::nullopt;
  }
  std::array<std::uint8_t, 16> key{};
  for (std::size_t i = 0; i < key.size(); ++i)
    key[i] = static_cast<std::uint8_t>(hex_digit(digits[2 * i]) * 16 + hex_digit(digits[2 * i + 1]));
  return key;
}

}  // namespace lodestar
