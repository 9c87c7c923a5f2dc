#include "lodestar/evaluation/trajectory_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

const Stamp kZero{std::chrono::seconds(1700000000)};

Stamp at(double s) { return kZero + from_seconds(s); }

RigidTransform pose(double x, double y, double yaw_rad, double z = 0) {
  RigidTransform T = RigidTransform::Identity();
  T.linear() = rotation({0, 0, yaw_rad});
  T.translation() << x, y, z;
  return T;
}

/// 2 s of rest, then 3 s at 2 m/s along x.
TruthTrack truth() {
  TruthTrack track;
  for (int i = 0; i <= 500; ++i) {
    const double t = i * 0.01;
    track.add({at(t), pose(1 + 2 * std::max(0.0, t - 2), 5, 0.3)});
  }
  return track;
}

EstimateRow row(double t, const RigidTransform& T, double sigma = 0.1) {
  EstimateRow r;
  r.stamp = at(t);
  r.T_map_base = T;
  r.sigma_x_m = r.sigma_y_m = r.sigma_yaw_rad = sigma;
  r.beacons_used = 2;
  r.mode = "tracking";
  return r;
}

TEST(TruthTrack, InterpolatesBetweenItsSamples) {
  TruthTrack track;
  track.add({at(0), pose(0, 0, radians(170))});
  track.add({at(0.1), pose(1, 2, radians(-170))});
  const auto middle = track.at(at(0.05));
  ASSERT_TRUE(middle);
  EXPECT_NEAR((middle->translation() - Eigen::Vector3d(0.5, 1, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(std::abs(roll_pitch_yaw(middle->linear()).yaw_rad), kPi, 1e-9);  // the short way round
  EXPECT_NEAR(*track.speed_m_s(at(0.05)), std::sqrt(5.0) / 0.1, 1e-6);
}

TEST(TruthTrack, SaysItsOwnSamplesExactly) {
  const TruthTrack track = truth();
  for (const auto& sample : track.samples()) {
    const auto same = track.at(sample.stamp);
    ASSERT_TRUE(same) << seconds(sample.stamp - kZero);
    EXPECT_NEAR((same->matrix() - sample.T_map_base.matrix()).norm(), 0, 1e-6);
  }
}

TEST(TruthTrack, SaysNothingOutsideAndInGaps) {
  TruthTrack track;
  track.add({at(0), pose(0, 0, 0)});
  track.add({at(0.1), pose(0, 0, 0)});
  track.add({at(2), pose(0, 0, 0)});
  EXPECT_FALSE(track.add({at(1), pose(0, 0, 0)}));
  EXPECT_TRUE(track.at(at(0.04)));
  EXPECT_FALSE(track.at(at(-0.01)));
  EXPECT_FALSE(track.at(at(1)));
  EXPECT_FALSE(track.at(at(2.01)));
}

TEST(ErrorStatistics, AreThoseOfTheNumbers) {
  const ErrorStatistics s = error_statistics({4, 1, 2, 3});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4));
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.p95, 3.85);
  EXPECT_DOUBLE_EQ(s.max, 4);
}

