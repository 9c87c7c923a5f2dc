#include "lodestar/ros/nodelets/camera_input.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include "lodestar/ros/convert/camera_info.hpp"

namespace lodestar {

namespace {

// Everything but the stamp: cameras send the same calibration with each image.
bool same_calibration(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.header.frame_id == b.header.frame_id && a.width == b.width && a.height == b.height &&
         a.distortion_model == b.distortion_model && a.K == b.K && a.D == b.D && a.binning_x == b.binning_x &&
         a.binning_y == b.binning_y && a.roi == b.roi;
}

}  // namespace

CameraInput::CameraInput(ros::NodeHandle& nh, MountLookup& mounts, Health& health,
                         std::optional<RigidTransform> T_base_camera)
    : mounts_(mounts),
      health_(health),
      watch_(health.watch("camera_info", Need::kOptional)),
      T_base_camera_(std::move(T_base_camera)),
      subscriber_(nh.subscribe("camera/camera_info", 10, &CameraInput::take, this)) {
  health_.add_report([this](Health::Status& status) {
    status.add("camera_info", camera_.model ? "in force" : "none yet");
    status.add("camera_info last fault", fault_);
    status.add("camera mount", mounted_ ? "known" : "missing");
    if (!camera_.model) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "no camera_info yet");
    if (camera_.model && !mounted_) {
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                          "no transform from " + frame_ + " to " + mounts_.base_frame());
    }
  });
}

void CameraInput::take(const sensor_msgs::CameraInfoConstPtr& message) {
  watch_.tick();
  if (last_ && same_calibration(*message, *last_)) return;
  const auto intrinsics = intrinsics_from(*message);
  auto model = intrinsics ? CameraModel::create(*intrinsics)
                          : Result<std::shared_ptr<const CameraModel>, std::string>(intrinsics.error());
  if (!model) {
    fault_ = model.error();
    return health_.drop(EdgeDrop::kCameraInfo);
  }
  last_ = message;
  camera_.model = std::move(model).value();
  mounted_ = mounted_ && frame_ == message->header.frame_id;
  frame_ = message->header.frame_id;
  ++revision_;
}

const CameraMount* CameraInput::get() {
  if (!camera_.model) {
    health_.drop(EdgeDrop::kNoCameraInfo);
    return nullptr;
  }
  if (mounted_) return &camera_;
  const auto T_base_camera = T_base_camera_ ? T_base_camera_ : mounts_.T_base(frame_);
  if (!T_base_camera) {
    health_.drop(EdgeDrop::kNoMount);
    return nullptr;
  }
  camera_.T_base_camera = *T_base_camera;
  mounted_ = true;
  ++revision_;
  return &camera_;
}

}  // namespace lodestar
