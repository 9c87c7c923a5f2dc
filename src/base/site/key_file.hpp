#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace lodestar {

/// The site's key from a file of 32 hex digits (white space around them is fine), or empty with the reason in `why`,
/// which never says what the file holds.
std::optional<std::array<std::uint8_t, 16>> read_key_file(const std::string& path, std::string& why);

}  // namespace lodestar
