#pragma once

#include <set>
#include <string>
#include <utility>

#include "lodestar/base/site/site.hpp"

namespace lodestar {

/// The file that keeps which beacons are left out until somebody confirms them, over a restart of the node.
class DistrustMemory {
 public:
  /// @param path of the file; empty: none
  explicit DistrustMemory(std::string path) : path_(std::move(path)) {}

  /// No file is no fault; one that cannot be understood is set aside as `<path>.broken`.
  std::set<BeaconId> load();
  void save(const std::set<BeaconId>& distrusted);

  /// What went wrong last with the file; empty: nothing.
  const std::string& fault() const { return fault_; }

 private:
  std::string path_, fault_;
};

}  // namespace lodestar
