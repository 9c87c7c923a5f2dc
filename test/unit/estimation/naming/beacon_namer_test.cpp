#include "lodestar/estimation/naming/beacon_namer.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "lodestar/base/common/angle.hpp"
#include "support/lenses.hpp"

namespace lodestar {
namespace {

constexpr BeaconId kA{1}, kB{2}, kC{3};

/// A truck at the origin whose camera, 2 m up, looks straight at the ceiling, and a few beacons on it.
class BeaconNaming : public testing::Test {
 protected:
  BeaconNaming() {
    T_base_camera_.translation() << 0.3, 0, 2;
    T_base_camera_.linear() = so3_exp({0, 0, -kPi / 2});
    pose_.covariance.diagonal() << 0.01, 0.01, 1e-4, 1e-5, 1e-5, 1e-4;
  }

  static Beacon beacon(BeaconId id, const Eigen::Vector3d& position, ToneSet tones) {
    Beacon out;
    out.id = id;
    out.position_map = position;
    out.tones = tones;
    return out;
  }

  /// A blob where a light at this place of the map is seen from the true pose, moved by some px.
  Sighting blob(const Eigen::Vector3d& light_map, ToneSet tones, const Eigen::Vector2d& off_px = {0, 0}) const {
    Sighting out;
    out.pixel = camera_->project((true_T_map_base_ * T_base_camera_).inverse() * light_map)->pixel + off_px;
    out.covariance = 0.01 * Eigen::Matrix2d::Identity();
    out.tones = tones;
    return out;
  }

  void name(const std::optional<PoseEstimate>& estimate, const BeaconNamerParams& params = {}) {
    BeaconNamer(params).name(seen_, beacons_, heard_, arrivals_, *camera_, T_base_camera_, estimate);
  }
  std::optional<BeaconId> named(int i) const { return seen_.sightings[i].beacon; }

  std::shared_ptr<const CameraModel> camera_ = *CameraModel::create(test::fisheye_640());
  RigidTransform T_base_camera_ = RigidTransform::Identity(), true_T_map_base_ = RigidTransform::Identity();
  PoseEstimate pose_;
  std::vector<Beacon> beacons_;
  std::vector<BeaconId> heard_;
  std::vector<Arrival> arrivals_;
  Sightings seen_;
};

using ByCode = BeaconNaming;
using ByPlace = BeaconNaming;

TEST_F(ByCode, UniqueCodeNamesItsBeacon) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1}), beacon(kB, {-1, 0, 8}, {0, 2})};
  seen_.sightings = {blob({-1, 0, 8}, {0, 2}), blob({1, 0, 8}, {0, 1})};
  name({});
  EXPECT_EQ(named(0), kB);
  EXPECT_EQ(named(1), kA);
}

TEST_F(ByCode, CodeMustMatchExactly) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1})};
  seen_.sightings = {blob({1, 0, 8}, {0}), blob({1, 0, 8}, {0, 1, 2}), blob({1, 0, 8}, {3})};
  name({});
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(named(i));
}

/// The direction that a beacon at this place is heard from.
Arrival arrival(BeaconId id, const Eigen::Vector3d& light_map, double sigma_rad) {
  Arrival out;
  out.beacon = id;
  out.direction_base = light_map.normalized();
  out.covariance =
      sigma_rad * sigma_rad * (Eigen::Matrix3d::Identity() - out.direction_base * out.direction_base.transpose());
  return out;
}

TEST_F(ByCode, TwoOfOneCodeInViewAreToldApartByWhereTheyAreHeardFrom) {
  beacons_ = {beacon(kA, {3, 0, 8}, {0, 1}), beacon(kB, {-3, 0, 8}, {0, 1})};
  heard_ = {kA, kB};
  seen_.sightings = {blob({-3, 0, 8}, {0, 1}), blob({3, 0, 8}, {0, 1})};
  name({});
  EXPECT_FALSE(named(0) || named(1));
  arrivals_ = {arrival(kA, {3, 0, 8}, 0.1), arrival(kB, {-3, 0, 8}, 0.1)};
  name({});
  EXPECT_EQ(named(0), kB);
  EXPECT_EQ(named(1), kA);
  arrivals_ = {arrival(kA, {3, 0, 8}, 0.6), arrival(kB, {-3, 0, 8}, 0.6)};
  name({});
  EXPECT_FALSE(named(0) || named(1)) << "too coarse to tell";
}

