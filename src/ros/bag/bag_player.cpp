#include "bag_player.hpp"

#include <algorithm>

namespace lodestar {

BagPlayer::BagPlayer(BagFile& file, std::set<std::uint32_t> connections, int threads)
    : file_(file), connections_(std::move(connections)), ahead_(static_cast<std::size_t>(threads)) {
  std::copy_if(file.chunks().begin(), file.chunks().end(), std::back_inserter(chunks_),
               [this](const BagChunkInfo& chunk) {
                 return std::any_of(connections_.begin(), connections_.end(),
                                    [&chunk](std::uint32_t connection) { return chunk.connections.count(connection); });
               });
}

void BagPlayer::unpack_ahead() {
  for (; unpacking_.size() < ahead_ && started_ < chunks_.size(); ++started_) {
    unpacking_.push_back(
        std::async(std::launch::async, [chunk = file_.read_chunk(chunks_[started_]), &path = file_.path()]() mutable {
          return unpack(std::move(chunk), path);
        }));
  }
}

void BagPlayer::take_chunk() {
  unpack_ahead();
  std::future<std::vector<BagMessage>> chunk = std::move(unpacking_.front());
  unpacking_.pop_front();
  ++taken_;
  unpack_ahead();
  std::vector<BagMessage> messages = chunk.get();
  for (BagMessage& message : messages)
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
