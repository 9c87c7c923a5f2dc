#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "lodestar/base/geometry/floor_polygon.hpp"
#include "lodestar/base/measurement/pallet.hpp"
#include "lodestar/base/site/pallet_size.hpp"
#include "lodestar/estimation/pallet/fork.hpp"

namespace lodestar {

/// Whether it is known to a metre (one sigma) where the pallet is; else it may be anywhere.
bool has_place(const Pallet& pallet);

/// All pallets that are known, by id: the last change of each, which holds the pallet as it is.
class PalletMap {
 public:
  /// @param sizes one at least; a type that none has counts as the first
  explicit PalletMap(std::vector<PalletSize> sizes) : sizes_(std::move(sizes)) {}

  void set(const PalletChange& change) { latest_[change.pallet.id] = change; }
  void erase(const std::string& id) { latest_.erase(id); }
  /// What the fork carries, whatever state it is told in.
  void set_carried(const std::set<std::string>& ids) { carried_ = ids; }
  bool carries(const std::string& id) const { return carried_.count(id) > 0; }
  /// Null when there is none.
  const PalletChange* find(const std::string& id) const;
  const PalletChange* with_sscc(const std::string& sscc) const;
  const std::map<std::string, PalletChange>& all() const { return latest_; }

  const PalletSize& size(const std::string& type) const;
  const PalletSize* find_size(const std::string& type) const;

  /// Standing pallets, uncertain ones among them, that have a place. On the fork or gone: not here.
  std::vector<const Pallet*> standing() const;

  /// Those that stand with their middle over this pallet and higher, from the lowest up.
  std::vector<const Pallet*> on_top_of(const PalletPose& pose, const std::string& type) const;
  /// The highest that stands below the middle of a pallet here, or null.
  const Pallet* below(const PalletPose& pose) const;
  /// Those at the same height whose ground it would need: overlapping by more than their poses' errors explain.
  std::vector<const Pallet*> in_the_way(const PalletPose& pose, const std::string& type) const;

 private:
  FloorPolygon footprint(const PalletPose& pose, const std::string& type, double shrunk_m) const;

  std::vector<PalletSize> sizes_;
  std::map<std::string, PalletChange> latest_;
  std::set<std::string> carried_;
};

}  // namespace lodestar
