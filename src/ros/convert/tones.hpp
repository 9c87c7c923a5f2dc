#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lodestar/base/measurement/tone_set.hpp"

namespace lodestar {

inline std::vector<std::uint8_t> tones_message(ToneSet tones) {
  const std::vector<int> indices = tones.indices();
  return {indices.begin(), indices.end()};
}

/// Empty: an index beyond what a tone table can hold.
inline std::optional<ToneSet> tones_from(const std::vector<std::uint8_t>& indices) {
  ToneSet tones;
  for (const int index : indices) {
    if (index >= ToneSet::kMaxTones) return std::nullopt;
    tones.insert(index);
  }
  return tones;
}

}  // namespace lodestar
