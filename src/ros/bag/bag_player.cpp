#include "bag_player.hpp"

#include <algorithm>

namespace lodestar {

BagPlayer::BagPlayer(BagFile& file, std::set<std::uint32_t> connections, int threads)
    : file_(file), connections_(std::move(connections)), bzip2_(static_cast<std::size_t>(threads)) {
  std::copy_if(file.chunks().begin(), file.chunks().end(), std::back_inserter(chunks_),
               [this](const BagChunkInfo& chunk) {
                 return std::any_of(connections_.begin(), connections_.end(),
                                    [&chunk](std::uint32_t connection) { return chunk.connections.count(connection); });
               });
}

std::vector<PackedChunk> BagPlayer::read_group() {
  constexpr std::size_t kMaxBytes = 16'000'000;  // unpacked, unless one chunk is larger
  std::vector<PackedChunk> group;
  for (std::size_t bytes = 0; read_ < chunks_.size() && group.size() < Bzip2Unpacker::kLanes && bytes < kMaxBytes;) {
    group.push_back(file_.read_chunk(chunks_[read_++]));
    bytes += group.back().unpacked_size;
  }
  return group;
}

void BagPlayer::unpack_ahead() {
  // Groups are taken in the order in which they were begun, so that the unpacker whose turn it is has nothing to do.
  for (; unpacking_.size() < bzip2_.size() && read_ < chunks_.size(); ++begun_) {
    unpacking_.push_back(std::async(std::launch::async, [group = read_group(), &path = file_.path(),
                                                         &bzip2 = bzip2_[begun_ % bzip2_.size()]]() mutable {
      return unpack(std::move(group), path, bzip2);
    }));
  }
}

void BagPlayer::take_group() {
  unpack_ahead();
  for (UnpackedChunk& chunk : unpacking_.front().get()) unpacked_.push_back(std::move(chunk));
  unpacking_.pop_front();
  unpack_ahead();
}

void BagPlayer::take_chunk() {
  if (unpacked_.empty()) take_group();
  UnpackedChunk chunk = std::move(unpacked_.front());
  unpacked_.pop_front();
  ++taken_;
  if (!chunk) throw chunk.error();
  for (BagMessage& message : std::move(chunk).value())
    if (connections_.count(message.connection)) queue_.push({std::move(message), order_++});
}

std::optional<BagMessage> BagPlayer::next() {
  // A chunk may hold something older than what is at hand only if it begins before that.
  while (taken_ < chunks_.size() && (queue_.empty() || chunks_[taken_].start < queue_.top().message.received))
    take_chunk();
  if (queue_.empty()) return std::nullopt;
  BagMessage message = queue_.top().message;
  queue_.pop();
  return message;
}

}  // namespace lodestar
