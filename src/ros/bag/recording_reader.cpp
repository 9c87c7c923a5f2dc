#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <functional>
#include <map>
#include <set>

#include "bag_file.hpp"
#include "bag_player.hpp"
#include "lodestar/ros/bag/recording.hpp"
#include "lodestar/ros/convert/camera_info.hpp"
#include "lodestar/ros/convert/image.hpp"
#include "lodestar/ros/convert/imu.hpp"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "lodestar/ros/convert/ir_samples.hpp"
#include "lodestar/ros/convert/odometry.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/transform.hpp"
#include "mounts.hpp"

namespace lodestar {
namespace {

using Content = decltype(Record::content);
/// A content, or the reason why there is none.
using Conversion = Result<Content, std::string>;

template <class T>
Conversion conversion(Result<T, MessageDrop> result) {
  if (!result) return std::string(name(result.error()));
  return Content(std::move(result).value());
}

/// Empty: the bytes are not such a message.
template <class Message>
boost::shared_ptr<Message> deserialize(const BagMessage& message) {
  auto out = boost::make_shared<Message>();
  ros::serialization::IStream stream(message.bytes->data() + message.offset, message.size);
  try {
    ros::serialization::deserialize(stream, *out);
  } catch (const ros::serialization::StreamOverrunException&) {
    return nullptr;
  }
  return out;
}

bool same_lens(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model && a.D == b.D &&
         a.K == b.K;
}

}  // namespace

class RecordingReader::Impl {
 public:
  Impl(const std::string& path, const RecordingReaderParams& params) : params_(params), file_(path) {
    for (const BagChunkInfo& chunk : file_.chunks()) {
      begin_ = begin_ ? std::min(*begin_, chunk.start) : chunk.start;
      end_ = end_ ? std::max(*end_, chunk.end) : chunk.end;
    }
    last_ = begin();
    read_mounts();
    choose_handlers();
    player_.emplace(file_, keys(handlers_), params_.threads);
  }

  std::optional<Record> next() {
    while (const auto message = player_->next()) {
      last_ = std::max(last_, message->received);
      const std::optional<Conversion> result = handlers_.at(message->connection)(*message);
      if (!result) continue;
      if (result->ok()) return Record{message->received, result->value()};
      ++drops_[{file_.connections().at(message->connection).topic, result->error()}];
    }
    last_ = end();
    return std::nullopt;
  }

  std::optional<RigidTransform> mount(const std::string& frame) const {
    return mounts_.find(params_.frames.base, frame);
  }

  std::uint64_t message_count(const std::string& topic) const {
    std::uint64_t count = 0;
    for (const BagChunkInfo& chunk : file_.chunks())
      for (const auto& [connection, messages] : chunk.connections)
        if (topic_of(connection) == topic) count += messages;
    return count;
  }

  const std::map<std::pair<std::string, std::string>, std::uint64_t>& drops() const { return drops_; }
  const RecordingFrames& frames() const { return params_.frames; }
  Stamp begin() const { return begin_.value_or(Stamp()); }
  Stamp end() const { return end_.value_or(Stamp()); }
  double progress() const { return end() > begin() ? seconds(last_ - begin()) / seconds(end() - begin()) : 1.0; }

 private:
  /// Empty: nothing new.
  using Handler = std::function<std::optional<Conversion>(const BagMessage&)>;

  static std::set<std::uint32_t> keys(const std::map<std::uint32_t, Handler>& handlers) {
    std::set<std::uint32_t> out;
    for (const auto& handler : handlers) out.insert(handler.first);
    return out;
  }

  std::string topic_of(std::uint32_t connection) const {
    const auto found = file_.connections().find(connection);
    return found == file_.connections().end() ? std::string() : found->second.topic;
  }

  void read_mounts() {
    std::set<std::uint32_t> connections;
    for (const auto& [id, connection] : file_.connections())
      if (connection.topic == params_.topics.tf_static &&
          connection.md5 == ros::message_traits::MD5Sum<tf2_msgs::TFMessage>::value())
        connections.insert(id);
    BagPlayer player(file_, connections, params_.threads);
    while (const auto message = player.next()) {
      const auto tf = deserialize<tf2_msgs::TFMessage>(*message);
      if (!tf) {
        ++drops_[{params_.topics.tf_static, "damaged"}];
        continue;
      }
      for (const geometry_msgs::TransformStamped& joint : tf->transforms) {
        const auto T_parent_child = transform_from(joint.transform);
        if (T_parent_child)
          mounts_.add({joint.header.frame_id, joint.child_frame_id, *T_parent_child});
        else
          ++drops_[{params_.topics.tf_static, name(T_parent_child.error())}];
      }
    }
  }

