#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace lodestar::bzip2 {

/// The move-to-front list: bytes, the last used one first. The first eight lie in one word, because most moves are
/// short and their lengths cannot be foretold: shifts and masks cost less than a loop's wrong guesses.
class FrontList {
 public:
  static constexpr unsigned kNear = 8;

  /// @param bytes at most 256
  explicit FrontList(const std::vector<std::uint8_t>& bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      if (i < kNear)
        near_ |= std::uint64_t{bytes[i]} << (8 * i);
      else
        far_[i - kNear] = bytes[i];
    }
  }

  /// @param place < kNear
  std::uint8_t take_near(unsigned place) {
    const unsigned shift = 8 * place;
    const std::uint64_t byte = near_ >> shift & 0xFF;
    const std::uint64_t moved = ~std::uint64_t{0} >> (56 - shift);
    near_ = (near_ & ~moved) | (near_ << 8 & moved) | byte;
    return static_cast<std::uint8_t>(byte);
  }

  /// @param place kNear to 255
  std::uint8_t take_far(unsigned place) {
    const std::uint8_t byte = far_[place - kNear];
    std::memmove(far_.data() + 1, far_.data(), place - kNear);
    far_[0] = static_cast<std::uint8_t>(near_ >> 56);
    near_ = near_ << 8 | byte;
    return byte;
  }

 private:
  std::uint64_t near_ = 0;  ///< the first byte lowest
  std::array<std::uint8_t, 256 - kNear> far_{};
};

}  // namespace lodestar::bzip2
