#include "lodestar/planning/code_plan.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <utility>

#include "lodestar/planning/lattice.hpp"

namespace lodestar {

namespace {

constexpr int kMostSlots = 256;
constexpr int kMoves = 20000, kStretchMoves = 2000;  // of the search for a colouring
constexpr double kMostStretch = 4, kStretchStep = 0.05;

/// The beacons with what a camera sees of them, or why a beacon cannot be seen.
Result<std::vector<Lit>, std::string> light_up(const std::vector<Beacon>& beacons, const View& view) {
  std::vector<Lit> lit;
  for (const Beacon& beacon : beacons) {
    const double radius_m = view_radius_m(view, beacon.position_map.z());
    if (radius_m <= 0) {
      std::ostringstream why;
      why << "beacon " << beacon.id << " hangs at " << beacon.position_map.z() << " m, it must hang above the camera ("
          << view.camera_height_m << " m) and at most the range of " << view.range_m
          << " m higher: mend its position, or give --camera-height and --range.";
      return why.str();
    }
    lit.push_back({beacon.position_map, radius_m});
  }
  return lit;
}

/// The better of a lattice and a search; `enough` colours end it.
Colouring few_colours(const std::vector<Lit>& lit, double stretch, int enough, int moves) {
  const ConflictGraph graph = conflicts(lit, stretch);
  const auto lattice = lattice_colouring(lit, graph, enough);
  if (lattice) return *lattice;
  Colouring searched = colour(graph, enough, moves);
  const auto smaller = lattice_colouring(lit, graph, searched.count - 1);
  return smaller ? *smaller : searched;
}

/// Whether some beacons around one of them are all in conflict with one another and more than `labels`.
bool too_crowded(const std::vector<Lit>& lit, double stretch, int labels) {
  const ConflictGraph half = conflicts(lit, stretch / 2);
  return std::any_of(half.begin(), half.end(),
                     [&](const auto& near) { return static_cast<int>(near.size()) >= labels; });
}

/// Labels that return as far away as a search finds, at most `labels` of them.
/// @param least a colouring with at most that many
Colouring spread(const std::vector<Lit>& lit, int labels, Colouring least) {
  if (static_cast<int>(lit.size()) <= labels) {
    std::iota(least.colours.begin(), least.colours.end(), 0);
    least.count = static_cast<int>(lit.size());
    return least;
  }
  double works = 1, fails = kMostStretch;
  while (fails - works > kStretchStep) {
    const double stretch = 0.5 * (works + fails);
    if (too_crowded(lit, stretch, labels)) {
      fails = stretch;
      continue;
    }
    Colouring wider = few_colours(lit, stretch, labels, kStretchMoves);
    if (wider.count <= labels) {
      works = stretch;
      least = std::move(wider);
    } else {
      fails = stretch;
    }
  }
  return least;
}

std::optional<double> nearest_alike_m(const std::vector<Lit>& lit, const std::vector<int>& labels) {
  std::optional<double> nearest_m;
  for (std::size_t i = 0; i < lit.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (labels[i] != labels[j]) continue;
      const double distance_m = (lit[i].position_map - lit[j].position_map).norm();
      nearest_m = std::min(nearest_m.value_or(distance_m), distance_m);
    }
  return nearest_m;
}

/// What the crowd and the colouring ask for, as the start of a sentence.
std::string demand(const Colouring& least, const Crowd& crowd, const char* what) {
  std::ostringstream out;
  out << std::setprecision(4) << "the beacons need " << least.count << " " << what << " (a camera at x "
      << crowd.camera_map.x() << " m, y " << crowd.camera_map.y() << " m sees " << crowd.beacons << " at once), ";
  return out.str();
}

/// Command lines with which the codes would do.
std::string ways_out(const CodeBookParams& params, int wanted) {
  std::string out;
  const auto try_with = [&](const CodeBookParams& other, const std::string& option) {
    const std::size_t codes = make_code_book(other, wanted).codes.size();
    const bool does = codes >= static_cast<std::size_t>(wanted);
    if (does) out += "use " + option + " (" + std::to_string(codes) + " codes), or ";
    return does;
  };
  CodeBookParams sine = params;
  sine.waveform = Waveform::kSine;
  sine.tones_per_code = CodeBookParams{}.tones_per_code;
  if (params.waveform == Waveform::kSquare) try_with(sine, "--waveform sine");
  for (int times = 2; times <= 4; ++times) {
    CodeBookParams longer = params;
    longer.window_frames *= times;
    if (try_with(longer, "--window " + std::to_string(longer.window_frames))) break;
  }
  return out;
}

std::string too_few_codes(const CodeBookParams& params, const CodeBook& book, const Colouring& least,
                          const Crowd& crowd) {
  std::ostringstream why;
  why << demand(least, crowd, "codes") << "but " << params.rate_hz << " frames/s, a window of " << params.window_frames
      << " and " << params.mains_hz << " Hz mains leave " << book.tone_table_hz.size() << " tones and "
      << book.codes.size() << " codes: " << ways_out(params, least.count)
      << "hang the beacons wider apart, or raise --camera-height or lower --range as far as is true.";
  return why.str();
}

Result<int, std::string> choose_slot_count(const Site& survey, const CodePlanParams& params, const Colouring& least,
                                           const Crowd& crowd) {
  const int most = params.slot_count.value_or(kMostSlots);
  if (least.count > most)
    return demand(least, crowd, "slots") + "but the limit is " + std::to_string(most) + ": " +
           (least.count <= kMostSlots ? "use --slots " + std::to_string(least.count) + ", or " : "") +
           "hang the beacons wider apart.";
  return params.slot_count.value_or(std::max(survey.link.slot_count, least.count));
}

Site label(const Site& survey, const CodePlanParams& params, const CodeBook& book, const Colouring& codes,
           const Colouring& slots) {
  Site site = survey;
  site.tone_table_hz = book.tone_table_hz;
  for (std::size_t i = 0; i < site.beacons.size(); ++i) {
    Beacon& beacon = site.beacons[i];
    beacon.tones = book.codes[static_cast<std::size_t>(codes.colours[i])];
    beacon.slot = slots.colours[i];
    beacon.waveform = params.book.waveform;
  }
  return site;
}

}  // namespace

double capacity_per_m2(int labels, double separation_m) {
  return labels * 2 / (std::sqrt(3.0) * separation_m * separation_m);
}

Result<CodePlan, std::string> plan_codes(const Site& survey, const CodePlanParams& params) {
  if (survey.beacons.empty()) return std::string("there is no beacon: list at least one under `beacons`.");
  const auto lit = light_up(survey.beacons, params.view);
  if (!lit) return lit.error();

  CodePlan plan;
  plan.crowd = most_in_view(*lit);
  if (plan.crowd.beacons > kMostSlots)
    return choose_slot_count(survey, params, {{}, plan.crowd.beacons}, plan.crowd).error();
  const Colouring least = few_colours(*lit, 1, plan.crowd.beacons, kMoves);
  plan.book = make_code_book(params.book, least.count);
  const int code_count = static_cast<int>(plan.book.codes.size());
  if (code_count < least.count) return too_few_codes(params.book, plan.book, least, plan.crowd);
  const auto slot_count = choose_slot_count(survey, params, least, plan.crowd);
  if (!slot_count) return slot_count.error();

  const Colouring codes = spread(*lit, code_count, least), slots = spread(*lit, *slot_count, least);
  plan.site = label(survey, params, plan.book, codes, slots);
  plan.site.link.slot_count = *slot_count;
  plan.codes_used = codes.count;
  plan.slots_used = slots.count;
  plan.code_reuse_m = nearest_alike_m(*lit, codes.colours);
  plan.slot_reuse_m = nearest_alike_m(*lit, slots.colours);
  for (const Lit& beacon : *lit) plan.view_radius_m = std::max(plan.view_radius_m, beacon.radius_m);
  plan.separation_m = std::max(2 * plan.view_radius_m, kReuseDistance_m);
  plan.code_capacity_per_m2 = capacity_per_m2(code_count, plan.separation_m);
  plan.slot_capacity_per_m2 = capacity_per_m2(*slot_count, plan.separation_m);
  return plan;
}

}  // namespace lodestar
