#include "lodestar/bzip2/bzip2.hpp"

#include <array>

#include "block.hpp"
#include "rotations.hpp"
#include "stream.hpp"

namespace lodestar {

using namespace bzip2;

const char* name(Bzip2Fault fault) {
  switch (fault) {
    case Bzip2Fault::kMagic:
      return "not_bzip2";
    case Bzip2Fault::kTruncated:
      return "truncated";
    case Bzip2Fault::kRandomised:
      return "randomised";
    case Bzip2Fault::kDamaged:
      return "damaged";
    case Bzip2Fault::kChecksum:
      return "wrong_checksum";
    case Bzip2Fault::kSize:
      return "wrong_size";
    case Bzip2Fault::kCount:
      break;
  }
  return "";
}

class Bzip2Unpacker::Impl {
 public:
  std::vector<Bzip2Unpacked> unpack(const std::vector<Bzip2Packed>& inputs) {
    std::vector<Bzip2Unpacked> out;
    for (auto next = inputs.begin(); next != inputs.end();) {
      std::vector<Stream> streams;
      while (next != inputs.end() && streams.size() < kLanes) streams.emplace_back(*next++);
      while (unpack_blocks(streams)) {
      }
      for (Stream& stream : streams) out.push_back(stream.take());
    }
    return out;
  }

 private:
  struct Lane {
    Block block;
    Rotations rotations;
    Stream* stream = nullptr;
  };

  /// As many blocks as there are lanes, turn by turn from each stream. False: there was none left.
  bool unpack_blocks(std::vector<Stream>& streams) {
    const std::size_t count = fill_lanes(streams);
    std::vector<Rotations*> all;
    for (std::size_t i = 0; i < count; ++i) {
      lanes_[i].rotations.link(lanes_[i].block);
      all.push_back(&lanes_[i].rotations);
    }
    Rotations::write_texts(all);
    for (std::size_t i = 0; i < count; ++i) lanes_[i].stream->append_text(lanes_[i].block);
    return count > 0;
  }

  std::size_t fill_lanes(std::vector<Stream>& streams) {
    std::size_t count = 0;
    for (bool more = true; more;) {
      more = false;
      for (Stream& stream : streams) {
        if (count == kLanes) return count;
        if (!stream.read_block(lanes_[count].block)) continue;
        lanes_[count++].stream = &stream;
        more = true;
      }
    }
    return count;
  }

  std::array<Lane, kLanes> lanes_;
};

Bzip2Unpacker::Bzip2Unpacker() : impl_(std::make_unique<Impl>()) {}
Bzip2Unpacker::~Bzip2Unpacker() = default;

std::vector<Bzip2Unpacked> Bzip2Unpacker::unpack(const std::vector<Bzip2Packed>& inputs) {
  return impl_->unpack(inputs);
}

}  // namespace lodestar
