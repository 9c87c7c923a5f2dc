#include "lodestar/ros/nodelets/markers.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/ros/convert/transform.hpp"
#include "marker_parts.hpp"

namespace lodestar {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kMargin_m = 4.0;  // of the floor beyond the outermost beacons
constexpr double kThickEach_m = 5.0;

Eigen::AlignedBox2d floor_bounds(const std::map<BeaconId, BeaconTable::Entry>& beacons) {
  Eigen::AlignedBox2d bounds;
  for (const auto& [id, entry] : beacons) bounds.extend(entry.beacon.position_map.head<2>().eval());
  if (bounds.isEmpty()) bounds.extend(Eigen::Vector2d::Zero());
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kMargin_m);
  return {(bounds.min() - margin).array().floor().matrix(), (bounds.max() + margin).array().ceil().matrix()};
}

/// `lines` with a line from the camera to each of the beacons.
Marker lines_to(Marker lines, const Eigen::Vector3d& camera_map, const std::map<BeaconId, BeaconTable::Entry>& beacons,
                const std::set<BeaconId>& ids) {
  lines.scale.x = 0.04;
  for (const BeaconId id : ids) {
    const auto found = beacons.find(id);
    if (found == beacons.end()) continue;
    lines.points.push_back(point(camera_map));
    lines.points.push_back(point(found->second.beacon.position_map));
  }
  if (lines.points.empty()) lines.action = Marker::DELETE;
  return lines;
}

bool is_thick(double coordinate_m) { return std::abs(std::remainder(coordinate_m, kThickEach_m)) < 0.1; }

}  // namespace

MarkerArray floor_markers(const std_msgs::Header& header, const std::map<BeaconId, BeaconTable::Entry>& beacons) {
  const Eigen::AlignedBox2d bounds = floor_bounds(beacons);
  const Eigen::Vector2d low = bounds.min(), high = bounds.max();
  Marker floor = marker(header, "floor", 0, Marker::CUBE, color(0.16, 0.18, 0.21));
  floor.pose.position.x = bounds.center().x();
  floor.pose.position.y = bounds.center().y();
  floor.pose.position.z = -0.03;
  set_scale(floor, bounds.sizes().x(), bounds.sizes().y(), 0.02);
  Marker thin = marker(header, "floor", 1, Marker::LINE_LIST, color(0.30, 0.33, 0.38));
  Marker thick = marker(header, "floor", 2, Marker::LINE_LIST, color(0.45, 0.50, 0.57));
  thin.scale.x = 0.015;
  thick.scale.x = 0.04;
  const auto line = [&](Marker& m, double x0, double y0, double x1, double y1) {
    m.points.push_back(point({x0, y0, 0}));
    m.points.push_back(point({x1, y1, 0}));
  };
  for (double x = low.x(); x <= high.x(); x += 1) line(is_thick(x) ? thick : thin, x, low.y(), x, high.y());
  for (double y = low.y(); y <= high.y(); y += 1) line(is_thick(y) ? thick : thin, low.x(), y, high.x(), y);
  MarkerArray out;
  for (Marker& m : std::vector<Marker>{floor, thin, thick})
    if (m.type == Marker::CUBE || !m.points.empty()) out.markers.push_back(m);
  return out;
}

MarkerArray beacon_markers(const std_msgs::Header& header, const std::map<BeaconId, BeaconTable::Entry>& beacons,
                           const std::set<BeaconId>& in_use) {
  MarkerArray out;
  for (const auto& [id, entry] : beacons) {
    const int number = static_cast<int>(id.value);
    const Eigen::Vector3d& p = entry.beacon.position_map;
    const auto light = !entry.in_force()      ? color(0.95, 0.15, 0.15)
                       : in_use.count(id) > 0 ? color(0.25, 1.00, 0.55)
                                              : color(0.75, 0.72, 0.55, 0.85);
    Marker lamp = marker(header, "beacons", number, Marker::CYLINDER, light);
    lamp.pose.position = point(p);
    set_scale(lamp, 0.45, 0.45, 0.12);
    Marker name = marker(header, "beacon ids", number, Marker::TEXT_VIEW_FACING, color(1, 1, 1));
    name.pose.position = point(p + Eigen::Vector3d(0, 0, 0.55));
    name.scale.z = 0.7;
    name.text = std::to_string(id.value);
    Marker stem = marker(header, "beacon stems", number, Marker::LINE_LIST, color(1, 1, 1, 0.2));
    stem.scale.x = 0.02;
    stem.points = {point(p), point({p.x(), p.y(), 0})};
    out.markers.insert(out.markers.end(), {lamp, name, stem});
  }
  return out;
}

Marker bearing_marker(const std_msgs::Header& header, const Eigen::Vector3d& camera_map,
                      const std::map<BeaconId, BeaconTable::Entry>& beacons, const std::set<BeaconId>& in_use) {
  return lines_to(marker(header, "bearings", 0, Marker::LINE_LIST, color(0.25, 1.0, 0.55, 0.8)), camera_map, beacons,
                  in_use);
}

Marker refused_marker(const std_msgs::Header& header, const Eigen::Vector3d& camera_map,
                      const std::map<BeaconId, BeaconTable::Entry>& beacons, const std::set<BeaconId>& refused) {
  return lines_to(marker(header, "refused bearings", 0, Marker::LINE_LIST, color(1.0, 0.2, 0.15, 0.9)), camera_map,
                  beacons, refused);
}

Marker protection_marker(const std_msgs::Header& header, const Eigen::Vector3d& base_map, double protection_level_m) {
  constexpr int kCorners = 48;
  Marker circle = marker(header, "protection level", 0, Marker::LINE_STRIP, color(1.0, 0.75, 0.2, 0.9));
  circle.scale.x = 0.05;
  const double radius = kCovarianceScale * protection_level_m;
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2 * kPi * i / kCorners;
    circle.points.push_back(
        point({base_map.x() + radius * std::cos(angle), base_map.y() + radius * std::sin(angle), 0.03}));
  }
  return circle;
}

Marker covariance_marker(const std_msgs::Header& header, const PoseEstimate& pose) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(pose.covariance.topLeftCorner<2, 2>());
  const Eigen::Vector2d diameters = 2 * 3 * kCovarianceScale * axes.eigenvalues().cwiseMax(0).cwiseSqrt();
  const Eigen::Vector2d longest = axes.eigenvectors().col(1);
  Marker ellipse = marker(header, "covariance", 0, Marker::CYLINDER, color(1.0, 0.35, 0.75, 0.6));
  RigidTransform T_map_ellipse = RigidTransform::Identity();
  T_map_ellipse.translation() << pose.T_map_base.translation().head<2>(), 0.02;
  T_map_ellipse.linear() = rotation({0, 0, std::atan2(longest.y(), longest.x())});
  ellipse.pose = pose_message(T_map_ellipse);
  set_scale(ellipse, std::max(diameters(1), 1e-3), std::max(diameters(0), 1e-3), 0.01);
  return ellipse;
}

MarkerArray truck_markers(const std_msgs::Header& header, const RigidTransform& T_map_base) {
  struct Part {
    Eigen::Vector3d centre, size;
    std_msgs::ColorRGBA paint;
  };
  const auto paint = color(0.95, 0.55, 0.08), steel = color(0.20, 0.20, 0.22), fork = color(0.55, 0.56, 0.58);
  std::vector<Part> parts = {
      {{-0.05, 0, 0.55}, {1.5, 1.1, 0.6}, paint}, {{-0.75, 0, 0.65}, {0.5, 1.15, 0.8}, steel},
      {{0.0, 0, 2.1}, {1.2, 1.0, 0.06}, steel},   {{0.85, 0, 0.4}, {0.08, 0.9, 0.5}, fork},
      {{0.80, 0, 2.2}, {0.12, 0.8, 0.10}, steel},
  };
  for (const double side : {-1.0, 1.0}) {
    parts.push_back({{0.80, side * 0.36, 1.15}, {0.14, 0.10, 2.2}, steel});
    parts.push_back({{1.45, side * 0.28, 0.08}, {1.15, 0.12, 0.05}, fork});
    parts.push_back({{0.50, side * 0.45, 1.45}, {0.06, 0.06, 1.3}, steel});
    parts.push_back({{-0.55, side * 0.45, 1.45}, {0.06, 0.06, 1.3}, steel});
    parts.push_back({{0.55, side * 0.52, 0.25}, {0.5, 0.2, 0.5}, steel});
    parts.push_back({{-0.60, side * 0.50, 0.22}, {0.44, 0.2, 0.44}, steel});
  }
  MarkerArray out;
  for (const Part& part : parts) {
    Marker m = marker(header, "truck", static_cast<int>(out.markers.size()), Marker::CUBE, part.paint);
    m.pose = pose_message(T_map_base * Eigen::Translation3d(part.centre));
    set_scale(m, part.size.x(), part.size.y(), part.size.z());
    out.markers.push_back(m);
  }
  return out;
}

}  // namespace lodestar
