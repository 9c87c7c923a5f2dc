#include "stream.hpp"

#include "crc.hpp"
#include "runs.hpp"

namespace lodestar::bzip2 {
namespace {

constexpr std::uint64_t kBlockMagic = 0x314159265359, kEndMagic = 0x177245385090;

}  // namespace

Stream::Stream(const Bzip2Packed& packed) : bits_(packed.bytes, packed.size), unpacked_(packed.unpacked_size) {}

bool Stream::fail(Bzip2Fault fault) {
  if (!fault_) fault_ = fault;
  return false;
}

bool Stream::read_start() {
  const std::uint32_t magic = bits_.read(24), level = bits_.read(8) - '0';
  if (bits_.overrun()) return fail(Bzip2Fault::kTruncated);
  if (magic != 0x425A68 /* BZh */ || level < 1 || level > 9) return fail(Bzip2Fault::kMagic);
  max_block_ = level * 100000;
  crc_ = 0;
  in_stream_ = true;
  return true;
}

bool Stream::read_end() {
  const std::uint32_t crc = bits_.read(32);
  if (bits_.overrun()) return fail(Bzip2Fault::kTruncated);
  if (crc != crc_) return fail(Bzip2Fault::kChecksum);
  bits_.skip_to_byte();
  in_stream_ = false;
  done_ = bits_.at_end();
  return true;
}

bool Stream::read_block(Block& block) {
  while (!fault_ && !done_) {
    if (!in_stream_ && !read_start()) return false;
    const std::uint64_t magic = std::uint64_t{bits_.read(24)} << 24 | bits_.read(24);
    if (magic == kBlockMagic) {
      if (const auto fault = bzip2::read_block(bits_, max_block_, block)) return fail(*fault);
      crc_ = (crc_ << 1 | crc_ >> 31) ^ block.crc;
      return true;
    }
    if (magic != kEndMagic) return fail(bits_.overrun() ? Bzip2Fault::kTruncated : Bzip2Fault::kDamaged);
    read_end();
  }
  return false;
}

void Stream::append_text(const Block& block) {
  if (fault_) return;
  std::uint8_t* const begin = unpacked_.data() + size_;
  const auto size = expand_runs(block.column.data(), block.size, begin, unpacked_.size() - size_);
  if (!size)
    fail(Bzip2Fault::kSize);
  else if (crc_of(begin, *size) != block.crc)
    fail(Bzip2Fault::kChecksum);
  else
    size_ += *size;
}

Bzip2Unpacked Stream::take() {
  if (!fault_ && size_ != unpacked_.size()) fault_ = Bzip2Fault::kSize;
  if (fault_) return *fault_;
  return std::move(unpacked_);
}

}  // namespace lodestar::bzip2
