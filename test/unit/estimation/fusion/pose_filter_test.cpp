#include "lodestar/estimation/fusion/pose_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "support/fusion_run.hpp"

namespace lodestar::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

Stamp at(double t_s) { return Stamp(std::chrono::seconds(1000)) + from_seconds(t_s); }

ImuSample still_imu(double t_s) {
  ImuSample s;
  s.stamp = at(t_s);
  s.specific_force_m_s2 << 0, 0, 9.80665;
  return s;
}

OdometrySample wheels(double t_s, double speed_m_s = 0) {
  OdometrySample s;
  s.stamp = at(t_s);
  s.velocity_m_s.x() = speed_m_s;
  return s;
}

Fix fix(double t_s, const Eigen::Vector3d& position = Eigen::Vector3d::Zero()) {
  Fix f;
  f.stamp = at(t_s);
  f.T_map_base.translation() = position;
  f.covariance.diagonal() << 4e-4, 4e-4, 4e-4, 1e-5, 1e-5, 1e-5;
  return f;
}

/// Four beacons 6 m above a camera at the origin that looks straight up.
BeaconBearings bearings(double t_s, const Eigen::Vector3d& truth = Eigen::Vector3d::Zero()) {
  BeaconBearings out;
  out.stamp = at(t_s);
  std::uint32_t id = 1;
  for (const double x : {-3.0, 3.0})
    for (const double y : {-3.0, 3.0}) {
      BeaconBearing b;
      b.beacon = BeaconId{id++};
      b.position_map << x, y, 6;
      b.direction_camera = (b.position_map - truth).normalized();
      b.covariance = 1e-6 * (Eigen::Matrix3d::Identity() - b.direction_camera * b.direction_camera.transpose());
      out.bearings.push_back(b);
    }
  return out;
}

/// A filter that stands at the origin and has tracked for a second.
PoseFilter standing_filter(double until_s = 1.0) {
  PoseFilter filter{PoseFilterParams{}};
  filter.add_imu(still_imu(0));
  filter.add_odometry(wheels(0));
  filter.add_fix(fix(0));
  for (int i = 1; i <= static_cast<int>(until_s * 100 + 0.5); ++i) {
    filter.add_imu(still_imu(0.01 * i));
    if (i % 2 == 0) filter.add_odometry(wheels(0.01 * i));
    if (i % 5 == 0) filter.add_bearings(bearings(0.01 * i));
  }
  return filter;
}

TEST(PoseFilter, starts_with_a_fix) {
  PoseFilter filter{PoseFilterParams{}};
  EXPECT_EQ(filter.mode(), FilterMode::kStarting);
  EXPECT_FALSE(filter.estimate());
  EXPECT_EQ(filter.add_imu(still_imu(0)), std::nullopt);
  EXPECT_EQ(filter.add_bearings(bearings(0)), FilterDrop::kNotStarted);
  EXPECT_FALSE(filter.estimate());
  EXPECT_EQ(filter.add_fix(fix(0.001, {1, 2, 0})), std::nullopt);
  EXPECT_EQ(filter.mode(), FilterMode::kTracking);
  ASSERT_TRUE(filter.estimate());
  EXPECT_NEAR(filter.estimate()->T_map_base.translation().y(), 2, 1e-9);
}

TEST(PoseFilter, tells_how_well_it_knows_its_motion) {
  const auto estimate = standing_filter().estimate();
  ASSERT_TRUE(estimate);
  const Eigen::Matrix<double, 6, 1> variance = estimate->twist_covariance.diagonal();
  EXPECT_LT(std::sqrt(variance.head<3>().maxCoeff()), 0.01) << "it stands";
  EXPECT_GT(std::sqrt(variance.head<3>().minCoeff()), 1e-4);
  EXPECT_NEAR(std::sqrt(variance[5]), PoseFilterParams{}.gyro_noise_rad_s, 5e-4) << "a rate is one sample of the gyro";
}

TEST(PoseFilter, a_late_fix_starts_at_its_own_stamp) {
  PoseFilter filter{PoseFilterParams{}};
  for (int i = 0; i <= 100; ++i) {
    filter.add_imu(still_imu(0.01 * i));
    filter.add_odometry(wheels(0.01 * i, 2.0));
  }
  EXPECT_EQ(filter.add_fix(fix(0.5)), std::nullopt);
  const auto estimate = filter.estimate();
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->stamp, at(1.0));
  EXPECT_NEAR(estimate->T_map_base.translation().x(), 1.0, 1e-3);
  EXPECT_NEAR(estimate->velocity_base_m_s.x(), 2.0, 1e-3);
  EXPECT_EQ(filter.add_bearings(bearings(0.4)), FilterDrop::kNotStarted);
}

