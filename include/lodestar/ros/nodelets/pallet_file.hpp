#pragma once

#include <string>

#include "lodestar/estimation/pallet/pallet_tracker.hpp"

namespace lodestar {

/// What a tracker knows, in a file that outlives the node: a PalletMemory as it goes over the wire, behind its
/// checksum.
class PalletFile {
 public:
  /// @param path empty: nothing is kept
  PalletFile(std::string path, std::string map_frame) : path_(std::move(path)), map_frame_(std::move(map_frame)) {}

  /// Hands what the file holds to the tracker. No file is no fault; one that cannot be understood is set aside as
  /// `<path>.broken`.
  void load_into(PalletTracker& tracker);
  void save(const PalletTracker& tracker);

  /// What went wrong last; empty: nothing.
  const std::string& fault() const { return fault_; }

 private:
  std::string path_, map_frame_, fault_;
};

}  // namespace lodestar
