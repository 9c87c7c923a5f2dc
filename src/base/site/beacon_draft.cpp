#include "beacon_draft.hpp"

#include <cmath>
#include <map>
#include <string>

#include "lodestar/base/yaml/yaml_scalar.hpp"

namespace lodestar {

namespace {

std::string title(const BeaconDraft& draft) {
  const std::string id = draft.id ? "beacon " + std::to_string(draft.id->value) : "the beacon";
  return id + " on line " + std::to_string(draft.line);
}

std::string distance_text(double distance_m) { return print(std::round(distance_m * 100) / 100) + " m away"; }

void check_pair(const BeaconDraft& first, const BeaconDraft& second, FaultLog& faults) {
  if (!first.position_map || !second.position_map) return;
  const double distance_m = (*first.position_map - *second.position_map).norm();
  if (distance_m > kReuseDistance_m) return;
  const std::string other = title(first) + ", " + distance_text(distance_m) + ": within " + print(kReuseDistance_m) +
                            " m give each beacon its own";
  if (first.tones && first.tones == second.tones)
    faults.add(second.tones_line, "the code (tones_hz) is also that of " + other);
  if (first.slot && first.slot == second.slot)
    faults.add(second.slot_line, "slot " + std::to_string(*second.slot) + " is also that of " + other);
}

}  // namespace

void check_clashes(const std::vector<BeaconDraft>& drafts, FaultLog& faults) {
  std::map<BeaconId, int> first_lines;
  for (const BeaconDraft& draft : drafts) {
    if (!draft.id) continue;
    const auto [it, is_new] = first_lines.emplace(*draft.id, draft.line);
    if (!is_new)
      faults.add(draft.id_line, "id " + std::to_string(draft.id->value) + " is taken by the beacon on line " +
                                    std::to_string(it->second) + ": give each beacon its own");
  }
  for (std::size_t i = 0; i < drafts.size(); ++i)
    for (std::size_t j = i + 1; j < drafts.size(); ++j) check_pair(drafts[i], drafts[j], faults);
}

}  // namespace lodestar
