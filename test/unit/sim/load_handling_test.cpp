#include "lodestar/sim/load_handling.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "lodestar/base/measurement/sscc.hpp"

namespace lodestar::sim {
namespace {

/// Drives along x: takes at x = 5, leaves at 15 upon what stands there, takes at 15 and leaves in the dock at 25.
class Loads : public testing::Test {
 protected:
  Loads() {
    params_.height_sigma_m = params_.seat_sigma_m = params_.seat_sigma_rad = 0;
    const auto stop = [&](double x, LoadMove load, double z_m) {
      RouteParams::Waypoint waypoint;
      waypoint.position_m = {x, 2};
      waypoint.stop_s = 4;
      waypoint.load = load;
      waypoint.load_z_m = z_m;
      route_.waypoints.push_back(waypoint);
    };
    stop(5, LoadMove::kTake, 0);
    stop(15, LoadMove::kLeave, 1);
    stop(15.1, LoadMove::kTake, 1);
    stop(25, LoadMove::kLeave, 0);
    Zone dock;
    dock.code = "OUT";
    dock.kind = ZoneKind::kDock;
    dock.polygon_map = {{20, 0}, {30, 0}, {30, 4}, {20, 4}};
    zones_ = {dock};
    T_base_fork_.translation() << 1, 0, 0.08;
  }

  /// Runs to the end of the route; each change of the pallets, and the samples.
  void run() {
    const Truck truck(route_, {}, {}, 1);
    LoadHandling loads(params_, truck.route(), T_base_fork_, zones_, 1);
    for (int i = 0; i < 20 * truck.route().duration_s(); ++i) {
      const double time_s = 0.05 * i;
      samples_.push_back(loads.sample(truck, time_s, Stamp(from_seconds(100 + time_s))));
      if (loads.moved()) moves_.push_back(loads.pallets());
    }
  }

  LoadParams params_;
  RouteParams route_;
  std::vector<Zone> zones_;
  RigidTransform T_base_fork_ = RigidTransform::Identity();
  std::vector<LoadSample> samples_;
  std::vector<std::vector<Pallet>> moves_;
};

TEST_F(Loads, TakesLeavesTakesAgainAndIsGoneByADock) {
  run();
  ASSERT_EQ(moves_.size(), 4u);
  ASSERT_EQ(moves_[0].size(), 1u);
  EXPECT_EQ(moves_[0][0].state, PalletState::kOnFork);
  EXPECT_TRUE(is_sscc(moves_[0][0].sscc));
  // Half a pallet's length ahead of the fork, the tines in its deck.
  ASSERT_EQ(moves_[1].size(), 1u);
  EXPECT_EQ(moves_[1][0].state, PalletState::kStanding);
  EXPECT_NEAR((moves_[1][0].T_map_pallet.translation() - Eigen::Vector3d(15 + 1 + 0.6, 2, 1)).norm(), 0, 1e-6);
  EXPECT_EQ(moves_[2][0].sscc, moves_[0][0].sscc) << "the one that stands there, not a new one";
  EXPECT_TRUE(moves_[3].empty());
}

TEST_F(Loads, SamplesTellLoadHeightAndLabel) {
  run();
  for (const LoadSample& sample : samples_) {
    EXPECT_EQ(sample.load_present, !sample.label.empty());
    EXPECT_GT(sample.fork_height_m, 0);
  }
  const auto highest = std::max_element(samples_.begin(), samples_.end(),
                                        [](const auto& a, const auto& b) { return a.fork_height_m < b.fork_height_m; });
  EXPECT_NEAR(highest->fork_height_m, 1 + params_.size.deck_m - 0.08, 1e-9);
}

TEST_F(Loads, UnreadLabelsAreEmpty) {
  params_.label_probability = 0;
  run();
  EXPECT_EQ(moves_.size(), 4u);
  for (const LoadSample& sample : samples_) EXPECT_EQ(sample.label, "");
}

TEST_F(Loads, WhatStandsAboveMovesAlong) {
  // It was left a metre up; the fork then goes in below.
  route_.waypoints.erase(route_.waypoints.begin() + 2, route_.waypoints.end());
  const auto stop = [&](double x, LoadMove load) {
    RouteParams::Waypoint waypoint = route_.waypoints.front();
    waypoint.position_m.x() = x;
    waypoint.load = load;
    route_.waypoints.push_back(waypoint);
  };
  stop(15.1, LoadMove::kTake);
  stop(18, LoadMove::kLeave);
  run();
  ASSERT_EQ(moves_.size(), 4u);
  EXPECT_EQ(moves_[2].size(), 1u) << "a new one";
  EXPECT_EQ(moves_[2][0].state, PalletState::kOnFork);
  EXPECT_NEAR(moves_[3][0].T_map_pallet.translation().z(), 1, 1e-6);
}

}  // namespace
}  // namespace lodestar::sim
