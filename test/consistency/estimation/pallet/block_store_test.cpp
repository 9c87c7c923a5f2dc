#include "support/block_store.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/chi_square.hpp"

namespace lodestar {
namespace {

using test::BlockStore;
using test::BlockStoreParams;
using test::PalletTally;

/// bench/pallet_report.cpp runs more of the same.
TEST(BlockStore, every_pallet_is_the_right_one_and_where_it_was_set_down) {
  BlockStoreParams params;
  params.covariances = {test::usual_covariance()};
  const PalletTally tally = BlockStore(params, 1).run(1000);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_LE(tally.asked + tally.wrong, 0.001 * tally.moves);
  EXPECT_GT(tally.identified, 1000);
  EXPECT_GT(tally.unread, 0.25 * tally.moves);
  EXPECT_GT(tally.stacks, 50);
  EXPECT_LT(tally.mean_error_m(), 0.030);
  EXPECT_LT(tally.mean_yaw_error_rad(), radians(1));
}

/// Pallets that were met before bring what was known of them along; so their errors are those of one another.
TEST(BlockStore, the_covariance_of_the_set_down_pose_is_honest) {
  BlockStoreParams params;
  params.covariances = {test::usual_covariance(), 4 * test::usual_covariance()};
  double sum = 0;
  int count = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const PalletTally tally = BlockStore(params, seed).run(300);
    sum += tally.nees_sum;
    count += tally.set_down;
  }
  const double mean = sum / count;
  EXPECT_GT(mean, chi_square_quantile(0.005, 4.0 * count) / count) << count << " pallets";
  EXPECT_LT(mean, chi_square_quantile(0.995, 4.0 * count) / count) << count << " pallets";
}

/// A truck that hardly knows where it is (0.3 m, 2 deg) asks, and does not guess.
TEST(BlockStore, a_lost_truck_asks) {
  BlockStoreParams params;
  Matrix6 lost = test::usual_covariance();
  for (const int axis : {0, 1, 5}) lost(axis, axis) *= 400;
  params.covariances = {lost};
  params.label_probability = 0;
  params.stack = 1;
  const PalletTally tally = BlockStore(params, 3).run(200);
  EXPECT_GT(tally.asked, 100);
  EXPECT_LT(tally.wrong, 4);
}

}  // namespace
}  // namespace lodestar
