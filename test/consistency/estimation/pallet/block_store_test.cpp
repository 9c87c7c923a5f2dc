#include "support/block_store.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/chi_square.hpp"

namespace lodestar {
namespace {

using test::BlockStore;
using test::BlockStoreParams;
using test::BlockStoreTally;

/// bench/pallet_report.cpp runs more of the same.
TEST(BlockStore, every_pallet_is_the_right_one_and_where_it_was_set_down) {
  BlockStoreParams params;
  params.covariances = {test::usual_covariance()};
  BlockStore store(params, 1);
  const BlockStoreTally tally = store.run(1000);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_LT(tally.asked, 10);
  EXPECT_GT(tally.stacks, 50);
  EXPECT_GT(tally.unread, 250);
  EXPECT_GT(tally.identified, 1000);
  EXPECT_LT(tally.mean_error_m(), 0.030);
  EXPECT_LT(tally.mean_yaw_error_rad(), radians(1));
  printf("wrong %d asked %d identified %d stacks %d unread %d err %.4f yaw %.3f nees %.3f max %.3f\n", tally.wrong,
         tally.asked, tally.identified, tally.stacks, tally.unread, tally.mean_error_m(),
         degrees(tally.mean_yaw_error_rad()), tally.mean_nees(), tally.error_max_m);
}

}  // namespace
}  // namespace lodestar
