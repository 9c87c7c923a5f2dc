#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lodestar/base/site/site.hpp"
#include "lodestar/base/yaml/fault_log.hpp"

namespace lodestar {

/// A beacon as far as its entry could be read, with the lines that its faults are reported at.
struct BeaconDraft {
  std::optional<BeaconId> id;
  std::optional<Eigen::Vector3d> position_map;
  std::optional<ToneSet> tones;
  std::optional<int> slot;
  Waveform waveform = Waveform::kSine;
  double sigma_m = 0.01;
  int line = 0, id_line = 0, tones_line = 0, slot_line = 0;
};

/// What no beacon can get wrong by itself: an id that is taken, a code or a slot shared within kReuseDistance_m.
/// Drafts take part with what was readable of them.
void check_clashes(const std::vector<BeaconDraft>& drafts, FaultLog& faults);

}  // namespace lodestar
