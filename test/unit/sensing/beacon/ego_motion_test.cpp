#include "lodestar/sensing/beacon/ego_motion.hpp"

#include <gtest/gtest.h>

#include "lodestar/sensing/beacon/image_motion.hpp"
#include "support/beacon/detect.hpp"

namespace lodestar {
namespace {

constexpr double kInterval_s = 1 / 60.0, kHeight_m = 4;
const std::vector<Eigen::Vector2d> kPlaces = {{80, 60}, {560, 90}, {320, 400}, {120, 380}, {500, 300}};

class EgoMotionOf : public testing::TestWithParam<EgoMotion::Twist> {
 protected:
  std::shared_ptr<const CameraModel> camera_ = CameraModel::create(test::fisheye(640, 480, 230)).value();

  std::vector<EgoMotion::Flow> flows(const EgoMotion::Twist& twist) const {
    std::vector<EgoMotion::Flow> all;
    for (const Eigen::Vector2d& pixel : kPlaces) all.push_back({J(pixel), J(pixel) * twist, 1});
    return all;
  }
  EgoMotion::Jacobian J(const Eigen::Vector2d& pixel) const { return EgoMotion::J_flow_twist(pixel, *camera_); }
};

EgoMotion::Twist twist(double wx, double wy, double wz, double vx, double vy) {
  return (EgoMotion::Twist() << wx, wy, wz, vx, vy, 0).finished();
}
INSTANTIATE_TEST_SUITE_P(DrivesOrTurns, EgoMotionOf,
                         testing::Values(twist(0, 0, 0, 1.5, -0.4), twist(0, 0, 1.5, 0, 0), twist(0, 0, 0.8, 0.9, 0),
                                         twist(0.4, -0.7, 0.3, 0, 0)));

TEST_P(EgoMotionOf, IsFoundThoughOneBlobGoesItsOwnWay) {
  auto seen = flows(GetParam());
  seen[2].px_s += Eigen::Vector2d(300, -200);
  EgoMotion motion;
  ASSERT_TRUE(motion.start(seen, kInterval_s));
  for (const Eigen::Vector2d& pixel : kPlaces) {
    const Eigen::Vector2d truth = J(pixel) * GetParam();
    EXPECT_LT((J(pixel) * motion.twist() - truth).norm(), 0.01 * truth.norm());
  }
}

TEST_P(EgoMotionOf, TakesBlobsWhereTheFlowPoints) {
  EgoMotion motion;
  ASSERT_TRUE(motion.start(flows(GetParam()), kInterval_s));
  const ImageMotion image{camera_.get(), kHeight_m};
  for (const Eigen::Vector2d& pixel : kPlaces) {
    const auto now = image.pixel_from(pixel, motion.T_before_now(kInterval_s, kHeight_m).inverse());
    const Eigen::Vector2d flow = J(pixel) * GetParam();
    ASSERT_TRUE(now);
    EXPECT_LT((*now - pixel - flow * kInterval_s).norm(), 0.03 * flow.norm() * kInterval_s);
  }
}

TEST_P(EgoMotionOf, FollowsAChange) {
  EgoMotion motion;
  ASSERT_TRUE(motion.start(flows(GetParam()), kInterval_s));
  const EgoMotion::Twist later = 1.3 * GetParam();
  for (int frame = 0; frame < 60; ++frame) {
    motion.predict();
    motion.refine(flows(later - motion.twist()));
  }
  for (const Eigen::Vector2d& pixel : kPlaces) {
    const Eigen::Vector2d truth = J(pixel) * later;
    EXPECT_LT((J(pixel) * motion.twist() - truth).norm(), 0.02 * truth.norm());
  }
}

TEST_F(EgoMotionOf, IsNotKnownFromTwoBlobsNorFromThoseThatDisagree) {
  auto seen = flows(twist(0, 0, 0, 1, 0));
  EgoMotion motion;
  EXPECT_FALSE(motion.start({seen[0], seen[1]}, kInterval_s));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double angle_rad = 2 * kPi * static_cast<double>(i) / 5 + (i % 2 ? 1 : 0);
    seen[i].px_s = 400 * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  }
  EXPECT_FALSE(motion.start(seen, kInterval_s));
  EXPECT_FALSE(motion.known());
  EXPECT_FALSE(motion.start(flows(EgoMotion::Twist::Zero()), kInterval_s)) << "the camera stands";
}

TEST_F(EgoMotionOf, IsForgottenWhenTheBlobsHaveLongGoneTheirOwnWays) {
  const auto common = twist(0, 0, 0, 1, 0);
  auto seen = flows(common);
  EgoMotion motion;
  ASSERT_TRUE(motion.start(seen, kInterval_s));
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i].px_s = Eigen::Vector2d(i % 2 ? 900 : -900, i % 3 ? 700 : -700);
  for (int frame = 0; frame < 60; ++frame) motion.refine(seen);
  EXPECT_FALSE(motion.known());
}

}  // namespace
}  // namespace lodestar
