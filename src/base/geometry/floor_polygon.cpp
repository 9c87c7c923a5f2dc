#include "lodestar/base/geometry/floor_polygon.hpp"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>

namespace lodestar {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point>;

Polygon closed(const FloorPolygon& corners) {
  Polygon polygon;
  for (const Eigen::Vector2d& corner : corners) bg::append(polygon.outer(), Point(corner.x(), corner.y()));
  bg::correct(polygon);
  return polygon;
}

}  // namespace

FloorPolygon rectangle(const Eigen::Vector2d& centre_m, double yaw_rad, const Eigen::Vector2d& size_m) {
  const Eigen::Vector2d along = 0.5 * size_m.x() * Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
  const Eigen::Vector2d across = 0.5 * size_m.y() * Eigen::Vector2d(-std::sin(yaw_rad), std::cos(yaw_rad));
  return {centre_m - along - across, centre_m + along - across, centre_m + along + across, centre_m - along + across};
}

bool is_simple(const FloorPolygon& polygon) {
  return polygon.size() >= 3 && bg::is_valid(closed(polygon)) && bg::area(closed(polygon)) > 0;
}

bool contains(const FloorPolygon& polygon, const Eigen::Vector2d& point_m) {
  return bg::covered_by(Point(point_m.x(), point_m.y()), closed(polygon));
}

bool contains(const FloorPolygon& outer, const FloorPolygon& inner) {
  return bg::covered_by(closed(inner), closed(outer));
}

double shared_area_m2(const FloorPolygon& a, const FloorPolygon& b) {
  bg::model::multi_polygon<Polygon> shared;
  bg::intersection(closed(a), closed(b), shared);
  return bg::area(shared);
}

}  // namespace lodestar
