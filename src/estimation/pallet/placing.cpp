#include "lodestar/estimation/pallet/placing.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/measurement/pose_limits.hpp"

namespace lodestar {
namespace {

constexpr double kFloor_m = 0.1;       // what stands lower stands on the floor
constexpr double kGap_m = 0.1;         // between pallets where a zone has no grid
constexpr double kTouching_m2 = 0.01;  // of two pallets side by side, by the errors of their poses

}  // namespace

bool put(Pallet& pallet, const PalletPose& pose, const std::vector<Zone>& zones, const PalletMap& map) {
  if (!is_possible(pose.T_map_pallet, pose.covariance)) return false;
  pallet.T_map_pallet = pose.T_map_pallet;
  pallet.covariance = pose.covariance;
  const Eigen::Vector3d position = pose.T_map_pallet.translation();
  const Zone* zone = zone_at(zones, position);
  pallet.zone = zone == nullptr ? "" : zone->code;
  if (zone != nullptr && !zone->levels_m.empty()) {
    pallet.level = nearest_level(*zone, position.z());
  } else if (const Pallet* below = map.below(pose)) {
    pallet.level = below->level + 1;
  } else {
    const double floor_m = zone == nullptr ? 0.0 : zone->floor_m;
    pallet.level = position.z() > floor_m + kFloor_m + 3 * std::sqrt(pose.covariance(2, 2)) ? 1 : 0;
  }
  return true;
}

bool lies_in_dock(const Pallet& pallet, const std::vector<Zone>& zones) {
  const Zone* zone = find_zone(zones, pallet.zone);
  return zone != nullptr && zone->kind == ZoneKind::kDock;
}

void put_anywhere(Pallet& pallet) {
  pallet.covariance = kUnknownSigma * kUnknownSigma * Matrix6::Identity();
  pallet.zone.clear();
  pallet.level = 0;
}

std::vector<Place> free_places(const Zone& zone, const PalletSize& size, const PalletMap& map) {
  std::vector<Place> places = zone.grid ? grid_places(zone) : packed_places(zone, size.size_m, kGap_m);
  const auto taken = [&](const Place& place) {
    const FloorPolygon wanted = rectangle(place.position_map.head<2>(), place.yaw_rad, size.size_m);
    for (const Pallet* pallet : map.standing()) {
      const Eigen::Vector3d position = pallet->T_map_pallet.translation();
      if (position.z() < zone.bottom_m - kFloor_m || position.z() > zone.top_m) continue;
      if (nearest_level(zone, position.z()) != nearest_level(zone, place.position_map.z())) continue;
      const FloorPolygon standing = rectangle(position.head<2>(), roll_pitch_yaw(pallet->T_map_pallet.linear()).yaw_rad,
                                              map.size(pallet->type).size_m);
      if (shared_area_m2(wanted, standing) > kTouching_m2) return true;
    }
    return false;
  };
  places.erase(std::remove_if(places.begin(), places.end(), taken), places.end());
  return places;
}

}  // namespace lodestar