  void choose_handlers() {
    const RecordingTopics& topics = params_.topics;
    for (const auto& [id, connection] : file_.connections()) {
      const std::string& topic = connection.topic;
      if (topic == topics.truth_pose)
        handle<geometry_msgs::PoseStamped>(id, [this](const auto& pose) { return truth_pose(*pose); });
      else if (topic == topics.truth_camera_pose)
        handle<geometry_msgs::PoseStamped>(id, [this](const auto& pose) { return truth_camera_pose(*pose); });
      else if (params_.truth_only)
        continue;
      else if (topic == topics.image)
        handle<sensor_msgs::Image>(
            id, [this](const auto& image) { return conversion(image_from(image, params_.camera_time_offset_s)); });
      else if (topic == topics.camera_info)
        handle<sensor_msgs::CameraInfo>(id, [this](const auto& info) { return camera_info(*info); });
      else if (topic == topics.imu)
        handle<sensor_msgs::Imu>(id, [this](const auto& imu) { return imu_sample(*imu); });
      else if (topic == topics.odometry)
        handle<nav_msgs::Odometry>(
            id, [this](const auto& odometry) { return conversion(odometry_from(*odometry, params_.frames.base)); });
      else if (topic == topics.fix && params_.fixes)
        handle<geometry_msgs::PoseWithCovarianceStamped>(id, [this](const auto& pose) { return fix(*pose); });
      else if (topic == topics.ir_frames)
        handle<IrFrame>(id, [](const auto& frame) { return conversion(ir_frame_from(*frame)); });
      else if (topic == topics.ir_samples)
        handle<IrSamples>(id, [](const auto& samples) { return conversion(ir_samples_from(*samples)); });
    }
  }

  template <class Message, class Convert>
  void handle(std::uint32_t connection, Convert convert) {
    const BagConnection& about = file_.connections().at(connection);
    if (about.md5 != ros::message_traits::MD5Sum<Message>::value()) {
      handlers_[connection] = [type = about.type](const BagMessage&) {
        return Conversion("is a " + type + " and has to be a " + ros::message_traits::DataType<Message>::value());
      };
      return;
    }
    handlers_[connection] = [convert](const BagMessage& message) -> std::optional<Conversion> {
      const auto deserialized = deserialize<Message>(message);
      if (!deserialized) return Conversion(std::string("damaged"));
      return convert(deserialized);
    };
  }

  Conversion truth_pose(const geometry_msgs::PoseStamped& message) const {
    const auto pose = pose_from(message, params_.frames.map);
    if (!pose) return std::string(name(pose.error()));
    return Content(TruthPose{pose->stamp, pose->T_parent_child});
  }

  Conversion truth_camera_pose(const geometry_msgs::PoseStamped& message) const {
    const auto pose = pose_from(message, params_.frames.map);
    if (!pose) return std::string(name(pose.error()));
    return Content(TruthCameraPose{pose->stamp, pose->T_parent_child});
  }

  Conversion fix(const geometry_msgs::PoseWithCovarianceStamped& message) const {
    const auto pose = pose_estimate_from(message, params_.frames.map);
    if (!pose) return std::string(name(pose.error()));
    Fix fix;
    static_cast<PoseEstimate&>(fix) = *pose;
    return Content(std::move(fix));
  }

  std::optional<Conversion> camera_info(const sensor_msgs::CameraInfo& message) {
    if (camera_info_ && same_lens(*camera_info_, message)) return std::nullopt;
    const auto intrinsics = intrinsics_from(message);
    if (!intrinsics) return Conversion(intrinsics.error());
    camera_info_ = message;
    return Conversion(Content(*intrinsics));
  }

  Conversion imu_sample(const sensor_msgs::Imu& message) const {
    const auto T_base_imu = params_.T_base_imu ? params_.T_base_imu : mount(message.header.frame_id);
    if (!T_base_imu) return std::string(name(MessageDrop::kFrame));
    return conversion(imu_from(message, T_base_imu->linear()));
  }

  RecordingReaderParams params_;
  BagFile file_;
  std::optional<Stamp> begin_, end_;
  Stamp last_;
  Mounts mounts_;
  std::map<std::uint32_t, Handler> handlers_;  ///< by connection
  std::optional<sensor_msgs::CameraInfo> camera_info_;
  std::map<std::pair<std::string, std::string>, std::uint64_t> drops_;
  std::optional<BagPlayer> player_;
};

RecordingReader::RecordingReader(const std::string& path, const RecordingReaderParams& params)
    : impl_(std::make_unique<Impl>(path, params)) {}
RecordingReader::~RecordingReader() = default;

std::optional<Record> RecordingReader::next() { return impl_->next(); }
std::optional<RigidTransform> RecordingReader::mount(const std::string& frame) const { return impl_->mount(frame); }
std::optional<RigidTransform> RecordingReader::T_base_camera() const { return impl_->mount(impl_->frames().camera); }
std::uint64_t RecordingReader::message_count(const std::string& topic) const { return impl_->message_count(topic); }
const std::map<std::pair<std::string, std::string>, std::uint64_t>& RecordingReader::drops() const {
  return impl_->drops();
}
Stamp RecordingReader::begin() const { return impl_->begin(); }
Stamp RecordingReader::end() const { return impl_->end(); }
double RecordingReader::progress() const { return impl_->progress(); }

}  // namespace lodestar
