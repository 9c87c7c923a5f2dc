#include "bag_file.hpp"

#include <ros/header.h>
#include <rosbag/chunked_file.h>
#include <rosbag/constants.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <tuple>

#include "lodestar/ros/bag/recording.hpp"

namespace lodestar {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr std::size_t kMagicSize = sizeof(kMagic) - 1;

/// Fields of a record's header, by name. Numbers are little-endian, as on every host that ROS 1 runs on.
class Fields {
 public:
  Fields(std::uint8_t* bytes, std::uint32_t size, const std::string& path) : path_(path) {
    ros::Header header;
    std::string error;
    if (!header.parse(bytes, size, error)) fail();
    values_ = header.getValues();
  }

  template <class Number>
  Number number(const std::string& name) const {
    const std::string& value = text(name);
    if (value.size() != sizeof(Number)) fail();
    Number out;
    std::memcpy(&out, value.data(), sizeof(Number));
    return out;
  }

  Stamp stamp(const std::string& name) const {
    const auto packed = number<std::uint64_t>(name);
    return Stamp(std::chrono::seconds(packed & 0xFFFFFFFFu) + std::chrono::nanoseconds(packed >> 32));
  }

  const std::string& text(const std::string& name) const {
    const auto field = values_->find(name);
    if (field == values_->end()) fail();
    return field->second;
  }

  bool has(const std::string& name) const { return values_->count(name) != 0; }

  [[noreturn]] void fail() const {
    throw RecordingError(path_ + " is damaged: a record's header cannot be read; repair it with 'rosbag reindex', " +
                         "or record it anew");
  }

 private:
  const std::string& path_;
  ros::M_stringPtr values_;
};

[[noreturn]] void fail_truncated(const std::string& path, std::uint64_t size) {
  throw RecordingError(path + " ends after " + std::to_string(size) +
                       " bytes, in the middle of its data: copy it anew, or save what is left with 'rosbag reindex'");
}

/// Takes bytes off the front of an unpacked chunk.
class Cursor {
 public:
  Cursor(std::vector<std::uint8_t>& bytes, std::uint64_t position, const std::string& path)
      : bytes_(bytes), position_(position), path_(path) {}

  bool at_end() const { return offset_ == bytes_.size(); }
  std::size_t offset() const { return offset_; }

  std::uint8_t* take(std::size_t count) {
    if (count > bytes_.size() - offset_) {
      throw RecordingError(path_ + " is damaged: the chunk at byte " + std::to_string(position_) +
                           " ends within a record; record it anew");
    }
    std::uint8_t* const taken = bytes_.data() + offset_;
    offset_ += count;
    return taken;
  }

  std::uint32_t take_size() {
    std::uint32_t size;
    std::memcpy(&size, take(sizeof(size)), sizeof(size));
    return size;
  }

 private:
  std::vector<std::uint8_t>& bytes_;
  std::uint64_t position_;
  const std::string& path_;
  std::size_t offset_ = 0;
};

rosbag::CompressionType compression_type(const PackedChunk& chunk, const std::string& path) {
  if (chunk.compression == rosbag::COMPRESSION_NONE) return rosbag::compression::Uncompressed;
  if (chunk.compression == rosbag::COMPRESSION_BZ2) return rosbag::compression::BZ2;
  if (chunk.compression == rosbag::COMPRESSION_LZ4) return rosbag::compression::LZ4;
  throw RecordingError(path + " is compressed by '" + chunk.compression +
                       "', known are none, bz2 and lz4: convert it with 'rosbag compress'");
}

[[noreturn]] void fail_compressed(const PackedChunk& chunk, const std::string& path) {
  throw RecordingError(path + " is damaged: the chunk at byte " + std::to_string(chunk.position) +
                       " cannot be decompressed; copy or record it anew");
}

/// What rosbag_storage unpacks, and what is not packed.
std::vector<std::uint8_t> bytes_of(PackedChunk& chunk, const std::string& path) {
  const rosbag::CompressionType compression = compression_type(chunk, path);
  if (compression == rosbag::compression::Uncompressed) return std::move(chunk.bytes);
  std::vector<std::uint8_t> bytes(chunk.unpacked_size);
  try {
    rosbag::ChunkedFile().decompress(compression, bytes.data(), chunk.unpacked_size, chunk.bytes.data(),
                                     static_cast<unsigned>(chunk.bytes.size()));
  } catch (const rosbag::BagException&) {
    fail_compressed(chunk, path);
  }
  return bytes;
}

std::vector<std::uint8_t> bytes_of(Bzip2Unpacked&& unpacked, const PackedChunk& chunk, const std::string& path) {
  if (unpacked) return std::move(unpacked).value();
  if (unpacked.error() == Bzip2Fault::kRandomised)
    throw RecordingError(path + " holds 'randomised' blocks, as bzip2 wrote them before 1999: convert it with " +
                         "'rosbag decompress'");
  fail_compressed(chunk, path);
}

std::vector<BagMessage> messages_of(std::vector<std::uint8_t>&& unpacked, std::uint64_t position,
                                    const std::string& path) {
  constexpr std::uint8_t kMessageData = 2;
  const auto bytes = std::make_shared<std::vector<std::uint8_t>>(std::move(unpacked));
  std::vector<BagMessage> messages;
  Cursor cursor(*bytes, position, path);
  while (!cursor.at_end()) {
    const std::uint32_t header_size = cursor.take_size();
    const Fields fields(cursor.take(header_size), header_size, path);
    const std::uint32_t data_size = cursor.take_size();
    const std::size_t offset = cursor.offset();
    cursor.take(data_size);
    if (fields.number<std::uint8_t>("op") != kMessageData) continue;
    messages.push_back({fields.stamp("time"), fields.number<std::uint32_t>("conn"), bytes, offset, data_size});
  }
  return messages;
}

}  // namespace

