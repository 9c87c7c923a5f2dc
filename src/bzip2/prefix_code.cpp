#include "prefix_code.hpp"

#include <algorithm>

namespace lodestar::bzip2 {

bool PrefixCode::set(const std::vector<std::uint8_t>& lengths) {
  short_.fill(0);
  symbols_.clear();
  std::uint32_t code = 0;
  for (unsigned length = 1; length <= kMaxLength; ++length) {
    code <<= 1;
    offset_[length] = static_cast<std::uint32_t>(symbols_.size()) - code;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (lengths[i] != length) continue;
      if (code >> length) return false;
      const unsigned symbol = i + 1 == lengths.size() ? kEndOfBlock : static_cast<unsigned>(i);
      symbols_.push_back(static_cast<std::uint16_t>(symbol));
      if (length <= kShort) {
        const auto first = short_.begin() + (code << (kShort - length));
        std::fill(first, first + (1 << (kShort - length)), static_cast<std::uint16_t>(symbol << 5 | length));
      }
      ++code;
    }
    limit_[length] = code << (kMaxLength - length);
  }
  return true;
}

unsigned PrefixCode::decode_long(BitReader& bits) const {
  const std::uint32_t code = bits.peek(kMaxLength);
  for (unsigned length = kShort + 1; length <= kMaxLength; ++length) {
    if (code >= limit_[length]) continue;
    bits.skip(length);
    return symbols_[offset_[length] + (code >> (kMaxLength - length))];
  }
  bits.skip(kMaxLength);  // read all the same, so that a cut stream is told as such
  return kNone;
}

}  // namespace lodestar::bzip2