TEST(TrajectoryError, SplitsRestAndMotionAndKeepsHeightApart) {
  const TruthTrack track = truth();
  std::vector<EstimateRow> estimate;
  for (double t = 0.5; t < 5; t += 0.02) {
    const RigidTransform T = *track.at(at(t));
    const double off = t < 2 ? 0.03 : 0.04;
    estimate.push_back(row(t, pose(T.translation().x() + off, 5 - off, 0.3 - 0.01, 0.2)));
  }
  const TrajectoryError error = trajectory_error(track, estimate);
  EXPECT_EQ(error.all.samples, estimate.size());
  EXPECT_EQ(error.standing.samples + error.moving.samples, error.all.samples);
  EXPECT_NEAR(static_cast<double>(error.standing.samples), 75, 4);
  EXPECT_NEAR(error.standing.position_m.median, 0.03 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(error.moving.position_m.median, 0.04 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(error.all.yaw_rad.max, 0.01, 1e-9);
  EXPECT_NEAR(error.all.z_m.mean, 0.2, 1e-9);
  EXPECT_NEAR(error.standing.nees->mean, (2 * 0.0009 + 0.0001) / 0.01, 0.01);
  EXPECT_NEAR(*error.time_to_first_fix_s, 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(error.availability, 1);
}

TEST(TrajectoryError, RelativeErrorForgetsAConstantOffset) {
  const TruthTrack track = truth();
  std::vector<EstimateRow> offset, drifting;
  for (double t = 0; t < 5; t += 0.05) {
    const Eigen::Vector3d p = track.at(at(t))->translation();
    offset.push_back(row(t, pose(p.x() + 7, p.y() - 3, 0.3)));
    drifting.push_back(row(t, pose(p.x() + 0.1 * t, p.y(), 0.3 + 0.02 * t)));
  }
  const auto constant = trajectory_error(track, offset).relative;
  EXPECT_GT(constant.samples, 70u);
  EXPECT_NEAR(constant.position_m.max, 0, 1e-6);
  const auto drift = trajectory_error(track, drifting).relative;
  EXPECT_NEAR(drift.yaw_rad.mean, 0.02, 1e-6);
  EXPECT_GT(drift.position_m.mean, 0.09);
}

TEST(TrajectoryError, AvailabilityCountsTimeWithoutAFreshEstimate) {
  const TruthTrack track = truth();
  std::vector<EstimateRow> estimate;
  for (double t = 1; t < 5; t += 0.02)
    if (t < 2 || t > 3) estimate.push_back(row(t, *track.at(at(t))));
  // from 1 s to 5 s; missing from 0.1 s after the last before 2 s to the first after 3 s
  EXPECT_NEAR(trajectory_error(track, estimate).availability, 1 - 0.9 / 4, 0.02);
}

TEST(TrajectoryError, AvailabilityCountsAnEarlyEnd) {
  const TruthTrack track = truth();
  std::vector<EstimateRow> estimate;
  for (double t = 0; t < 2.5; t += 0.02) estimate.push_back(row(t, *track.at(at(t))));
  EXPECT_NEAR(trajectory_error(track, estimate).availability, 2.58 / 5, 0.01);
}

TEST(TrajectoryError, RowsOutsideTheTruthAreCountedApart) {
  const TruthTrack track = truth();
  const auto error = trajectory_error(track, {row(-1, pose(0, 0, 0)), row(1, *track.at(at(1))), row(9, pose(0, 0, 0))});
  EXPECT_EQ(error.all.samples, 1u);
  EXPECT_EQ(error.outside_truth, 2u);
}

TEST(TrajectoryJson, HasTheKeysOfTheInterfacesPage) {
  const TruthTrack track = truth();
  const auto json = nlohmann::json::parse(to_json(trajectory_error(track, {row(1, pose(1.03, 5.04, 0.31))})));
  EXPECT_EQ(json["all"]["samples"], 1);
  for (const char* part : {"all", "standing", "moving"}) {
    for (const char* key : {"mean_m", "rmse_m", "median_m", "p95_m", "max_m"}) {
      EXPECT_TRUE(json[part]["position"].contains(key)) << part << key;
      EXPECT_TRUE(json[part]["z"].contains(key)) << part << key;
    }
    for (const char* key : {"mean_rad", "rmse_rad", "median_rad", "p95_rad", "max_rad"})
      EXPECT_TRUE(json[part]["yaw"].contains(key)) << part << key;
    EXPECT_TRUE(json[part].contains("nees_mean"));
  }
  EXPECT_NEAR(json["all"]["position"]["mean_m"].get<double>(), 0.05, 1e-6);
  EXPECT_EQ(json["moving"]["samples"], 0);
  EXPECT_TRUE(json["moving"]["position"]["mean_m"].is_null());
  EXPECT_TRUE(json["moving"]["nees_mean"].is_null());
  EXPECT_NEAR(json["time_to_first_fix_s"].get<double>(), 1, 1e-9);
}

TEST(TrajectoryJson, AnEmptyEstimateIsNullNotNaN) {
  const auto json = nlohmann::json::parse(to_json(trajectory_error(truth(), {})));
  EXPECT_EQ(json["all"]["samples"], 0);
  EXPECT_EQ(json["availability"], 0);
  EXPECT_TRUE(json["time_to_first_fix_s"].is_null());
  EXPECT_TRUE(json["all"]["position"]["rmse_m"].is_null());
}

TEST(TrajectoryError, WithoutSigmaThereIsNoNees) {
  const TruthTrack track = truth();
  EXPECT_FALSE(trajectory_error(track, {row(1, pose(1, 5, 0.3), 0.0)}).all.nees);
}

}  // namespace
}  // namespace lodestar
