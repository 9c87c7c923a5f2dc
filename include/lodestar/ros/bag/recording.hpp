#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/measurement/image.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/base/measurement/ir_samples.hpp"
#include "lodestar/base/measurement/load.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pallet.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/base/measurement/sighting.hpp"

namespace lodestar {

/// A bag that cannot be read or written; what() says which file, what is wrong and the way out.
struct RecordingError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Topic names of the interfaces page.
struct RecordingTopics {
  std::string image = "/camera/image_raw";
  std::string camera_info = "/camera/camera_info";
  std::string imu = "/imu/data";
  std::string odometry = "/odom";
  std::string ir_frames = "/ir/frames";
  std::string ir_samples = "/ir/samples";
  std::string tf = "/tf";
  std::string tf_static = "/tf_static";
  std::string announcements = "/beacons/announcements";
  std::string sightings = "/beacons/sightings";
  std::string fix = "/beacons/fix";
  std::string pose = "/pose";
  std::string odometry_filtered = "/odometry/filtered";
  std::string truth_pose = "/ground_truth/pose";
  std::string truth_camera_pose = "/ground_truth/camera_pose";
  std::string load = "/load";
  std::string truth_pallets = "/ground_truth/pallets";
};

/// Frame names of the interfaces page.
struct RecordingFrames {
  std::string map = "map";
  std::string odom = "odom";
  std::string base = "base_link";
  std::string camera = "camera_optical_frame";
  std::string imu = "imu_link";
  std::string ir_array = "ir_array";
  std::string fork = "fork";
};

/// A rigid joint of the vehicle.
struct Mount {
  std::string parent, child;
  RigidTransform T_parent_child = RigidTransform::Identity();
};

/// Where the vehicle really was.
struct TruthPose {
  Stamp stamp;
  RigidTransform T_map_base = RigidTransform::Identity();
};

/// Where the camera really was.
struct TruthCameraPose {
  Stamp stamp;
  RigidTransform T_map_camera = RigidTransform::Identity();
};

/// One message of a recording, converted. The camera's intrinsics come once, and again when they change.
struct Record {
  Stamp received;  ///< when the recorder got it; the measurement's own stamp is in the content
  std::variant<Image, CameraIntrinsics, ImuSample, OdometrySample, RawIrFrame, IrSampleBlock, TruthPose,
               TruthCameraPose, Fix>
      content;
};

struct RecordingReaderParams {
  RecordingTopics topics;
  RecordingFrames frames;
  std::optional<RigidTransform> T_base_imu;  ///< empty: from /tf_static
  double camera_time_offset_s = 0;           ///< added to each image's stamp
  bool fixes = false;                        ///< /beacons/fix as well, for tools that do not make their own
  bool truth_only = false;                   ///< only the two ground truth topics
  int threads = 2;                           ///< that decompress, >= 1
};

/// Reads a bag in the order of reception. Decompression runs on threads of its own, a bounded way ahead.
class RecordingReader {
 public:
  /// Opens the bag and reads its index and its static transforms.
  /// @throws RecordingError: no such file, not a bag, not closed properly (no index), truncated
  explicit RecordingReader(const std::string& path, const RecordingReaderParams& params = {});
  ~RecordingReader();

  /// The next record; empty at the end.
  /// @throws RecordingError: a chunk is damaged
  std::optional<Record> next();

  /// T_base_<frame> from /tf_static, through as many joints as it takes; known from the start, whenever the bag holds
  /// it. Empty: not in the bag.
  std::optional<RigidTransform> mount(const std::string& frame) const;
  std::optional<RigidTransform> T_base_camera() const;

  /// In the whole bag; 0 where there is no such topic.
  std::uint64_t message_count(const std::string& topic) const;

  /// How often a message was dropped, by topic and reason. Only as far as next() has come.
  const std::map<std::pair<std::string, std::string>, std::uint64_t>& drops() const;

  /// Reception time of the first and last message.
  Stamp begin() const;
  Stamp end() const;
  /// How much of the time from begin() to end() next() has passed, 0 to 1.
  double progress() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

enum class BagCompression { kNone, kBz2, kLz4 };

struct RecordingWriterParams {
  RecordingTopics topics;
  RecordingFrames frames;
  BagCompression compression = BagCompression::kLz4;
  std::vector<double> tone_table_hz;  ///< names the tones of sightings
  std::vector<Mount> mounts;          ///< /tf_static, written before the first record; the IMU's turns its samples
};

/// Writes a bag: what the simulator makes and what replay found. The file is complete after close().
class RecordingWriter {
 public:
  /// @throws RecordingError: the file cannot be made
  explicit RecordingWriter(const std::string& path, const RecordingWriterParams& params = {});
  ~RecordingWriter();

  /// Each takes the reception time; calls come in its order.
  /// @throws RecordingError: the disk is full
  void write(Stamp received, const Image& image);
  void write(Stamp received, const CameraIntrinsics& intrinsics, Stamp stamp);
  void write(Stamp received, const ImuSample& sample);
  void write(Stamp received, const OdometrySample& sample);
  void write(Stamp received, const RawIrFrame& frame);
  void write(Stamp received, const IrSampleBlock& samples);
  void write(Stamp received, const TruthPose& pose);
  void write(Stamp received, const TruthCameraPose& pose);
  void write(Stamp received, const LoadSample& sample);
  void write(Stamp received, const std::vector<Pallet>& true_pallets, Stamp stamp);
  void write(Stamp received, const Announcement& announcement);
  void write(Stamp received, const Sightings& sightings);
  void write(Stamp received, const Fix& fix);
  /// /pose and /odometry/filtered.
  void write(Stamp received, const StateEstimate& estimate);
  /// /tf, map -> odom for one.
  void write(Stamp received, const std::string& parent, const std::string& child, Stamp stamp,
             const RigidTransform& T_parent_child);

  /// Writes what is left and the index. The destructor does so too, but cannot tell of a failure.
  /// @throws RecordingError: the disk is full
  void close();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodestar
