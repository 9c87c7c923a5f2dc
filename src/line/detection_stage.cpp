#include "lodestar/line/detection_stage.hpp"

#include <algorithm>

namespace lodestar {
namespace {

constexpr double kMinPlaneHeight_m = 0.5;
constexpr double kMaxEstimateAge_s = 1.0;

}  // namespace

DetectionStage::DetectionStage(const BeaconDetectorParams& detector, const BeaconNamerParams& namer, double floor_z_m)
    : detector_(detector), namer_(namer) {
  T_map_base_unknown_.translation().z() = floor_z_m;
}

void DetectionStage::set_camera(const CameraMount& camera) {
  camera_ = camera;
  detector_.set_camera(camera.model);
  motion_.set_mount(camera.T_base_camera);
}

void DetectionStage::set_beacons(const std::vector<Beacon>& beacons, const std::vector<BeaconId>& heard,
                                 const std::vector<Arrival>& arrivals) {
  beacons_ = beacons;
  heard_ = heard;
  arrivals_ = arrivals;
}

void DetectionStage::add_imu(const ImuSample& sample) { motion_.add_imu(sample); }
void DetectionStage::add_odometry(const OdometrySample& sample) { motion_.add_odometry(sample); }
void DetectionStage::set_estimate(const std::optional<StateEstimate>& estimate) { estimate_ = estimate; }

std::optional<PoseEstimate> DetectionStage::predicted(Stamp stamp) const {
  if (!estimate_ || std::abs(seconds(stamp - estimate_->stamp)) > kMaxEstimateAge_s) return std::nullopt;
  return moved_on(*estimate_, stamp);
}

std::optional<double> DetectionStage::plane_height(const RigidTransform& T_map_camera) {
  if (beacons_.empty()) return std::nullopt;
  heights_m_.clear();
  for (const Beacon& beacon : beacons_) heights_m_.push_back(beacon.position_map.z());
  const auto middle = heights_m_.begin() + static_cast<std::ptrdiff_t>(heights_m_.size() / 2);
  std::nth_element(heights_m_.begin(), middle, heights_m_.end());
  return std::max(kMinPlaneHeight_m, *middle - T_map_camera.translation().z());
}

Result<Sightings, FrameDrop> DetectionStage::process(const Image& image, Sightings reuse) {
  const auto pose = predicted(image.stamp);
  const RigidTransform T_map_base = pose ? pose->T_map_base : T_map_base_unknown_;
  if (const auto height_m = plane_height(T_map_base * camera_.T_base_camera)) {
    detector_.set_plane_height(*height_m);
  }
  auto result = detector_.process(image, motion_, std::move(reuse));
  if (!result) return result;
  Sightings sightings = std::move(result).value();
  contradicted_ += static_cast<std::uint64_t>(
      namer_.name(sightings, beacons_, heard_, arrivals_, *camera_.model, camera_.T_base_camera, pose));
  return sightings;
}

void DetectionStage::reset() {
  detector_.reset();
  motion_.reset();
  estimate_.reset();
}

}  // namespace lodestar
