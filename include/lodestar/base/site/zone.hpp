#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/geometry/floor_polygon.hpp"

namespace lodestar {

enum class ZoneKind {
  kStorage,
  kDock,  ///< pallets that are set down here leave the site
};

/// Places in rows and columns, as painted on the floor or built as racks.
struct PlaceGrid {
  Eigen::Vector2d first_m = Eigen::Vector2d::Zero();  ///< in map, the middle of the place in column 1, row 1
  double yaw_rad = 0;                                 ///< in map, which way columns are counted; pallets lie along it
  Eigen::Vector2d pitch_m = Eigen::Vector2d::Zero();  ///< from column to column, from row to row
  int columns = 1, rows = 1;
};

/// A part of the site with a storage code, as the site file has it.
struct Zone {
  std::string code;
  ZoneKind kind = ZoneKind::kStorage;
  FloorPolygon polygon_map;               ///< m
  double bottom_m = -1.0, top_m = 100.0;  ///< of map's z; both belong to it
  std::vector<double> levels_m;           ///< z of the rack's levels, ascending; empty: no rack
  double floor_m = 0.0;                   ///< z of what pallets stand on where there is no rack
  std::optional<PlaceGrid> grid;          ///< empty: the zone has no places of its own
  std::string pallet_type;                ///< of a pallet that nobody has met before; empty: the vehicle file's first
};

/// Where one pallet goes.
struct Place {
  std::string code;                                        ///< `<zone>/<column>/<row>` and `/<level>` in a rack, from 1
  Eigen::Vector3d position_map = Eigen::Vector3d::Zero();  ///< m, of the middle of the pallet's underside
  double yaw_rad = 0;
};

/// The zone that the point lies in, or null.
const Zone* zone_at(const std::vector<Zone>& zones, const Eigen::Vector3d& position_map);
/// The zone of this code, or null.
const Zone* find_zone(const std::vector<Zone>& zones, const std::string& code);

/// Index of the level nearest to a height; 0 where the zone has no rack.
int nearest_level(const Zone& zone, double height_m);

/// The places of the grid, column by column, level by level; none without a grid.
std::vector<Place> grid_places(const Zone& zone);
/// What fits into the zone at its bottom level: rows along the polygon's first side, `gap_m` apart. All have the zone's
/// code.
std::vector<Place> packed_places(const Zone& zone, const Eigen::Vector2d& size_m, double gap_m);

/// The storage code of a point: of the place where its zone has a grid and it lies within half a pitch of one, else of
/// the zone; empty in no zone.
std::string storage_code(const std::vector<Zone>& zones, const Eigen::Vector3d& position_map);
/// And back: the place of a code; empty where no grid has it.
std::optional<Place> find_place(const std::vector<Zone>& zones, const std::string& code);

}  // namespace lodestar
