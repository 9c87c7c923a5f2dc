#include "lodestar/ros/convert/pallet.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lodestar/base/measurement/pose_limits.hpp"

namespace lodestar {
namespace {

TEST(LoadSample, ForkHeightsThatNoTruckHasAreRefused) {
  LoadState message;
  message.header.stamp = ros::Time(1);
  for (const double height_m : {-0.1, 0.0, 18.0}) {
    message.fork_height_m = height_m;
    EXPECT_TRUE(load_sample_from(message)) << height_m;
  }
  for (const double height_m : {-1.1, 30.1, 1e200}) {
    message.fork_height_m = height_m;
    EXPECT_EQ(load_sample_from(message).error(), MessageDrop::kRange) << height_m;
  }
  message.fork_height_m = std::nan("");
  EXPECT_EQ(load_sample_from(message).error(), MessageDrop::kNotFinite);
}

TEST(Pallet, ComesBackOrIsRefused) {
  Pallet pallet;
  pallet.T_map_pallet.translation() << kFarthest_m, -kFarthest_m, 2;
  pallet.covariance.setConstant(kUnknownSigma * kUnknownSigma);
  const PalletEntry good = pallet_message(pallet);
  const auto back = pallet_from(good);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->T_map_pallet.translation(), pallet.T_map_pallet.translation());
  EXPECT_EQ(back->covariance, pallet.covariance);

  PalletEntry bad = good;
  bad.pose.pose.position.x = 1e305;
  EXPECT_EQ(pallet_from(bad).error(), MessageDrop::kRange);
  bad = good;
  bad.pose.covariance[14] = 1e7;
  EXPECT_EQ(pallet_from(bad).error(), MessageDrop::kRange);
  bad.pose.covariance[14] = INFINITY;
  EXPECT_EQ(pallet_from(bad).error(), MessageDrop::kNotFinite);
  bad = good;
  bad.state = 5;
  EXPECT_EQ(pallet_from(bad).error(), MessageDrop::kRange);
}

}  // namespace
}  // namespace lodestar
