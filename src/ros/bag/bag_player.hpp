#pragma once

#include <deque>
#include <future>
#include <optional>
#include <queue>
#include <set>
#include <tuple>
#include <vector>

#include "bag_file.hpp"

namespace lodestar {

/// The messages of some connections in the order of reception. Each chunk is unpacked once, together with those after
/// it, on threads that work a bounded way ahead: at most a group each, of at most 16 MB and one chunk.
class BagPlayer {
 public:
  /// @param file outlives the player and is read by nobody else meanwhile
  /// @param threads that unpack, >= 1
  BagPlayer(BagFile& file, std::set<std::uint32_t> connections, int threads);

  /// Empty at the end.
  /// @throws RecordingError: a chunk is damaged
  std::optional<BagMessage> next();

 private:
  struct Queued {
    BagMessage message;
    std::uint64_t order;  ///< settles equal times: the order of the file
    friend bool operator<(const Queued& a, const Queued& b) {
      return std::tie(b.message.received, b.order) < std::tie(a.message.received, a.order);
    }
  };

  std::vector<PackedChunk> read_group();
  void unpack_ahead();
  void take_group();
  void take_chunk();

  BagFile& file_;
  std::set<std::uint32_t> connections_;
  std::vector<BagChunkInfo> chunks_;  ///< that hold one of the connections
  std::size_t read_ = 0, taken_ = 0;
  std::deque<UnpackedChunk> unpacked_;
  std::vector<Bzip2Unpacker> bzip2_;  ///< one for each thread; outlives the threads' work
  std::size_t begun_ = 0;             ///< groups
  std::deque<std::future<std::vector<UnpackedChunk>>> unpacking_;
  std::priority_queue<Queued> queue_;
  std::uint64_t order_ = 0;
};

}  // namespace lodestar
