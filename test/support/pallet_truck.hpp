#pragma once

#include <string>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/measurement/sscc.hpp"
#include "lodestar/estimation/pallet/pallet_tracker.hpp"

namespace lodestar::test {

/// A tracker on a truck that stands wherever a test wants it, with good poses: fork 1 m ahead of base_link, on the
/// floor.
class PalletTruck {
 public:
  explicit PalletTruck(PalletTrackerParams params = {})
      : tracker(params, [this] { return "id" + std::to_string(++ids_); }) {
    T_base_fork_.translation() << 1, 0, 0;
    tracker.set_fork(T_base_fork_);
    load(false);
  }

  /// A pallet on the fork lies 0.6 m ahead of the fork: the truck stands so that it lies here, its x along `yaw_rad`.
  void stand(double x, double y, double yaw_rad = 0) {
    pose_.T_map_base.linear() = rotation({0, 0, yaw_rad});
    pose_.T_map_base.translation() = Eigen::Vector3d(x, y, 0) - pose_.T_map_base.linear() * Eigen::Vector3d(1.6, 0, 0);
  }
  void set_sigma(double position_m, double yaw_rad = 0.001) {
    Eigen::Matrix<double, 6, 1> sigma;
    sigma << position_m, position_m, 0.005, 0.001, 0.001, yaw_rad;
    pose_.covariance = sigma.cwiseAbs2().asDiagonal();
  }

  /// Lifts what is there, or sets it down, with the pallet's underside at this height; what that led to.
  PalletTracker::Changes lift(const std::string& label = "", double z_m = 0) { return work(true, label, z_m); }
  PalletTracker::Changes lower(double z_m = 0) { return work(false, "", z_m); }
  /// A new pallet is brought here from far away.
  PalletTracker::Changes bring(double x, double y, const std::string& label = "", double z_m = 0) {
    stand(100 + 10 * ++brought_, 0);
    lift(label);
    stand(x, y);
    return lower(z_m);
  }
  /// Half a second of samples.
  PalletTracker::Changes work(bool present, const std::string& label, double z_m) {
    height_m_ = z_m + 0.1;
    PalletTracker::Changes changes;
    for (int i = 0; i < 10; ++i)
      for (PalletChange& change : load(present, label)) changes.push_back(std::move(change));
    return changes;
  }
  PalletTracker::Changes load(bool present, const std::string& label = "") {
    now += std::chrono::milliseconds(50);
    pose_.stamp = now;
    if (has_pose) tracker.add_pose(pose_);
    if (has_integrity) tracker.add_integrity(now, !coasting);
    return tracker.add_load({now, height_m_, present, label});
  }

  const Pallet& pallet(const std::string& id) const { return tracker.pallets().find(id)->pallet; }
  static std::string sscc(int number) {
    const std::string digits = std::to_string(10000000000000000 + number);
    return digits + gs1_check_digit(digits);
  }

  PalletTracker tracker;
  bool has_pose = true, has_integrity = true, coasting = false;
  Stamp now{std::chrono::seconds(1000)};

 private:
  int ids_ = 0, brought_ = 0;
  RigidTransform T_base_fork_ = RigidTransform::Identity();
  double height_m_ = 0.1;
  PoseEstimate pose_ = [] {
    PoseEstimate pose;
    pose.covariance = Eigen::Matrix<double, 6, 6>::Identity() * 1e-4;
    pose.covariance.bottomRightCorner<3, 3>() *= 1e-2;
    return pose;
  }();
};

}  // namespace lodestar::test
