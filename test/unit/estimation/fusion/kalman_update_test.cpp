#include "lodestar/estimation/fusion/kalman_update.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "lodestar/estimation/fusion/source_offsets.hpp"

namespace lodestar::fusion {
namespace {

FilterState some_state() {
  FilterState x;
  x.offsets.resize(2);
  std::srand(1);
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(x.size(), x.size());
  x.P = A * A.transpose() + Eigen::MatrixXd::Identity(x.size(), x.size());
  return x;
}

Innovation<2> some_innovation() {
  Innovation<2> m;
  m.H.setRandom();
  m.offset_count = 1;
  m.offsets[0].index = 1;
  m.offsets[0].H.setRandom();
  m.residual << 0.3, -0.2;
  m.R << 2, 0.5, 0.5, 1;
  return m;
}

TEST(KalmanUpdate, is_the_textbook_update) {
  FilterState x = some_state();
  Innovation<2> m = some_innovation();
  m.inflation = 3;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, x.size());
  H.leftCols(kCore) = m.H;
  H.middleCols(kCore + 3, 3) = m.offsets[0].H;
  const Eigen::MatrixXd P = x.P, I = Eigen::MatrixXd::Identity(x.size(), x.size());
  const Eigen::MatrixXd R = 3 * m.R, S = H * P * H.transpose() + R, K = P * H.transpose() * S.inverse();
  const Eigen::MatrixXd joseph = (I - K * H) * P * (I - K * H).transpose() + K * R * K.transpose();

  EXPECT_NEAR(squared_distance(x.P, m), m.residual.dot((H * P * H.transpose() + m.R).inverse() * m.residual), 1e-12);
  const double distance2 = squared_distance(x.P, m);
  EXPECT_EQ(correct_within(0.99 * distance2, x, m), distance2);
  EXPECT_EQ(Eigen::MatrixXd(x.P), P) << "beyond its gate";
  EXPECT_EQ(correct_within(1.01 * distance2, x, m), distance2);
  EXPECT_LT((x.P - x.P.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((Eigen::MatrixXd(x.P) - joseph).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(x.position.x(), K.row(kPosition).dot(m.residual), 1e-12);
  EXPECT_NEAR(x.offsets[1].value.z(), K.row(kCore + 5).dot(m.residual), 1e-12);
}

TEST(SourceOffsets, keep_their_correlation_while_others_come) {
  FilterState x;
  x.P.setIdentity(kCore, kCore);
  const auto first = open_offset(x, 7, 4 * Eigen::Matrix3d::Identity(), 0);
  ASSERT_TRUE(first);
  x.P(kPosition, kCore) = x.P(kCore, kPosition) = 0.5;
  const auto second = open_offset(x, 8, Eigen::Matrix3d::Identity(), 0);
  ASSERT_TRUE(second);
  EXPECT_EQ(find_offset(x, 7), first);
  EXPECT_EQ(find_offset(x, 8), second);
  EXPECT_FALSE(find_offset(x, 9));
  EXPECT_EQ(x.P.rows(), kCore + 6);
  EXPECT_DOUBLE_EQ(x.P(kPosition, kCore), 0.5);
  EXPECT_DOUBLE_EQ(x.P(kCore, kCore), 4.0);
  EXPECT_DOUBLE_EQ(x.P(kCore + 3, kCore + 3), 1.0);
}

TEST(SourceOffsets, the_oldest_makes_room_but_not_a_fresh_one) {
  FilterState x;
  x.P.setIdentity(kCore, kCore);
  x.stamp = Stamp(std::chrono::seconds(10));
  for (int i = 0; i < kMaxOffsets; ++i) {
    const auto index = open_offset(x, static_cast<std::uint64_t>(i), Eigen::Matrix3d::Identity(), 1.0);
    ASSERT_TRUE(index);
    x.offsets[static_cast<std::size_t>(*index)].last_seen = x.stamp - std::chrono::milliseconds(100 * (i + 1));
  }
  x.P(kPosition, kCore + 3 * (kMaxOffsets - 1)) = 0.5;
  const auto index = open_offset(x, 99, 2 * Eigen::Matrix3d::Identity(), 1.0);
  ASSERT_EQ(index, kMaxOffsets - 1);
  EXPECT_EQ(x.P(kPosition, kCore + 3 * *index), 0.0);
  EXPECT_FALSE(find_offset(x, kMaxOffsets - 1));
  EXPECT_FALSE(open_offset(x, 100, Eigen::Matrix3d::Identity(), 100.0));
}

TEST(SourceOffsets, relaxing_is_stationary) {
  FilterState x;
  x.P.setIdentity(kCore, kCore);
  const Eigen::Matrix3d prior = Eigen::Vector3d(1, 2, 3).asDiagonal();
  const int index = *open_offset(x, 1, prior, 0);
  x.offsets[0].value << 1, 1, 1;
  relax_offset(x, index, 0.8, prior);
  EXPECT_LT((Eigen::Matrix3d(x.P.block<3, 3>(kCore, kCore)) - prior).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(x.offsets[0].value.x(), 0.8);
}

}  // namespace
}  // namespace lodestar::fusion
