#include "lodestar/line/place_hypotheses.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/line/fusion_stage.hpp"
#include "support/lenses.hpp"

namespace lodestar {
namespace {

Beacon beacon(std::uint32_t id, const Eigen::Vector3d& position, ToneSet tones) {
  Beacon b;
  b.id = {id};
  b.position_map = position;
  b.sigma_m = 0.01;
  b.tones = tones;
  return b;
}

const ToneSet kA{0, 1}, kB{0, 2}, kC{1, 2}, kD{0, 3}, kE{1, 3};

/// A row of codes, and the same again 100 m on, but for the beacon at its end.
std::vector<Beacon> plant_with_codes_used_twice() {
  return {beacon(1, {0, 1, 8}, kA),        beacon(2, {5, -1, 8}, kB),   beacon(3, {10, 1.5, 7.5}, kC),
          beacon(4, {20, -1, 8}, kD),      beacon(11, {100, 1, 8}, kA), beacon(12, {105, -1, 8}, kB),
          beacon(13, {110, 1.5, 7.5}, kC), beacon(14, {120, -1, 8}, kE)};
}

/// A truck that drives straight ahead below beacons that a camera sees up to 50 deg off its axis.
class Drive {
 public:
  Drive(const std::vector<Beacon>& beacons, const Eigen::Vector3d& start_map, bool ir_receiver)
      : ir_receiver_(ir_receiver), beacons_(beacons), start_map_(start_map), stage_(params(ir_receiver)) {
    camera_.model = *CameraModel::create(test::fisheye_640());
    camera_.T_base_camera.translation().z() = 2;
    stage_.set_camera(camera_);
    stage_.set_beacons(beacons_);
  }

  /// Drives on; calls visit(t) after each image.
  void until(
      double end_s, const std::function<void(double)>& visit = [](double) {}) {
    for (; step_ <= static_cast<int>(100 * end_s); ++step_) {
      const double t_s = 0.01 * step_;
      stage_.add_imu({stamp(t_s), Eigen::Vector3d::Zero(), {0, 0, 9.80665}});
      OdometrySample wheels;
      wheels.stamp = stamp(t_s);
      wheels.velocity_m_s.x() = kSpeed_m_s;
      if (step_ % 2 == 0) stage_.add_odometry(wheels);
      if (step_ % 5 != 0) continue;
      stage_.add_sightings(sightings(t_s));
      visit(t_s);
    }
  }

  void fix(double t_s) {
    Fix fix;
    fix.stamp = stamp(t_s);
    fix.T_map_base.translation() = position(t_s);
    fix.covariance.diagonal() << 1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6;
    stage_.add_fix(fix);
  }

  Eigen::Vector3d position(double t_s) const { return start_map_ + Eigen::Vector3d(kSpeed_m_s * t_s, 0, 0); }
  double error_m() const {
    const auto estimate = stage_.filter().estimate();
    return estimate ? (estimate->T_map_base.translation() - position(seconds(estimate->stamp - stamp(0)))).norm() : 1e9;
  }
  const FusionStage& stage() const { return stage_; }

 private:
  static constexpr double kSpeed_m_s = 1.5;
  static Stamp stamp(double t_s) { return Stamp(std::chrono::seconds(1000)) + from_seconds(t_s); }
  static LineParams params(bool ir_receiver) {
    Vehicle vehicle;
    vehicle.has_ir_receiver = ir_receiver;
    return line_params(Site(), vehicle);
  }

  /// Named as the detection stage does: by the pose where it is known, else by code, where a receiver hears all.
  Sightings sightings(double t_s) const {
    Sightings out;
    out.stamp = stamp(t_s);
    std::vector<BeaconId> heard;
    for (const Beacon& b : beacons_) {
      const Eigen::Vector3d in_camera = b.position_map - position(t_s) - camera_.T_base_camera.translation();
      const auto seen = camera_.model->project(in_camera);
      if (!seen || in_camera.normalized().z() < std::cos(radians(50))) continue;
      Sighting s;
      s.pixel = seen->pixel;
      s.covariance = 0.01 * Eigen::Matrix2d::Identity();
      s.tones = b.tones;
      out.sightings.push_back(s);
      if (ir_receiver_) heard.push_back(b.id);
    }
    BeaconNamer({}).name(out, beacons_, heard, {}, *camera_.model, camera_.T_base_camera,
                         stage_.filter().estimate_at(stamp(t_s)));
    return out;
  }

  bool ir_receiver_;
  std::vector<Beacon> beacons_;
  Eigen::Vector3d start_map_;
  CameraMount camera_;
  FusionStage stage_;
  int step_ = 0;
};

TEST(PlaceHypotheses, CodesUsedTwiceKeepBothPlacesUntilTheyDiffer) {
  for (const double begin_m : {1.0, 101.0}) {
    Drive drive(plant_with_codes_used_twice(), {begin_m, 0, 0}, false);
    drive.until(3, [&](double t_s) {
      if (t_s < 0.2) return;
      EXPECT_EQ(drive.stage().places().open(), 2u) << t_s;
      EXPECT_FALSE(drive.stage().filter().estimate()) << "no pose is better than a guess";
    });
    drive.until(14);  // the end of the row is in view
    EXPECT_EQ(drive.stage().places().open(), 0u);
    EXPECT_EQ(drive.stage().places().drops().total(), 1u);
    EXPECT_EQ(drive.stage().filter().mode(), FilterMode::kTracking);
    EXPECT_LT(drive.error_m(), 0.1);
  }
}

TEST(PlaceHypotheses, TheSecondRootOfTwoBeaconsIsDrivenAway) {
  Drive drive({beacon(1, {2.6, 0.9, 8.4}, kA), beacon(2, {3.5, 1.4, 5.4}, kB)}, {-1.2, 0, 0}, true);
  drive.until(1);
  EXPECT_EQ(drive.stage().places().open(), 2u);
  EXPECT_FALSE(drive.stage().filter().estimate());
  drive.until(3.5);
  EXPECT_EQ(drive.stage().places().open(), 0u);
  EXPECT_EQ(drive.stage().filter().mode(), FilterMode::kTracking);
  EXPECT_LT(drive.error_m(), 0.1);
}

TEST(PlaceHypotheses, AFixClosesThem) {
  Drive drive(plant_with_codes_used_twice(), {1, 0, 0}, false);
  drive.until(1);
  ASSERT_EQ(drive.stage().places().open(), 2u);
  drive.fix(1);
  EXPECT_EQ(drive.stage().places().open(), 0u);
  EXPECT_LT(drive.error_m(), 0.1);
}

TEST(PlaceHypotheses, AnOpenQuestionOpensNone) {
  Drive drive({beacon(1, {1, 0, 8}, kA), beacon(2, {101, 0, 8}, kA)}, {0, 0, 0}, false);
  drive.until(2);
  EXPECT_EQ(drive.stage().places().open(), 0u) << "one beacon makes no pose, wherever it is";
}

}  // namespace
}  // namespace lodestar