TEST(PoseFilter, estimates_at_any_stamp_of_the_buffer_and_ahead) {
  PoseFilter filter{PoseFilterParams{}};
  filter.add_odometry(wheels(0, 1.0));
  filter.add_fix(fix(0));
  for (int i = 1; i <= 50; ++i) {
    ImuSample imu = still_imu(0.02 * i);
    filter.add_imu(imu);
    filter.add_odometry(wheels(0.02 * i, 1.0));
  }
  for (const double t_s : {0.0, 0.313, 0.777, 1.0, 1.5}) {
    const auto estimate = filter.estimate_at(at(t_s));
    ASSERT_TRUE(estimate) << t_s;
    EXPECT_EQ(estimate->stamp, at(t_s));
    EXPECT_NEAR(estimate->T_map_base.translation().x(), t_s, 2e-3);
  }
  EXPECT_GT(filter.estimate_at(at(2.0))->covariance(0, 0), filter.estimate_at(at(1.0))->covariance(0, 0));
  EXPECT_FALSE(filter.estimate_at(at(-0.1)));
  EXPECT_FALSE(filter.estimate_at(at(3.1)));
}

TEST(PoseFilter, order_of_reception_does_not_matter) {
  const TruckDrive drive({{0, 0, 0}, {1, 1.5, 0.3}, {4, 1.5, 0.3}}, 1);
  // Images come in batches, the newest first, the last of a batch one inertial sample late.
  const auto feed = [&](std::size_t batch) {
    TruckSensors sensors(drive, SensorErrors{}, 2);
    PoseFilter filter{PoseFilterParams{}};
    filter.set_camera(sensors.T_base_camera());
    std::vector<BeaconBearings> kept;
    for (std::size_t i = 6; i + 1 < drive.size(); ++i) {
      if (i % 6 == 0) filter.add_imu(sensors.imu(i));
      if (i % 24 == 0) filter.add_odometry(sensors.wheels(i, 0.02));
      if (i == 40) filter.add_fix(sensors.fix(i, 0.03));
      if (i % 40 == 0 && i > 40) kept.push_back(sensors.bearings(i, 0.03));
      if (i % 40 != 10 || kept.size() < batch) continue;
      for (auto b = kept.rbegin(); b != kept.rend(); ++b) EXPECT_EQ(filter.add_bearings(*b), std::nullopt);
      kept.clear();
    }
    for (const auto& b : kept) filter.add_bearings(b);
    return *filter.estimate();
  };
  const StateEstimate prompt = feed(1), late = feed(8);
  EXPECT_EQ(prompt.stamp, late.stamp);
  EXPECT_LT((prompt.T_map_base.translation() - late.T_map_base.translation()).norm(), 1e-9);
  EXPECT_LT((prompt.covariance - late.covariance).norm(), 1e-9);
}

TEST(PoseFilter, coasts_then_is_lost_then_restarts) {
  PoseFilter filter = standing_filter();
  EXPECT_EQ(filter.mode(), FilterMode::kTracking);
  double sigma_m = std::sqrt(filter.estimate()->covariance(0, 0));
  int i = 100;
  bool coasted = false;
  for (; i < 6000 && filter.mode() != FilterMode::kLost; ++i) {
    filter.add_imu(still_imu(0.01 * i));
    if (filter.mode() != FilterMode::kCoasting) continue;
    coasted = true;
    EXPECT_GE(std::sqrt(filter.estimate()->covariance(0, 0)), 0.999 * sigma_m);
    sigma_m = std::sqrt(filter.estimate()->covariance(0, 0));
  }
  EXPECT_TRUE(coasted);
  ASSERT_EQ(filter.mode(), FilterMode::kLost);
  EXPECT_FALSE(filter.estimate());
  EXPECT_EQ(filter.add_bearings(bearings(0.01 * i)), FilterDrop::kNotStarted);
  EXPECT_EQ(filter.add_fix(fix(0.01 * i, {5, 0, 0})), std::nullopt);
  EXPECT_EQ(filter.mode(), FilterMode::kTracking);
  EXPECT_NEAR(filter.estimate()->T_map_base.translation().x(), 5, 0.1);
}

