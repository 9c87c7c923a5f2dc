#pragma once

#include <string>
#include <utility>

#include "lodestar/estimation/pallet/pallet_tracker.hpp"
#include "lodestar/ros/nodelets/memory_file.hpp"

namespace lodestar {

/// What a tracker knows, in a file that outlives the node: a PalletMemory as it goes over the wire, behind its
/// checksum.
class PalletFile {
 public:
  /// @param path empty: nothing is kept
  PalletFile(std::string path, std::string map_frame) : file_(std::move(path)), map_frame_(std::move(map_frame)) {}

  /// Hands what the file holds to the tracker.
  void load_into(PalletTracker& tracker);
  void save(const PalletTracker& tracker);

  /// What went wrong last; empty: nothing.
  const std::string& fault() const { return file_.fault(); }

 private:
  MemoryFile file_;
  std::string map_frame_;
};

}  // namespace lodestar
