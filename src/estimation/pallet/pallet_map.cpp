#include "lodestar/estimation/pallet/pallet_map.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kSameHeight_m = 0.1;  // less than the height of an empty pallet (EPAL: 0.144)
constexpr double kOverlap_m = 0.15;    // loads jut out, pallets lean: on each side, before two cannot both be there
constexpr double kPlaceless_m = 1.0;   // one sigma, from which on a pallet has no place
constexpr double kThinnest_m = 0.01;   // of a footprint that still says something

double horizontal_sigma_m(const Matrix6& covariance) { return std::sqrt(std::max(covariance(0, 0), covariance(1, 1))); }

Eigen::Vector2d middle(const RigidTransform& T_map_pallet) { return T_map_pallet.translation().head<2>(); }

bool is_here(const Pallet& pallet) {
  const bool standing = pallet.state == PalletState::kStanding || pallet.state == PalletState::kUncertain;
  return standing && has_place(pallet);
}

}  // namespace

bool has_place(const Pallet& pallet) { return horizontal_sigma_m(pallet.covariance) < kPlaceless_m; }

const PalletChange* PalletMap::find(const std::string& id) const {
  const auto found = latest_.find(id);
  return found == latest_.end() ? nullptr : &found->second;
}

const PalletChange* PalletMap::with_sscc(const std::string& sscc) const {
  for (const auto& [id, change] : latest_)
    if (change.pallet.sscc == sscc) return &change;
  return nullptr;
}

const PalletSize* PalletMap::find_size(const std::string& type) const {
  const auto found =
      std::find_if(sizes_.begin(), sizes_.end(), [&](const PalletSize& size) { return size.type == type; });
  return found == sizes_.end() ? nullptr : &*found;
}

const PalletSize& PalletMap::size(const std::string& type) const {
  const PalletSize* found = find_size(type);
  return found == nullptr ? sizes_.front() : *found;
}

std::vector<const Pallet*> PalletMap::standing() const {
  std::vector<const Pallet*> out;
  for (const auto& [id, change] : latest_)
    if (!carries(id) && is_here(change.pallet)) out.push_back(&change.pallet);
  return out;
}

FloorPolygon PalletMap::footprint(const PalletPose& pose, const std::string& type, double shrunk_m) const {
  const Eigen::Vector2d wanted = size(type).size_m.array() - 2 * shrunk_m;
  const Eigen::Vector2d shrunk = wanted.cwiseMax(kThinnest_m);
  return rectangle(middle(pose.T_map_pallet), roll_pitch_yaw(pose.T_map_pallet.linear()).yaw_rad, shrunk);
}

std::vector<const Pallet*> PalletMap::on_top_of(const PalletPose& pose, const std::string& type) const {
  const FloorPolygon ground = footprint(pose, type, 0);
  std::vector<const Pallet*> out;
  for (const Pallet* pallet : standing())
    if (pallet->T_map_pallet.translation().z() > pose.T_map_pallet.translation().z() + kSameHeight_m &&
        contains(ground, middle(pallet->T_map_pallet)))
      out.push_back(pallet);
  std::sort(out.begin(), out.end(), [](const Pallet* a, const Pallet* b) {
    return a->T_map_pallet.translation().z() < b->T_map_pallet.translation().z();
  });
  return out;
}

const Pallet* PalletMap::below(const PalletPose& pose) const {
  const Pallet* highest = nullptr;
  for (const Pallet* pallet : standing()) {
    const double z = pallet->T_map_pallet.translation().z();
    if (z > pose.T_map_pallet.translation().z() - kSameHeight_m) continue;
    if (!contains(footprint(pose_of(*pallet), pallet->type, 0), middle(pose.T_map_pallet))) continue;
    if (highest == nullptr || z > highest->T_map_pallet.translation().z()) highest = pallet;
  }
  return highest;
}

std::vector<const Pallet*> PalletMap::in_the_way(const PalletPose& pose, const std::string& type) const {
  std::vector<const Pallet*> out;
  for (const Pallet* pallet : standing()) {
    const Matrix6 both = pose.covariance + pallet->covariance;
    const double height_m = std::abs(pallet->T_map_pallet.translation().z() - pose.T_map_pallet.translation().z());
    if (height_m > kSameHeight_m + 3 * std::sqrt(both(2, 2))) continue;
    const FloorPolygon core = footprint(pose, type, kOverlap_m + 3 * horizontal_sigma_m(both));
    if (shared_area_m2(core, footprint(pose_of(*pallet), pallet->type, 0)) > 0) out.push_back(pallet);
  }
  return out;
}

}  // namespace lodestar
