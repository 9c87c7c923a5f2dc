#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/bzip2/bzip2.hpp"
#include "lodestar/ros/bag/recording.hpp"

namespace lodestar {

/// One topic of a bag, from one publisher.
struct BagConnection {
  std::string topic, type, md5;
};

/// Where a chunk lies in the file, and what its index says of it.
struct BagChunkInfo {
  std::uint64_t position = 0;
  Stamp start, end;                                    ///< reception times of its first and last message
  std::map<std::uint32_t, std::uint32_t> connections;  ///< messages of each connection
};

/// A chunk as it lies in the file.
struct PackedChunk {
  std::uint64_t position = 0;
  std::string compression;
  std::uint32_t unpacked_size = 0;
  std::vector<std::uint8_t> bytes;
};

/// A message in an unpacked chunk. `bytes` keeps the chunk alive.
struct BagMessage {
  Stamp received;
  std::uint32_t connection = 0;
  std::shared_ptr<std::vector<std::uint8_t>> bytes;
  std::size_t offset = 0;
  std::uint32_t size = 0;
};

/// A bag of format 2.0, chunk by chunk. rosbag::View keeps one unpacked chunk only and unpacks anew whenever messages
/// of two chunks interleave, which doubles the cost of a compressed bag, and it cannot unpack in parallel.
/// Format: http://wiki.ros.org/Bags/Format/2.0
class BagFile {
 public:
  /// @throws RecordingError
  explicit BagFile(const std::string& path);

  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  /// By start, then by place in the file.
  const std::vector<BagChunkInfo>& chunks() const { return chunks_; }

  /// @throws RecordingError
  PackedChunk read_chunk(const BagChunkInfo& info);

  const std::string& path() const { return path_; }

 private:
  struct Head;
  Head read_head();
  std::vector<std::uint8_t> read_bytes(std::uint64_t count);
  void read_index(const Head& bag_header);

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<BagChunkInfo> chunks_;
};

/// The messages of a chunk in the order of the file, or why it cannot be unpacked.
using UnpackedChunk = Result<std::vector<BagMessage>, RecordingError>;

/// Unpacks chunks together, in their order. Safe to call from several threads, each with its own `bzip2`.
/// @param path for the errors' text alone
std::vector<UnpackedChunk> unpack(std::vector<PackedChunk> chunks, const std::string& path, Bzip2Unpacker& bzip2);

}  // namespace lodestar
