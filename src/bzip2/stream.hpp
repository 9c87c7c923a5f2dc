#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "block.hpp"
#include "lodestar/bzip2/bzip2.hpp"

namespace lodestar::bzip2 {

/// One input on its way: gives its blocks one after the other and takes their texts in the same order.
class Stream {
 public:
  explicit Stream(const Bzip2Packed& packed);

  /// @returns false: there is none any more, because of the end or a fault
  bool read_block(Block& block);
  /// @param block whose column is now the text
  void append_text(const Block& block);
  /// Once read_block() said that there is no more and all texts are appended.
  Bzip2Unpacked take();

 private:
  bool fail(Bzip2Fault fault);
  bool read_start();
  bool read_end();

  BitReader bits_;
  std::optional<Bzip2Fault> fault_;
  bool in_stream_ = false, done_ = false;
  std::size_t max_block_ = 0;
  std::uint32_t crc_ = 0;  ///< of the blocks so far
  std::vector<std::uint8_t> unpacked_;
  std::size_t size_ = 0;  ///< bytes of unpacked_ that are written
};

}  // namespace lodestar::bzip2
