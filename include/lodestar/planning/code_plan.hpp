#pragma once

#include <optional>
#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/planning/code_book.hpp"
#include "lodestar/planning/view.hpp"

namespace lodestar {

struct CodePlanParams {
  CodeBookParams book;
  View view;
  std::optional<int> slot_count;  ///< empty: the site's own, or as many more as it takes
};

/// A site with its tone table, codes and slots, and how good they are.
struct CodePlan {
  Site site;
  CodeBook book;
  int codes_used = 0, slots_used = 0;
  double separation_m = 0;             ///< the largest that two beacons need to share a code or a slot
  std::optional<double> code_reuse_m;  ///< between the nearest two beacons of one code; empty: each has its own
  std::optional<double> slot_reuse_m;  ///< the same for slots
  Crowd crowd;                         ///< what one camera sees at most
  double view_radius_m = 0;            ///< of the beacon seen from farthest
  double code_capacity_per_m2 = 0;     ///< see capacity_per_m2
  double slot_capacity_per_m2 = 0;
};

/// The most beacons a square metre that `labels` codes (or slots) carry when each returns after `separation_m`: each
/// label's beacons in the densest packing there is, a triangular lattice.
double capacity_per_m2(int labels, double separation_m);

/// Gives each beacon of a survey a code and a slot that no other beacon within view of the same camera position has,
/// and none within kReuseDistance_m; of such plans one whose codes and slots return as far away as can be found.
/// @return why there is no plan, with value, limit and the way out, as one sentence without the file's name
Result<CodePlan, std::string> plan_codes(const Site& survey, const CodePlanParams& params);

}  // namespace lodestar
