#include "lodestar/estimation/fusion/integrity.hpp"

#include <gtest/gtest.h>

#include "lodestar/estimation/fusion/corrections.hpp"
#include "lodestar/estimation/fusion/start.hpp"
#include "support/fusion_run.hpp"

namespace lodestar::test {
namespace {

using fusion::FilterState;
using fusion::IntegrityFactors;

constexpr std::size_t kRate = TruckDrive::kRate_hz;

Fix start_fix() {
  Fix fix;
  fix.stamp = TruckDrive::stamp(kRate);
  fix.covariance.diagonal() << 4e-4, 4e-4, 4e-4, 1e-5, 1e-5, 1e-5;
  return fix;
}

BeaconBearing bearing_to(std::uint32_t id, const Eigen::Vector3d& surveyed, const Eigen::Vector3d& where_it_hangs) {
  BeaconBearing b;
  b.beacon = BeaconId{id};
  b.position_map = surveyed;
  b.direction_camera = where_it_hangs.normalized();
  b.covariance = 1e-6 * (Eigen::Matrix3d::Identity() - b.direction_camera * b.direction_camera.transpose());
  return b;
}

/// A state at the origin that drives along x, after bearings of one instant to eight beacons, the first of them moved.
FilterState state_after_bearings(const PoseFilterParams& params, const Eigen::Vector3d& moved, double speed_m_s = 0) {
  fusion::Inputs inputs;
  OdometrySample wheels;
  wheels.stamp = start_fix().stamp;
  wheels.velocity_m_s.x() = speed_m_s;
  inputs.wheels = wheels;
  FilterState state = fusion::start_state(start_fix(), inputs, {}, params);
  BeaconBearings bearings{state.stamp, {}};
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double angle = 2 * kPi * i / 8;
    const Eigen::Vector3d place(4 * std::cos(angle), 4 * std::sin(angle), 6);
    bearings.bearings.push_back(bearing_to(i + 1, place, i == 0 ? Eigen::Vector3d(place + moved) : place));
  }
  fusion::correct_with_bearings(state, bearings, {}, fusion::Gates(1 - 1e-12), IntegrityFactors(params), params);
  return state;
}

TEST(Integrity, a_doubted_clock_tells_as_little_as_one_that_was_never_trusted) {
  PoseFilterParams trusted, untrusted;
  untrusted.camera_time_offset_sigma_s = 0.1;
  trusted.lens_scale_sigma = untrusted.lens_scale_sigma = 1e-5;
  FilterState a = state_after_bearings(trusted, {0, 0, 0}, 2.0);
  const FilterState b = state_after_bearings(untrusted, {0, 0, 0}, 2.0);
  ASSERT_LT(a.P(0, 0), 0.5 * b.P(0, 0)) << "at 2 m/s a wrong clock is a wrong place";
  fusion::doubt_clock(a);
  EXPECT_NEAR(a.P(0, 0), b.P(0, 0), 0.02 * b.P(0, 0));
  EXPECT_NEAR(a.P(fusion::kTimeOffset, fusion::kTimeOffset), b.P(fusion::kTimeOffset, fusion::kTimeOffset), 2e-4);
  EXPECT_NEAR(a.position.x(), b.position.x(), 1e-3);
}

TEST(Integrity, the_beacon_that_hangs_elsewhere_is_excluded_and_no_other) {
  const PoseFilterParams params;
  const FilterState state = state_after_bearings(params, {0.1, 0.04, 0});
  for (const BeaconCheck& check : fusion::check_beacons(state)) EXPECT_EQ(check.excluded, check.beacon.value == 1u);
  const FilterState good = state_after_bearings(params, {0, 0, 0});
  EXPECT_NEAR((state.position - good.position).head<2>().norm(), 0, 0.004) << "what it told is taken back";
  EXPECT_GT(state.P(0, 0), good.P(0, 0));
}

TEST(Integrity, true_beacons_are_not_excluded) {
  for (const BeaconCheck& check : fusion::check_beacons(state_after_bearings({}, {0.01, 0.01, 0}))) {
    EXPECT_FALSE(check.excluded) << check.beacon.value;
    EXPECT_LT(check.distance2, 16);
  }
}

TEST(Integrity, the_level_grows_with_what_is_asked_of_it_and_with_what_is_not_known) {
  const FilterState state = state_after_bearings({}, {0, 0, 0});
  PoseFilterParams strict;
  strict.integrity_risk_1_h = 1e-7;
  const double level = fusion::protection_level_m(state, {}, IntegrityFactors(PoseFilterParams{}));
  EXPECT_GT(level, 5 * std::sqrt(state.P(0, 0)));
  EXPECT_GT(fusion::protection_level_m(state, {}, IntegrityFactors(strict)), 1.05 * level);

  FilterState wide = state;
  wide.P.diagonal().head<2>().array() += 0.01;
  EXPECT_GT(fusion::protection_level_m(wide, {}, IntegrityFactors(PoseFilterParams{})), 5 * 0.1);
}

TEST(Integrity, where_one_beacon_alone_says_the_place_its_lie_counts_in_full) {
  const PoseFilterParams params;
  FilterState state = fusion::start_state(start_fix(), {}, {}, params);
  state.P.diagonal().head<2>().setConstant(1.0);
  const Eigen::Vector3d place(0, 0, 6);
  fusion::correct_with_bearings(state, {state.stamp, {bearing_to(1, place, place)}}, {}, fusion::Gates(0.999),
                                IntegrityFactors(params), params);
  ASSERT_LT(std::sqrt(state.P(0, 0)), 0.1);
  // Beside a position of 1 m that it fits into, a beacon could be off by some metres.
  EXPECT_GT(fusion::protection_level_m(state, {}, IntegrityFactors(params)), 3.0);
}

}  // namespace
}  // namespace lodestar::test
