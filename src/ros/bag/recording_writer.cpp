#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>

#include "lodestar/ros/bag/recording.hpp"
#include "lodestar/ros/convert/announcement.hpp"
#include "lodestar/ros/convert/camera_info.hpp"
#include "lodestar/ros/convert/image.hpp"
#include "lodestar/ros/convert/imu.hpp"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "lodestar/ros/convert/ir_samples.hpp"
#include "lodestar/ros/convert/odometry.hpp"
#include "lodestar/ros/convert/pallet.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/sightings.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"
#include "mounts.hpp"

namespace lodestar {
namespace {

rosbag::CompressionType compression_type(BagCompression compression) {
  switch (compression) {
    case BagCompression::kNone:
      return rosbag::compression::Uncompressed;
    case BagCompression::kBz2:
      return rosbag::compression::BZ2;
    case BagCompression::kLz4:
      return rosbag::compression::LZ4;
  }
  return rosbag::compression::Uncompressed;
}

/// Says of a topic that its last message is for late subscribers too, so that `rosbag play` publishes it so.
boost::shared_ptr<ros::M_string> latched_header() {
  using Tf = tf2_msgs::TFMessage;
  auto header = boost::make_shared<ros::M_string>();
  (*header)["type"] = ros::message_traits::DataType<Tf>::value();
  (*header)["md5sum"] = ros::message_traits::MD5Sum<Tf>::value();
  (*header)["message_definition"] = ros::message_traits::Definition<Tf>::value();
  (*header)["latching"] = "1";
  return header;
}

}  // namespace

class RecordingWriter::Impl {
 public:
  Impl(const std::string& path, const RecordingWriterParams& params) : params_(params), path_(path) {
    for (const Mount& mount : params.mounts) mounts_.add(mount);
    guarded([this] {
      bag_.open(path_, rosbag::bagmode::Write);
      bag_.setCompression(compression_type(params_.compression));
    });
  }

  template <class Message>
  void write(Stamp received, const std::string& topic, const Message& message) {
    guarded([&] {
      if (!mounts_written_) write_mounts(received);
      bag_.write(topic, ros_time(received), message);
    });
  }

  void close() {
    guarded([this] { bag_.close(); });
  }

  Eigen::Matrix3d R_base_imu() const {
    const auto T_base_imu = mounts_.find(params_.frames.base, params_.frames.imu);
    if (!T_base_imu)
      throw RecordingError(path_ + ": an inertial sample cannot be written, RecordingWriterParams::mounts has no " +
                           params_.frames.base + " -> " + params_.frames.imu);
    return T_base_imu->linear();
  }

  const RecordingTopics& topics() const { return params_.topics; }
  const RecordingFrames& frames() const { return params_.frames; }
  const RecordingWriterParams& params() const { return params_; }

 private:
  template <class Action>
  void guarded(Action action) {
    try {
      action();
    } catch (const rosbag::BagException& error) {
      throw RecordingError(path_ + " cannot be written (" + error.what() +
                           "): choose a folder that exists and may be written to, with room on its disk");
    }
  }

  void write_mounts(Stamp received) {
    mounts_written_ = true;
    tf2_msgs::TFMessage message;
    for (const Mount& mount : params_.mounts)
      message.transforms.push_back(transform_message(mount.T_parent_child, received, mount.parent, mount.child));
    if (!message.transforms.empty())
      bag_.write(params_.topics.tf_static, ros_time(received), message, latched_header());
  }

  RecordingWriterParams params_;
  std::string path_;
  rosbag::Bag bag_;
  Mounts mounts_;
  bool mounts_written_ = false;
};

RecordingWriter::RecordingWriter(const std::string& path, const RecordingWriterParams& params)
    : impl_(std::make_unique<Impl>(path, params)) {}

RecordingWriter::~RecordingWriter() {
  try {
    close();
  } catch (const RecordingError&) {
    // Whoever wants to know calls close().
  }
}

void RecordingWriter::close() { impl_->close(); }

void RecordingWriter::write(Stamp received, const Image& image) {
  impl_->write(received, impl_->topics().image, image_message(image, impl_->frames().camera));
}

void RecordingWriter::write(Stamp received, const CameraIntrinsics& intrinsics, Stamp stamp) {
  impl_->write(received, impl_->topics().camera_info, camera_info_message(intrinsics, stamp, impl_->frames().camera));
}

void RecordingWriter::write(Stamp received, const ImuSample& sample) {
  impl_->write(received, impl_->topics().imu, imu_message(sample, impl_->R_base_imu(), impl_->frames().imu));
}

void RecordingWriter::write(Stamp received, const OdometrySample& sample) {
  impl_->write(received, impl_->topics().odometry,
               odometry_message(sample, impl_->frames().odom, impl_->frames().base));
}

void RecordingWriter::write(Stamp received, const IrSampleBlock& samples) {
  impl_->write(received, impl_->topics().ir_samples, ir_samples_message(samples, impl_->frames().ir_array));
}

void RecordingWriter::write(Stamp received, const RawIrFrame& frame) {
  impl_->write(received, impl_->topics().ir_frames, ir_frame_message(frame, impl_->frames().ir_array));
}

void RecordingWriter::write(Stamp received, const TruthPose& pose) {
  impl_->write(received, impl_->topics().truth_pose,
               pose_message(StampedPose{pose.stamp, pose.T_map_base}, impl_->frames().map));
}

void RecordingWriter::write(Stamp received, const TruthCameraPose& pose) {
  impl_->write(received, impl_->topics().truth_camera_pose,
               pose_message(StampedPose{pose.stamp, pose.T_map_camera}, impl_->frames().map));
}

void RecordingWriter::write(Stamp received, const LoadSample& sample) {
  impl_->write(received, impl_->topics().load, load_message(sample, impl_->frames().fork));
}

void RecordingWriter::write(Stamp received, const std::vector<Pallet>& true_pallets, Stamp stamp) {
  impl_->write(received, impl_->topics().truth_pallets,
               pallet_array_message(true_pallets, stamp, impl_->frames().map));
}

void RecordingWriter::write(Stamp received, const Announcement& announcement) {
  impl_->write(received, impl_->topics().announcements, announcement_message(announcement, impl_->frames().map));
}

void RecordingWriter::write(Stamp received, const Sightings& sightings) {
  impl_->write(received, impl_->topics().sightings,
               sightings_message(sightings, impl_->params().tone_table_hz, impl_->frames().camera));
}

void RecordingWriter::write(Stamp received, const Fix& fix) {
  impl_->write(received, impl_->topics().fix, pose_estimate_message(fix, impl_->frames().map));
}

void RecordingWriter::write(Stamp received, const StateEstimate& estimate) {
  impl_->write(received, impl_->topics().pose, pose_estimate_message(estimate, impl_->frames().map));
  impl_->write(received, impl_->topics().odometry_filtered,
               odometry_message(estimate, impl_->frames().map, impl_->frames().base));
}

void RecordingWriter::write(Stamp received, const std::string& parent, const std::string& child, Stamp stamp,
                            const RigidTransform& T_parent_child) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform_message(T_parent_child, stamp, parent, child));
  impl_->write(received, impl_->topics().tf, message);
}

}  // namespace lodestar
