#include "cobs.hpp"

#include <algorithm>

namespace lodestar {

namespace {
constexpr std::uint8_t kFullGroup = 0xFF;  // 254 bytes, and no zero behind them
}

std::vector<std::uint8_t> cobs_stuffed(const std::vector<std::uint8_t>& data) {
  std::vector<std::uint8_t> out{1};
  std::size_t code_at = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (data[i] != 0) {
      out.push_back(data[i]);
      if (++out[code_at] < kFullGroup || i + 1 == data.size()) continue;
    }
    code_at = out.size();
    out.push_back(1);
  }
  return out;
}

std::optional<std::vector<std::uint8_t>> cobs_unstuffed(const std::vector<std::uint8_t>& stuffed) {
  if (stuffed.empty() || std::find(stuffed.begin(), stuffed.end(), 0) != stuffed.end()) return std::nullopt;
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < stuffed.size();) {
    const std::uint8_t code = stuffed[i];
    const std::size_t next = i + code;
    if (next > stuffed.size()) return std::nullopt;
    out.insert(out.end(), stuffed.begin() + static_cast<std::ptrdiff_t>(i + 1),
               stuffed.begin() + static_cast<std::ptrdiff_t>(next));
    if (code < kFullGroup && next < stuffed.size()) out.push_back(0);
    i = next;
  }
  return out;
}

}  // namespace lodestar
