// An estimate whose errors have exactly the sigmas that it claims.
#include <gtest/gtest.h>

#include <random>

#include "lodestar/base/common/chi_square.hpp"
#include "lodestar/evaluation/trajectory_error.hpp"

namespace lodestar {
namespace {

TEST(NeesConsistency, AnHonestEstimateHasThreeDegreesOfFreedom) {
  const Stamp zero{std::chrono::seconds(1700000000)};
  TruthTrack truth;
  for (int i = 0; i <= 2000; ++i) {
    RigidTransform T = RigidTransform::Identity();
    T.translation() << 0.01 * i, 3, 0;
    truth.add({zero + from_seconds(0.01 * i), T});
  }
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<EstimateRow> estimate;
    const int n = 400;
    for (int i = 0; i < n; ++i) {
      EstimateRow row;
      row.stamp = zero + from_seconds(0.5 + 0.04 * i);
      row.sigma_x_m = 0.02;
      row.sigma_y_m = 0.05;
      row.sigma_yaw_rad = 0.01;
      const auto T = truth.at(row.stamp);
      ASSERT_TRUE(T);
      row.T_map_base = *T;
      row.T_map_base.translation().x() += row.sigma_x_m * normal(random);
      row.T_map_base.translation().y() += row.sigma_y_m * normal(random);
      row.T_map_base.linear() = rotation({0, 0, row.sigma_yaw_rad * normal(random)});
      estimate.push_back(row);
    }
    const double mean = trajectory_error(truth, estimate).all.nees->mean;
    EXPECT_GT(mean, chi_square_quantile(0.0005, 3 * n) / n) << seed;
    EXPECT_LT(mean, chi_square_quantile(0.9995, 3 * n) / n) << seed;
  }
}

}  // namespace
}  // namespace lodestar
