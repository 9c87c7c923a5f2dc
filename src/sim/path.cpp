#include "lodestar/sim/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

constexpr double kStraight_rad = 1e-9;
constexpr double kSharpest_rad = radians(175);

/// Where a curve of linear curvature ends, from `start`. Gauss-Legendre of 5 points on pieces of at most half a radian:
/// exact to about 1e-12 of the length.
Path::Point follow(const Path::Point& start, double curvature_rate_1_m2, double length_m) {
  constexpr std::array<double, 5> kNode{0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                        -0.9061798459386640};
  constexpr std::array<double, 5> kWeight{0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                          0.2369268850561891, 0.2369268850561891};
  const auto heading = [&](double u) {
    return start.heading_rad + u * (start.curvature_1_m + 0.5 * curvature_rate_1_m2 * u);
  };
  Path::Point end = start;
  end.heading_rad = heading(length_m);
  end.curvature_1_m += curvature_rate_1_m2 * length_m;
  const double turn = length_m * std::max(std::abs(start.curvature_1_m), std::abs(end.curvature_1_m));
  const int pieces = 1 + static_cast<int>(turn / 0.5);
  const double half = 0.5 * length_m / pieces;
  for (int piece = 0; piece < pieces; ++piece)
    for (std::size_t i = 0; i < kNode.size(); ++i) {
      const double h = heading(half * (2 * piece + 1 + kNode[i]));
      end.position_m += half * kWeight[i] * Eigen::Vector2d(std::cos(h), std::sin(h));
    }
  return end;
}

/// A turn from straight to straight: spiral, arc, spiral, each |turn| * radius / 2 long.
struct Turn {
  double turn_rad = 0;
  double part_m = 0;
  double curvature_1_m = 0;
  double tangent_m = 0;  ///< from either end of the curve to where the straights meet

  Turn(double turn, double radius) : turn_rad(turn) {
    if (std::abs(turn) < kStraight_rad) return;
    part_m = 0.5 * std::abs(turn) * radius;
    curvature_1_m = std::copysign(1 / radius, turn);
    Path::Point end = follow({}, curvature_1_m / part_m, part_m);
    end = follow(end, 0, part_m);
    end = follow(end, -curvature_1_m / part_m, part_m);
    tangent_m = end.position_m.x() / (1 + std::cos(turn));
  }
};

[[noreturn]] void refuse(std::size_t corner, const std::string& what) {
  throw std::invalid_argument("waypoint " + std::to_string(corner + 1) + ": " + what);
}

}  // namespace

void Path::append(double length_m, double curvature_1_m, double curvature_rate_1_m2) {
  if (length_m <= 0) return;
  Point start = elements_.back().start;
  if (elements_.back().length_m > 0)
    start = follow(start, elements_.back().curvature_rate_1_m2, elements_.back().length_m);
  start.curvature_1_m = curvature_1_m;
  elements_.push_back({length_m_, length_m, start, curvature_rate_1_m2});
  length_m_ += length_m;
}

Path::Path(const std::vector<Corner>& corners, bool closed) {
  const std::size_t n = corners.size();
  if (n < 2) throw std::invalid_argument("a path needs at least two waypoints");
  const std::size_t legs = closed ? n : n - 1;

  std::vector<double> heading(legs), leg_m(legs);
  for (std::size_t i = 0; i < legs; ++i) {
    const Eigen::Vector2d d = corners[(i + 1) % n].position_m - corners[i].position_m;
    leg_m[i] = d.norm();
    if (leg_m[i] < 1e-6) refuse((i + 1) % n, "lies on the one before");
    heading[i] = std::atan2(d.y(), d.x());
  }

  std::vector<Turn> turns(n, Turn(0, 0));
  for (std::size_t i = closed ? 0 : 1; i < legs; ++i) {
    const double turn = wrap_angle(heading[i] - heading[(i + legs - 1) % legs]);
    if (std::abs(turn) > kSharpest_rad) refuse(i, "turns back by more than 175 deg");
    if (std::abs(turn) > kStraight_rad && corners[i].radius_m <= 0)
      refuse(i, "is a corner and needs corner_radius_m > 0");
    turns[i] = Turn(turn, corners[i].radius_m);
  }
  for (std::size_t i = 0; i < legs; ++i)
    if (turns[i].tangent_m + turns[(i + 1) % n].tangent_m > leg_m[i] + 1e-9)
      refuse((i + 1) % n, "its curve and the one before need " +
                              std::to_string(turns[i].tangent_m + turns[(i + 1) % n].tangent_m) + " m, but are only " +
                              std::to_string(leg_m[i]) + " m apart: reduce corner_radius_m");

  const auto first_half = [this](const Turn& t) {
    append(t.part_m, 0, t.curvature_1_m / t.part_m);
    append(0.5 * t.part_m, t.curvature_1_m, 0);
  };
  const auto second_half = [this](const Turn& t) {
    append(0.5 * t.part_m, t.curvature_1_m, 0);
    append(t.part_m, t.curvature_1_m, -t.curvature_1_m / t.part_m);
  };

  Point start{corners[0].position_m, heading[0], 0};
  if (closed && turns[0].part_m > 0) {
    const double before = heading[0] - turns[0].turn_rad;
    start.position_m -= turns[0].tangent_m * Eigen::Vector2d(std::cos(before), std::sin(before));
    start.heading_rad = before;
    start = follow(start, turns[0].curvature_1_m / turns[0].part_m, turns[0].part_m);
    start = follow(start, 0, 0.5 * turns[0].part_m);
  }
  elements_.push_back({0, 0, start, 0});
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) first_half(turns[i]);
    stations_m_.push_back(length_m_);
    if (i > 0 || closed) second_half(turns[i]);
    if (i < legs) append(leg_m[i] - turns[i].tangent_m - turns[(i + 1) % n].tangent_m, 0, 0);
  }
  if (closed) first_half(turns[0]);
}

Path::Point Path::at(double along_m) const {
  const auto next = std::upper_bound(elements_.begin() + 1, elements_.end(), along_m,
                                     [](double s, const Element& element) { return s < element.begin_m; });
  const Element& element = *std::prev(next);
  return follow(element.start, element.curvature_rate_1_m2, along_m - element.begin_m);
}

}  // namespace lodestar::sim