TEST(PoseFilter, kidnapping_is_noticed_within_two_seconds) {
  PoseFilter filter = standing_filter();
  int i = 101;
  for (; i < 400 && filter.mode() != FilterMode::kLost; ++i) {
    filter.add_imu(still_imu(0.01 * i));
    if (i % 2 == 0) filter.add_odometry(wheels(0.01 * i));
    if (i % 5 == 0) filter.add_bearings(bearings(0.01 * i, {2.5, -2.0, 0}));
    const auto estimate = filter.estimate();
    if (estimate) {
      EXPECT_LT(estimate->T_map_base.translation().norm(), 0.5) << "pulled through walls";
    }
  }
  ASSERT_EQ(filter.mode(), FilterMode::kLost);
  EXPECT_LT(0.01 * i - 1.0, 2.0);
  EXPECT_GT(filter.drops()[FilterDrop::kGated], 10u);
  filter.add_fix(fix(0.01 * i, {2.5, -2.0, 0}));
  EXPECT_EQ(filter.mode(), FilterMode::kTracking);
}

TEST(PoseFilter, one_lying_beacon_is_left_out) {
  PoseFilter filter = standing_filter();
  BeaconBearings liar = bearings(1.003);
  liar.bearings[2].direction_camera = Eigen::Vector3d(0.5, 0.5, 1).normalized();
  EXPECT_EQ(filter.add_bearings(liar), std::nullopt);
  EXPECT_EQ(filter.drops()[FilterDrop::kGated], 1u);
  EXPECT_LT(filter.estimate()->T_map_base.translation().norm(), 0.01);
}

TEST(PoseFilter, spinning_wheels_are_gated) {
  PoseFilter filter = standing_filter(4.0);
  for (int i = 401; i <= 500; ++i) {
    filter.add_imu(still_imu(0.01 * i));
    EXPECT_EQ(filter.add_odometry(wheels(0.01 * i, 1.5)), FilterDrop::kGated);
  }
  EXPECT_LT(filter.estimate()->T_map_base.translation().norm(), 0.05);
}

/// At rest an accelerometer's bias looks like tilt; a floor that is level at large shares it out by the sigmas.
TEST(PoseFilter, the_floor_tells_bias_from_tilt) {
  PoseFilterParams params;
  params.level_sigma_rad = 0.001;
  PoseFilter filter{params};
  for (int i = 0; i <= 400; ++i) {
    ImuSample imu = still_imu(0.01 * i);
    imu.specific_force_m_s2.x() = 0.05;  // 5.1 mrad
    filter.add_imu(imu);
    if (i % 2 == 0) filter.add_odometry(wheels(0.01 * i));
    if (i == 10) {
      Fix start = fix(0.1);
      start.covariance.diagonal().tail<3>().setConstant(1e-4);
      filter.add_fix(start);
    }
  }
  EXPECT_LT(std::abs(roll_pitch_yaw(filter.estimate()->T_map_base.linear()).pitch_rad), 0.001);
}

TEST(PoseFilter, bad_input_is_dropped_by_reason) {
  PoseFilter filter = standing_filter();
  const auto before = filter.estimate();
  for (const double bad : {kNan, kInfinite, -kInfinite, 1e30}) {
    ImuSample imu = still_imu(1.01);
    imu.angular_velocity_rad_s.y() = bad;
    EXPECT_EQ(filter.add_imu(imu), FilterDrop::kInvalid);
    imu = still_imu(1.01);
    imu.specific_force_m_s2.x() = bad;
    EXPECT_EQ(filter.add_imu(imu), FilterDrop::kInvalid);
    EXPECT_EQ(filter.add_odometry(wheels(1.01, bad)), FilterDrop::kInvalid);
    OdometrySample odometry = wheels(1.01);
    odometry.yaw_rate_rad_s = bad;
    EXPECT_EQ(filter.add_odometry(odometry), FilterDrop::kInvalid);
    EXPECT_EQ(filter.add_fix(fix(1.01, {0, bad, 0})), FilterDrop::kInvalid);
    Fix f = fix(1.01);
    f.covariance(5, 5) = -bad;
    if (bad != -kInfinite) {
      EXPECT_EQ(filter.add_fix(f), FilterDrop::kInvalid);
    }
    for (int what = 0; what < 4; ++what) {
      BeaconBearings b = bearings(1.01);
      b.bearings.resize(1);
      if (what == 0) b.bearings[0].direction_camera.z() = bad;
      if (what == 1) b.bearings[0].position_map.x() = bad;
      if (what == 2) b.bearings[0].covariance(0, 0) = bad;
      if (what == 3) b.bearings[0].position_sigma_m = bad == 1e30 ? -1 : bad;
      EXPECT_EQ(filter.add_bearings(b), FilterDrop::kInvalid) << what << " " << bad;
    }
  }
  Fix skewed = fix(1.01);
  skewed.T_map_base.linear() *= 1.1;
  EXPECT_EQ(filter.add_fix(skewed), FilterDrop::kInvalid);
  BeaconBearings half = bearings(1.01);
  half.bearings[0].direction_camera *= 2;
  EXPECT_EQ(filter.add_bearings(half), std::nullopt) << "the other three are good";
  EXPECT_EQ(filter.drops()[FilterDrop::kInvalid], 4u * 4u + 4u + 3u + 16u + 2u);
  EXPECT_LT((filter.estimate()->T_map_base.translation() - before->T_map_base.translation()).norm(), 1e-3);
}

