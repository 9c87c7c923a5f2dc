#pragma once

#include <Eigen/Core>
#include <vector>

namespace lodestar::sim {

/// A line on the floor whose curvature is continuous: straights joined by spiral, arc, spiral.
class Path {
 public:
  struct Corner {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< where the straights would meet
    double radius_m = 0;                                   ///< of the arc; the spirals take half of the turn
  };
  struct Point {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
    double heading_rad = 0;
    double curvature_1_m = 0;  ///< positive to the left
  };

  /// Through all corners; closed: back to the first as well. Throws std::invalid_argument when a turn has no radius or
  /// the curves of two corners overlap.
  Path(const std::vector<Corner>& corners, bool closed);

  double length_m() const { return length_m_; }
  /// Where corner i is passed: the middle of its curve, m along the path.
  double station_m(std::size_t corner) const { return stations_m_[corner]; }
  /// @param along_m in [0, length]
  Point at(double along_m) const;

 private:
  struct Element {
    double begin_m, length_m;
    Point start;
    double curvature_rate_1_m2;
  };
  void append(double length_m, double curvature_1_m, double curvature_rate_1_m2);

  std::vector<Element> elements_;
  std::vector<double> stations_m_;
  double length_m_ = 0;
};

}  // namespace lodestar::sim
