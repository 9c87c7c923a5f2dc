#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "lodestar/base/common/result.hpp"

namespace lodestar {

enum class Bzip2Fault {
  kMagic,       ///< not bzip2, or something else behind it
  kTruncated,   ///< ends before its end mark
  kRandomised,  ///< blocks of bzip2 before 0.9.5 (1999), which nothing writes any more
  kDamaged,     ///< codes, moves or an origin that no compressor writes
  kChecksum,    ///< a block or the whole does not have its CRC
  kSize,        ///< longer or shorter than it is said to be
  kCount
};
const char* name(Bzip2Fault fault);

/// Compressed bytes; whoever made them keeps them alive.
struct Bzip2Packed {
  const std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  std::size_t unpacked_size = 0;  ///< of all its streams together
};

using Bzip2Unpacked = Result<std::vector<std::uint8_t>, Bzip2Fault>;

/// Unpacks bzip2, several blocks side by side on one thread: undoing the Burrows-Wheeler transform is a walk of loads
/// that wait for each other and mostly miss the cache, so libbz2, which walks one block at a time, waits for memory.
/// Takes what bunzip2 takes (streams one after the other included) but randomised blocks.
/// Format: https://github.com/dsnet/compress/blob/master/doc/bzip2-format.pdf
class Bzip2Unpacker {
 public:
  /// Blocks that are unpacked side by side; so many inputs at once are the quickest.
  static constexpr std::size_t kLanes = 8;

  Bzip2Unpacker();
  ~Bzip2Unpacker();

  /// In the order of the inputs. Keeps up to 4.6 MB of work space for each lane until destroyed.
  std::vector<Bzip2Unpacked> unpack(const std::vector<Bzip2Packed>& inputs);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodestar
