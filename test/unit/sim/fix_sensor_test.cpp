#include "lodestar/sim/fix_sensor.hpp"

#include <gtest/gtest.h>

#include "lodestar/sim/wheel_odometry.hpp"

namespace lodestar::sim {
namespace {

Truck driving_truck() {
  RouteParams route;
  route.waypoints = {{{0, 0}, 2, 0, 0}, {{1000, 0}, 2, 0, 0}};
  return Truck(route, {}, {}, 1);
}

Stamp at(double t_s) { return Stamp(std::chrono::seconds(1000)) + from_seconds(t_s); }

TEST(FixSensor, is_as_noisy_late_and_wrong_as_told) {
  const Truck truck = driving_truck();
  FixSensorParams params;
  params.latency_from_s = 0.15;
  params.latency_to_s = 0.3;
  params.outlier_probability = 0.02;
  FixSensor sensor(params, 1);
  int outliers = 0, good = 0;
  double square = 0, earliest = 1, latest = 0;
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.1 * i;
    const auto reading = sensor.sample(truck, t, at(t));
    ASSERT_TRUE(reading);
    const Eigen::Vector3d error = reading->fix.T_map_base.translation() - truck.T_map_base(t).translation();
    earliest = std::min(earliest, reading->latency_s);
    latest = std::max(latest, reading->latency_s);
    if (error.norm() > 1) {
      ++outliers;
      EXPECT_NEAR(error.head<2>().norm(), 3, 0.3);
    } else {
      ++good;
      square += error.squaredNorm();
    }
  }
  EXPECT_NEAR(outliers, 80, 30);
  EXPECT_NEAR(std::sqrt(square / (3 * good)), 0.05, 0.002);
  EXPECT_GE(earliest, 0.15);
  EXPECT_NEAR(earliest, 0.15, 0.005);
  EXPECT_NEAR(latest, 0.3, 0.005);
}

TEST(FixSensor, says_nothing_in_a_blackout_and_the_same_as_without_one_after_it) {
  const Truck truck = driving_truck();
  FixSensorParams params;
  FixSensor always(params, 1);
  params.blackouts = {{1, 2}};
  FixSensor sometimes(params, 1);
  for (int i = 0; i < 40; ++i) {
    const double t = 0.1 * i + 0.05;
    const auto a = always.sample(truck, t, at(t)), b = sometimes.sample(truck, t, at(t));
    ASSERT_EQ(b.has_value(), t < 1 || t >= 2) << t;
    if (b) {
      EXPECT_EQ(a->fix.T_map_base.translation(), b->fix.T_map_base.translation());
    }
  }
}

TEST(WheelOdometry, slips_for_a_while_now_and_then) {
  const Truck truck = driving_truck();
  WheelOdometryParams params;
  params.velocity_noise_m_s = 0;
  params.slip_every_s = 10;
  params.slip_for_s = 0.5;
  WheelOdometry wheels(params, 1);
  int slipping = 0, starts = 0;
  bool before = false;
  for (int i = 0; i < 20000; ++i) {
    const double t = 5 + 0.02 * i;
    const bool slips = std::abs(wheels.sample(truck, t, at(t)).velocity_m_s.x() - 2) > 1e-6;
    slipping += slips;
    starts += slips && !before;
    before = slips;
  }
  EXPECT_NEAR(starts, 38, 15);
  EXPECT_NEAR(static_cast<double>(slipping) / starts, 25, 3);
}

}  // namespace
}  // namespace lodestar::sim