TEST(PoseFilter, stamps_that_do_not_fit) {
  PoseFilter filter = standing_filter(3.0);
  EXPECT_EQ(filter.add_imu(still_imu(3.0)), FilterDrop::kDuplicate);
  EXPECT_EQ(filter.add_odometry(wheels(2.0)), FilterDrop::kDuplicate);
  EXPECT_EQ(filter.add_bearings(bearings(2.0)), FilterDrop::kDuplicate);
  EXPECT_EQ(filter.add_imu(still_imu(0.9)), FilterDrop::kTooOld);
  EXPECT_EQ(filter.add_bearings(bearings(0.5)), FilterDrop::kTooOld);
  EXPECT_EQ(filter.add_bearings(bearings(5.1)), FilterDrop::kFuture);
  EXPECT_EQ(filter.add_imu(still_imu(2.995)), std::nullopt) << "late, but not too late";
  EXPECT_EQ(filter.drops().total(), 6u);
  EXPECT_EQ(filter.mode(), FilterMode::kTracking);
  filter.reset();
  EXPECT_EQ(filter.mode(), FilterMode::kStarting);
  EXPECT_EQ(filter.add_imu(still_imu(0.1)), std::nullopt) << "time may begin again";
}

TEST(PoseFilter, a_gap_of_seconds_grows_the_covariance) {
  PoseFilter filter = standing_filter();
  const double before = filter.estimate()->covariance(0, 0);
  filter.add_imu(still_imu(2.2));
  ASSERT_TRUE(filter.estimate());
  EXPECT_GT(filter.estimate()->covariance(0, 0), 4 * before);
  for (int i = 221; i < 300; ++i) {
    filter.add_imu(still_imu(0.01 * i));
    filter.add_odometry(wheels(0.01 * i));
    if (i % 5 == 0) {
      EXPECT_EQ(filter.add_bearings(bearings(0.01 * i)), std::nullopt);
    }
  }
  EXPECT_EQ(filter.mode(), FilterMode::kTracking);
  filter.add_imu(still_imu(100));
  EXPECT_EQ(filter.mode(), FilterMode::kLost);
}

TEST(PoseFilter, more_beacons_than_room) {
  PoseFilter filter = standing_filter();
  BeaconBearings many = bearings(1.01);
  for (std::uint32_t id = 100; id < 120; ++id) {
    BeaconBearing b = many.bearings[0];
    b.beacon = BeaconId{id};
    b.position_map.x() += 0.1 * (id - 100);
    b.direction_camera = b.position_map.normalized();
    b.covariance = 1e-6 * Eigen::Matrix3d::Identity();
    many.bearings.push_back(b);
  }
  filter.add_imu(still_imu(1.01));
  EXPECT_EQ(filter.add_bearings(many), std::nullopt);
  EXPECT_EQ(filter.drops()[FilterDrop::kCrowded], 24u - fusion::kMaxOffsets);
}

TEST(PoseFilter, stays_a_covariance_and_a_rotation_for_very_long) {
  PoseFilter filter{PoseFilterParams{}};
  filter.add_imu(still_imu(0));
  filter.add_odometry(wheels(0));
  filter.add_fix(fix(0));
  for (int i = 1; i <= 200000; ++i) {
    filter.add_imu(still_imu(0.005 * i));
    if (i % 20 == 0) filter.add_odometry(wheels(0.005 * i));
    if (i % 100 == 0) filter.add_bearings(bearings(0.005 * i));
  }
  const auto estimate = filter.estimate();
  ASSERT_TRUE(estimate);
  const Eigen::Matrix3d R = estimate->T_map_base.linear();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((estimate->covariance - estimate->covariance.transpose()).norm(), 1e-15);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(estimate->covariance);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 0);
  EXPECT_GT(std::sqrt(estimate->covariance(0, 0)), 0.003) << "1000 s of the same bearings are not 1000 bearings";
  EXPECT_LT(estimate->T_map_base.translation().norm(), 0.01);
}

}  // namespace
}  // namespace lodestar::test