TEST_F(ByCode, OneThatIsHeardFromElsewhereIsAMirrorImage) {
  beacons_ = {beacon(kA, {3, 0, 8}, {0, 1})};
  heard_ = {kA};
  seen_.sightings = {blob({-3, 1, 8}, {0, 1})};
  name({});
  EXPECT_EQ(named(0), kA);
  arrivals_ = {arrival(kA, {3, 0, 8}, 0.1)};
  name({});
  EXPECT_FALSE(named(0));
}

TEST_F(ByCode, NoCodeNoName) {
  beacons_ = {beacon(kA, {1, 0, 8}, {})};
  seen_.sightings = {blob({1, 0, 8}, {})};
  name({});
  EXPECT_FALSE(named(0));
  name(pose_);
  EXPECT_FALSE(named(0));
}

TEST_F(ByCode, MayBeToldToNameOnlyWhatIsHeard) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1}), beacon(kB, {-1, 0, 8}, {0, 2})};
  seen_.sightings = {blob({1, 0, 8}, {0, 1}), blob({-1, 0, 8}, {0, 2})};
  heard_ = {kB};
  BeaconNamerParams params;
  params.require_announcement = true;
  name({}, params);
  EXPECT_FALSE(named(0));
  EXPECT_EQ(named(1), kB);
  name(pose_, params);
  EXPECT_EQ(named(0), kA);  // its place says enough
}

TEST_F(ByCode, ReusedCodeNeedsToBeHeard) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1}), beacon(kB, {40, 0, 8}, {0, 1}), beacon(kC, {1, 2, 8}, {0, 2})};
  seen_.sightings = {blob({1, 0, 8}, {0, 1}), blob({1, 2, 8}, {0, 2})};
  name({});
  EXPECT_FALSE(named(0));
  EXPECT_EQ(named(1), kC);  // not heard, and need not be
  heard_ = {kA, kC};
  name({});
  EXPECT_EQ(named(0), kA);
  heard_ = {kA, kB};
  name({});
  EXPECT_FALSE(named(0));
  heard_ = {kC};
  name({});
  EXPECT_FALSE(named(0));
}

TEST_F(ByCode, MirrorImageLeavesBothUnnamed) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1}), beacon(kB, {-1, 1, 8}, {0, 2})};
  heard_ = {kA, kB};
  seen_.sightings = {blob({1, 0, 8}, {0, 1}), blob({3, 0, 2.5}, {0, 1}), blob({-1, 1, 8}, {0, 2})};
  name({});
  EXPECT_FALSE(named(0));
  EXPECT_FALSE(named(1));
  EXPECT_EQ(named(2), kB);
}

TEST_F(ByCode, OldNamesAreCleared) {
  seen_.sightings = {blob({1, 0, 8}, {0, 1})};
  seen_.sightings[0].beacon = kA;
  name({});
  EXPECT_FALSE(named(0));
}

TEST_F(ByCode, PoseThatIsNoneIsNotUsed) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1})};
  seen_.sightings = {blob({3, 0, 8}, {0, 1})};
  pose_.covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  name(pose_);
  EXPECT_EQ(named(0), kA);
}

TEST_F(ByPlace, ReusedCodeIsSettledByPlace) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1}), beacon(kB, {-3, 2, 8}, {0, 1})};
  heard_ = {kA};  // the place weighs more
  seen_.sightings = {blob({-3, 2, 8}, {0, 1}, {1, -1}), blob({1, 0, 8}, {0, 1}, {-1, 1})};
  name(pose_);
  EXPECT_EQ(named(0), kB);
  EXPECT_EQ(named(1), kA);
}

TEST_F(ByPlace, MirrorImageIsTurnedAway) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1})};
  seen_.sightings = {blob({3, 0, 2.5}, {0, 1}), blob({1, 0, 8}, {0, 1}, {2, 0})};
  name(pose_);
  EXPECT_FALSE(named(0));
  EXPECT_EQ(named(1), kA);
}

TEST_F(ByPlace, MirrorImageNextToItsBeaconLeavesBothUnnamed) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1})};
  seen_.sightings = {blob({1, 0, 8}, {0, 1}, {3, 0}), blob({1, 0, 8}, {0, 1}, {-3, 1})};
  name(pose_);
  EXPECT_FALSE(named(0));
  EXPECT_FALSE(named(1));
}

