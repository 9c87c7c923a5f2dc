#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace lodestar::bzip2 {

/// Expands runs: four equal bytes are followed by one that says how many more there are.
/// @param room bytes that there are at `out`
/// @returns bytes written; empty: more than the room, or a run without its length
std::optional<std::size_t> expand_runs(const std::uint8_t* text, std::size_t size, std::uint8_t* out, std::size_t room);

}  // namespace lodestar::bzip2
