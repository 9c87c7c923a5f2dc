#include "lodestar/base/site/zone.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

Eigen::Matrix2d turn(double yaw_rad) { return Eigen::Rotation2Dd(yaw_rad).toRotationMatrix(); }

/// Where pallets stand. @param level ignored where the zone has no rack
double height_m(const Zone& zone, std::size_t level) {
  return zone.levels_m.empty() ? zone.floor_m : zone.levels_m[level];
}

Place grid_place(const Zone& zone, int column, int row, std::size_t level) {
  const PlaceGrid& grid = *zone.grid;
  Place place;
  place.code = zone.code + '/' + std::to_string(column + 1) + '/' + std::to_string(row + 1);
  if (!zone.levels_m.empty()) place.code += '/' + std::to_string(level + 1);
  const Eigen::Vector2d steps = grid.pitch_m.cwiseProduct(Eigen::Vector2d(column, row));
  place.position_map << grid.first_m + turn(grid.yaw_rad) * steps, height_m(zone, level);
  place.yaw_rad = grid.yaw_rad;
  return place;
}

}  // namespace

const Zone* zone_at(const std::vector<Zone>& zones, const Eigen::Vector3d& position_map) {
  const auto found = std::find_if(zones.begin(), zones.end(), [&](const Zone& zone) {
    return position_map.z() >= zone.bottom_m && position_map.z() <= zone.top_m &&
           contains(zone.polygon_map, position_map.head<2>());
  });
  return found == zones.end() ? nullptr : &*found;
}

const Zone* find_zone(const std::vector<Zone>& zones, const std::string& code) {
  const auto found = std::find_if(zones.begin(), zones.end(), [&](const Zone& zone) { return zone.code == code; });
  return found == zones.end() ? nullptr : &*found;
}

int nearest_level(const Zone& zone, double height_m) {
  const auto nearest = std::min_element(zone.levels_m.begin(), zone.levels_m.end(), [&](double a, double b) {
    return std::abs(a - height_m) < std::abs(b - height_m);
  });
  return static_cast<int>(nearest - zone.levels_m.begin());
}

std::vector<Place> grid_places(const Zone& zone) {
  std::vector<Place> places;
  if (!zone.grid) return places;
  const std::size_t levels = std::max<std::size_t>(zone.levels_m.size(), 1);
  for (int column = 0; column < zone.grid->columns; ++column)
    for (int row = 0; row < zone.grid->rows; ++row)
      for (std::size_t level = 0; level < levels; ++level) places.push_back(grid_place(zone, column, row, level));
  return places;
}

std::vector<Place> packed_places(const Zone& zone, const Eigen::Vector2d& size_m, double gap_m) {
  const Eigen::Vector2d side = zone.polygon_map.at(1) - zone.polygon_map.at(0);
  const double yaw_rad = std::atan2(side.y(), side.x());
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (const Eigen::Vector2d& corner : zone.polygon_map) {
    const Eigen::Array2d along = turn(-yaw_rad) * (corner - zone.polygon_map[0]);
    low = low.min(along);
    high = high.max(along);
  }
  std::vector<Place> places;
  for (double x = low.x(); x + size_m.x() <= high.x(); x += size_m.x() + gap_m) {
    for (double y = low.y(); y + size_m.y() <= high.y(); y += size_m.y() + gap_m) {
      const Eigen::Vector2d centre = zone.polygon_map[0] + turn(yaw_rad) * (Eigen::Vector2d(x, y) + 0.5 * size_m);
      // A millimetre less: what lies along the edge is inside, whatever rounding says.
      const Eigen::Vector2d nearly = size_m.array() - 1e-3;
      if (contains(zone.polygon_map, rectangle(centre, yaw_rad, nearly)))
        places.push_back({zone.code, {centre.x(), centre.y(), height_m(zone, 0)}, yaw_rad});
    }
  }
  return places;
}

std::string storage_code(const std::vector<Zone>& zones, const Eigen::Vector3d& position_map) {
  const Zone* zone = zone_at(zones, position_map);
  if (zone == nullptr) return "";
  if (!zone->grid) return zone->code;
  const PlaceGrid& grid = *zone->grid;
  const Eigen::Vector2d offset = turn(-grid.yaw_rad) * (position_map.head<2>() - grid.first_m);
  const Eigen::Array2d steps = (offset.array() / grid.pitch_m.array()).round();
  if (steps.x() < 0 || steps.x() >= grid.columns || steps.y() < 0 || steps.y() >= grid.rows) return zone->code;
  const int level = nearest_level(*zone, position_map.z());
  return grid_place(*zone, static_cast<int>(steps.x()), static_cast<int>(steps.y()), static_cast<std::size_t>(level))
      .code;
}

std::optional<Place> find_place(const std::vector<Zone>& zones, const std::string& code) {
  const Zone* zone = find_zone(zones, code.substr(0, code.find('/')));
  if (zone == nullptr) return std::nullopt;
  for (const Place& place : grid_places(*zone))
    if (place.code == code) return place;
  return std::nullopt;
}

}  // namespace lodestar
