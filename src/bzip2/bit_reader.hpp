#pragma once

#include <cstddef>
#include <cstdint>

namespace lodestar::bzip2 {

/// Bits of a byte sequence, the highest bit of a byte first. Behind the end come zeros; overrun() says that some were
/// taken, and whoever reads asks it before trusting what was read.
class BitReader {
 public:
  BitReader(const std::uint8_t* bytes, std::size_t size) : next_(bytes), end_(bytes + size) {}

  /// Afterwards peek() and skip() have at least 56 bits.
  void refill() {
    if (end_ - next_ >= 8) {
      // Bits below the counted ones are those that the next refill puts there again.
      buffer_ |= word() >> count_;
      next_ += (63 - count_) >> 3;
      count_ |= 56;
      return;
    }
    for (; count_ <= 56; count_ += 8) {
      if (next_ == end_)
        padding_ += 8;
      else
        buffer_ |= std::uint64_t{*next_++} << (56 - count_);
    }
  }

  /// @param count 1 to 56, not more than are there
  std::uint32_t peek(unsigned count) const { return static_cast<std::uint32_t>(buffer_ >> (64 - count)); }
  void skip(unsigned count) {
    buffer_ <<= count;
    count_ -= count;
  }

  /// @param count 1 to 32
  std::uint32_t read(unsigned count) {
    refill();
    const std::uint32_t bits = peek(count);
    skip(count);
    return bits;
  }
  bool read_bit() { return read(1) != 0; }

  void skip_to_byte() { skip(count_ % 8); }

  bool overrun() const { return padding_ > count_; }
  /// Nothing is left but zeros put in behind the end.
  bool at_end() const { return next_ == end_ && count_ <= padding_; }

 private:
  /// The next eight bytes, the first one highest; compilers make one load of it.
  std::uint64_t word() const {
    std::uint64_t out = 0;
    for (int i = 0; i < 8; ++i) out = out << 8 | next_[i];
    return out;
  }

  const std::uint8_t* next_;
  const std::uint8_t* end_;
  std::uint64_t buffer_ = 0;   ///< the next bit is the highest
  unsigned count_ = 0;         ///< bits in the buffer
  std::uint64_t padding_ = 0;  ///< of them or of those already taken, how many lay behind the end
};

}  // namespace lodestar::bzip2
