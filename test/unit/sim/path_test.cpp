#include "lodestar/sim/path.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

const std::vector<Path::Corner> kRound{{{0, 0}, 3}, {{20, 0}, 3}, {{20, 15}, 2}, {{5, 15}, 3}, {{0, 8}, 2}};

TEST(Path, ClosedPathMeetsItself) {
  const Path path(kRound, true);
  const Path::Point begin = path.at(0), end = path.at(path.length_m());
  EXPECT_NEAR((begin.position_m - end.position_m).norm(), 0, 1e-9);
  EXPECT_NEAR(wrap_angle(begin.heading_rad - end.heading_rad), 0, 1e-9);
  EXPECT_NEAR(begin.curvature_1_m, end.curvature_1_m, 1e-9);
}

TEST(Path, HeadingIsTheTangentAndCurvatureItsRate) {
  const Path path(kRound, true);
  const double h = 1e-5;
  for (double s = 0.1; s < path.length_m() - 0.1; s += 0.37) {
    const Path::Point a = path.at(s - h), b = path.at(s + h), c = path.at(s);
    const Eigen::Vector2d tangent = (b.position_m - a.position_m) / (2 * h);
    EXPECT_NEAR(tangent.norm(), 1, 1e-6);
    EXPECT_NEAR(wrap_angle(std::atan2(tangent.y(), tangent.x()) - c.heading_rad), 0, 1e-6);
    EXPECT_NEAR((b.heading_rad - a.heading_rad) / (2 * h), c.curvature_1_m, 1e-4);
  }
}

TEST(Path, CurvatureNeverJumps) {
  const Path path(kRound, true);
  double last = path.at(0).curvature_1_m;
  for (double s = 0; s < path.length_m(); s += 0.01) {
    const double now = path.at(s).curvature_1_m;
    EXPECT_NEAR(now, last, 0.01);
    last = now;
  }
}

TEST(Path, StationsLieAtTheCorners) {
  const Path path({{{0, 0}, 0}, {{10, 0}, 2}, {{10, 10}, 0}}, false);
  EXPECT_NEAR(path.station_m(0), 0, 1e-12);
  const Path::Point middle = path.at(path.station_m(1));
  EXPECT_NEAR(middle.heading_rad, radians(45), 1e-9);
  EXPECT_NEAR((path.at(path.length_m()).position_m - Eigen::Vector2d(10, 10)).norm(), 0, 1e-9);
  EXPECT_NEAR(path.length_m(), path.station_m(2), 1e-12);
}

TEST(Path, RefusesWhatCannotBeDriven) {
  EXPECT_THROW(Path({{{0, 0}, 0}}, false), std::invalid_argument);
  EXPECT_THROW(Path({{{0, 0}, 0}, {{0, 0}, 0}}, false), std::invalid_argument);
  EXPECT_THROW(Path({{{0, 0}, 0}, {{5, 0}, 0}, {{5, 5}, 0}}, false), std::invalid_argument);    // no radius
  EXPECT_THROW(Path({{{0, 0}, 0}, {{5, 0}, 9}, {{5, 5}, 0}}, false), std::invalid_argument);    // too wide
  EXPECT_THROW(Path({{{0, 0}, 0}, {{5, 0}, 1}, {{0, 0.1}, 0}}, false), std::invalid_argument);  // turns back
}

}  // namespace
}  // namespace lodestar::sim