/// A record's header, and the size of the data that follows it.
struct BagFile::Head {
  std::vector<std::uint8_t> bytes;
  Fields fields;
  std::uint32_t data_size;
};

BagFile::BagFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  std::error_code error;
  if (!file_ || !std::filesystem::is_regular_file(path, error))
    throw RecordingError(path + " cannot be opened: give the path of a bag that exists and may be read");
  size_ = std::filesystem::file_size(path);

  std::string magic(std::min<std::uint64_t>(kMagicSize, size_), '\0');
  file_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (magic != kMagic) {
    if (magic.rfind("#ROSBAG V", 0) == 0 || magic.rfind("#ROSRECORD", 0) == 0)
      throw RecordingError(path + " is a bag of another version than 2.0: convert it with 'rosbag migrate'");
    throw RecordingError(path + " is not a bag: it does not begin with '#ROSBAG V2.0'");
  }
  read_index(read_head());
}

std::vector<std::uint8_t> BagFile::read_bytes(std::uint64_t count) {
  if (count > size_ - static_cast<std::uint64_t>(file_.tellg())) fail_truncated(path_, size_);
  std::vector<std::uint8_t> bytes(count);
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!file_) throw RecordingError(path_ + " cannot be read: the disk reports an error");
  return bytes;
}

BagFile::Head BagFile::read_head() {
  const auto read_size = [this] {
    std::uint32_t size;
    std::memcpy(&size, read_bytes(sizeof(size)).data(), sizeof(size));
    return size;
  };
  std::vector<std::uint8_t> bytes = read_bytes(read_size());
  Fields fields(bytes.data(), static_cast<std::uint32_t>(bytes.size()), path_);
  return {std::move(bytes), std::move(fields), read_size()};
}

void BagFile::read_index(const Head& bag_header) {
  if (bag_header.fields.has("encryptor") && !bag_header.fields.text("encryptor").empty())
    throw RecordingError(path_ + " is encrypted: decrypt it with 'rosbag decrypt'");
  const auto index_position = bag_header.fields.number<std::uint64_t>("index_pos");
  const auto connection_count = bag_header.fields.number<std::uint32_t>("conn_count");
  const auto chunk_count = bag_header.fields.number<std::uint32_t>("chunk_count");
  if (index_position == 0)
    throw RecordingError(path_ + " has no index, its recorder was not stopped properly: repair it with " +
                         "'rosbag reindex'");
  if (index_position > size_) fail_truncated(path_, size_);

  file_.seekg(static_cast<std::streamoff>(index_position));
  for (std::uint32_t i = 0; i < connection_count; ++i) {
    const Head head = read_head();
    std::vector<std::uint8_t> data = read_bytes(head.data_size);
    const Fields about(data.data(), head.data_size, path_);
    connections_[head.fields.number<std::uint32_t>("conn")] = {head.fields.text("topic"), about.text("type"),
                                                               about.text("md5sum")};
  }
  for (std::uint32_t i = 0; i < chunk_count; ++i) {
    const Head head = read_head();
    const std::vector<std::uint8_t> data = read_bytes(head.data_size);
    BagChunkInfo chunk;
    chunk.position = head.fields.number<std::uint64_t>("chunk_pos");
    chunk.start = head.fields.stamp("start_time");
    chunk.end = head.fields.stamp("end_time");
    for (std::size_t entry = 0; entry + 8 <= data.size(); entry += 8) {
      std::uint32_t connection, count;
      std::memcpy(&connection, data.data() + entry, 4);
      std::memcpy(&count, data.data() + entry + 4, 4);
      chunk.connections[connection] = count;
    }
    chunks_.push_back(std::move(chunk));
  }
  std::sort(chunks_.begin(), chunks_.end(), [](const BagChunkInfo& a, const BagChunkInfo& b) {
    return std::tie(a.start, a.position) < std::tie(b.start, b.position);
  });
}

PackedChunk BagFile::read_chunk(const BagChunkInfo& info) {
  if (info.position > size_) fail_truncated(path_, size_);
  file_.seekg(static_cast<std::streamoff>(info.position));
  const Head head = read_head();
  PackedChunk chunk;
  chunk.position = info.position;
  chunk.compression = head.fields.text("compression");
  chunk.unpacked_size = head.fields.number<std::uint32_t>("size");
  chunk.bytes = read_bytes(head.data_size);
  return chunk;
}

std::vector<UnpackedChunk> unpack(std::vector<PackedChunk> chunks, const std::string& path, Bzip2Unpacker& bzip2) {
  const auto is_bzip2 = [](const PackedChunk& chunk) { return chunk.compression == rosbag::COMPRESSION_BZ2; };
  std::vector<Bzip2Packed> packed;
  for (const PackedChunk& chunk : chunks)
    if (is_bzip2(chunk)) packed.push_back({chunk.bytes.data(), chunk.bytes.size(), chunk.unpacked_size});
  std::vector<Bzip2Unpacked> unpacked = bzip2.unpack(packed);

  std::vector<UnpackedChunk> out;
  auto next = unpacked.begin();
  for (PackedChunk& chunk : chunks) {
    try {
      out.push_back(messages_of(is_bzip2(chunk) ? bytes_of(std::move(*next++), chunk, path) : bytes_of(chunk, path),
                                chunk.position, path));
    } catch (const RecordingError& error) {
      out.push_back(error);
    }
  }
  return out;
}

}  // namespace lodestar
