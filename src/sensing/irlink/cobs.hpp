#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace lodestar {

/// Consistent overhead byte stuffing, without the zero that ends a packet.
std::vector<std::uint8_t> cobs_stuffed(const std::vector<std::uint8_t>& data);

/// Empty when `stuffed` was not made by cobs_stuffed: empty itself, a zero in it, or a group that runs past its end.
std::optional<std::vector<std::uint8_t>> cobs_unstuffed(const std::vector<std::uint8_t>& stuffed);

}  // namespace lodestar