TEST_F(ByPlace, TwoBeaconsForOneBlobLeaveItUnnamed) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1}), beacon(kB, {1.2, 0, 8}, {0, 1})};
  seen_.sightings = {blob({1.1, 0, 8}, {0, 1})};
  name(pose_);
  EXPECT_FALSE(named(0));
  BeaconNamerParams no_margin;
  no_margin.margin_chi2 = 1e-9;
  seen_.sightings = {blob({1.05, 0, 8}, {0, 1})};
  name(pose_, no_margin);
  EXPECT_EQ(named(0), kA);
}

TEST_F(ByPlace, UniqueCodeFarFromItsPlaceStaysUnnamed) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1}), beacon(kB, {-3, 2, 8}, {0, 2})};
  seen_.sightings = {blob({3, 0, 8}, {0, 1}), blob({-3, 2, 8}, {0, 2})};
  name(pose_);
  EXPECT_FALSE(named(0));
  EXPECT_EQ(named(1), kB);
}

TEST_F(ByPlace, GateGrowsWithThePosesCovariance) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1})};
  true_T_map_base_.translation().x() = 1;  // the estimate is 1 m off
  seen_.sightings = {blob({1, 0, 8}, {0, 1})};
  name(pose_);
  EXPECT_FALSE(named(0));
  pose_.covariance(0, 0) = 0.5;
  name(pose_);
  EXPECT_EQ(named(0), kA);
}

TEST_F(ByPlace, YawsShareOfTheCovarianceTurnsAboutTheVehicle) {
  beacons_ = {beacon(kA, {4, 0, 8}, {0, 1})};
  true_T_map_base_.linear() = so3_exp({0, 0, 0.2});
  seen_.sightings = {blob({4, 0, 8}, {0, 1})};
  pose_.covariance(5, 5) = 0.01;
  name(pose_);
  EXPECT_EQ(named(0), kA);
  pose_.covariance(5, 5) = 1e-4;
  name(pose_);
  EXPECT_FALSE(named(0));
}

TEST_F(ByPlace, CorrelationOfPlaceAndYawCounts) {
  beacons_ = {beacon(kA, {0, 5, 8}, {0, 1})};
  Eigen::Matrix<double, 6, 1> error;  // both move the blob the same way
  error << 0.3, 0, 0, 0, 0, -0.06;
  true_T_map_base_.translation() = error.head<3>();
  true_T_map_base_.linear() = so3_exp(error.tail<3>());
  seen_.sightings = {blob({0, 5, 8}, {0, 1})};
  pose_.covariance = error * error.transpose();
  name(pose_);
  EXPECT_EQ(named(0), kA);
  error(5) *= -1;
  pose_.covariance = error * error.transpose();
  name(pose_);
  EXPECT_FALSE(named(0));
}

TEST_F(ByPlace, BeaconBehindTheCameraIsNoCandidate) {
  beacons_ = {beacon(kA, {0.3, 0, 2}, {0, 1}), beacon(kB, {1, 0, 8}, {0, 1})};  // A sits in the lens
  seen_.sightings = {blob({1, 0, 8}, {0, 1})};
  name(pose_);
  EXPECT_EQ(named(0), kB);
}

TEST_F(ByPlace, BrokenSightingStaysUnnamed) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1})};
  seen_.sightings = {blob({1, 0, 8}, {0, 1})};
  seen_.sightings[0].pixel.x() = std::numeric_limits<double>::quiet_NaN();
  name(pose_);
  EXPECT_FALSE(named(0));
  name({});
  EXPECT_FALSE(named(0));
}

TEST_F(ByPlace, LostTruckNamesNothing) {
  beacons_ = {beacon(kA, {1, 0, 8}, {0, 1}), beacon(kB, {-1, 2, 8}, {0, 2}), beacon(kC, {2, -2, 8}, {0, 3})};
  true_T_map_base_.translation() << 2, 2, 0;
  seen_.sightings = {blob({1, 0, 8}, {0, 1}), blob({-1, 2, 8}, {0, 2}), blob({2, -2, 8}, {0, 3})};
  name(pose_);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(named(i));
  name({});  // what the caller does once it knows
  EXPECT_EQ(named(0), kA);
  EXPECT_EQ(named(1), kB);
  EXPECT_EQ(named(2), kC);
}

}  // namespace
}  // namespace lodestar
