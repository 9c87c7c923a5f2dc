#include "zone_section.hpp"

#include <algorithm>
#include <string>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

const std::vector<YamlKey> kZoneKeys = {{"code", true},    {"kind", true},      {"polygon_m", true},
                                        {"z_m", false},    {"levels_m", false}, {"floor_m", false},
                                        {"places", false}, {"pallet", false}};
const std::vector<YamlKey> kPlaceKeys = {
    {"first_m", true}, {"pitch_m", true}, {"columns", true}, {"rows", true}, {"yaw_deg", false}};
const Limits kCoordinate = within(-10000, 10000);
constexpr std::size_t kMostCorners = 1000, kMostLevels = 100;
constexpr std::size_t kLongestCode = 32;
constexpr int kMostInLine = 200;       // places; a larger hall is more than one zone
constexpr double kTouching_m2 = 1e-6;  ///< of two zones with a side in common, after rounding

/// A zone with the line that it stands on.
struct ZoneDraft {
  Zone zone;
  int line = 0;
};

/// What a storage code may look like: it is part of topics, of documents and, before a slash, of a place's code.
bool is_code(const std::string& text) {
  return !text.empty() && text.size() <= kLongestCode && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_' ||
           c == '.';
  });
}

void read_code(const YamlMap& map, Zone& zone) {
  zone.code = map.text("code").value_or("");
  if (map.has("code") && !is_code(zone.code))
    map.fault("code", "is " + quote(zone.code) + ": give 1 to 32 letters, digits, points, dashes or underscores");
}

void read_kind(const YamlMap& map, Zone& zone) {
  const auto kind = map.text("kind");
  if (kind && *kind != "storage" && *kind != "dock") map.fault("kind", "is " + quote(*kind) + ": give storage or dock");
  zone.kind = kind == "dock" ? ZoneKind::kDock : ZoneKind::kStorage;
}

void read_polygon(const YamlMap& map, Zone& zone) {
  const auto corners = map.points("polygon_m", 3, kMostCorners, 2, kCoordinate);
  if (!corners) return;
  for (const Eigen::VectorXd& corner : *corners) zone.polygon_map.emplace_back(corner);
  if (is_simple(zone.polygon_map)) return;
  map.fault("polygon_m", "is no polygon: give its corners in order, no two the same, with no side across another");
  zone.polygon_map.clear();
}

void read_heights(const YamlMap& map, Zone& zone) {
  if (const auto range = map.numbers("z_m", 2, 2, kCoordinate)) {
    zone.bottom_m = (*range)[0].value;
    zone.top_m = (*range)[1].value;
    if (zone.top_m <= zone.bottom_m) return map.fault("z_m", "is empty: give [bottom, top], as [0, 3]");
  }
  zone.floor_m = map.number("floor_m", within(zone.bottom_m, zone.top_m)).value_or(zone.floor_m);
  if (!map.has("levels_m")) {
    if (!map.has("floor_m") && (zone.bottom_m > 0 || zone.top_m < 0))
      map.fault("z_m", "leaves out 0: say how high the zone's floor is (floor_m), or its rack's levels (levels_m)");
    return;
  }
  const auto levels = map.numbers("levels_m", 1, kMostLevels, within(zone.bottom_m, zone.top_m));
  if (!levels) return;
  for (const YamlMap::Number& level : *levels) zone.levels_m.push_back(level.value);
  if (!std::is_sorted(zone.levels_m.begin(), zone.levels_m.end(), [](double a, double b) { return a <= b; }))
    map.fault("levels_m", "does not rise: give the heights from the lowest level up, none twice");
}

void read_places(const YamlMap& map, Zone& zone) {
  PlaceGrid grid;
  const auto first = map.numbers("first_m", 2, 2, kCoordinate);
  const auto pitch = map.numbers("pitch_m", 2, 2, above(0, 100));
  const auto columns = map.integer("columns", within(1, kMostInLine));
  const auto rows = map.integer("rows", within(1, kMostInLine));
  grid.yaw_rad = radians(map.number("yaw_deg", within(-360, 360)).value_or(0.0));
  if (!first || !pitch || !columns || !rows) return;
  grid.first_m = {(*first)[0].value, (*first)[1].value};
  grid.pitch_m = {(*pitch)[0].value, (*pitch)[1].value};
  grid.columns = static_cast<int>(*columns);
  grid.rows = static_cast<int>(*rows);
  zone.grid = grid;
  if (zone.polygon_map.empty()) return;
  Zone ground = zone;
  ground.levels_m.clear();
  for (const Place& place : grid_places(ground))
    if (!contains(zone.polygon_map, place.position_map.head<2>()))
      return map.fault("first_m", "puts place " + quote(place.code) + " outside polygon_m: move or shrink the grid");
}

ZoneDraft read_zone(const YamlMap& map) {
  ZoneDraft draft;
  draft.line = map.line();
  read_code(map, draft.zone);
  read_kind(map, draft.zone);
  read_polygon(map, draft.zone);
  read_heights(map, draft.zone);
  draft.zone.pallet_type = map.text("pallet").value_or("");
  if (map.has("places")) read_places(map.section("places", kPlaceKeys), draft.zone);
  return draft;
}

void check_pair(const ZoneDraft& first, const ZoneDraft& second, FaultLog& faults) {
  const std::string other = "the zone on line " + std::to_string(first.line);
  const Zone &a = first.zone, &b = second.zone;
  if (!a.code.empty() && a.code == b.code)
    faults.add(second.line, "zone code " + quote(a.code) + " is taken by " + other + ": give each zone its own");
  if (a.polygon_map.empty() || b.polygon_map.empty() || a.bottom_m > b.top_m || b.bottom_m > a.top_m) return;
  if (shared_area_m2(a.polygon_map, b.polygon_map) > kTouching_m2)
    faults.add(second.line, "zone " + quote(b.code) + " covers ground of " + quote(a.code) + ", " + other +
                                ": part them, or give each its own z_m");
}

}  // namespace

std::vector<Zone> read_zones(const YamlMap& file, FaultLog& faults) {
  const std::vector<YAML::Node> nodes = file.list("zones");
  std::vector<ZoneDraft> drafts;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    drafts.push_back(
        read_zone(YamlMap(nodes[i], "zones[" + std::to_string(i) + "]", file.line("zones"), kZoneKeys, faults)));
  for (std::size_t i = 0; i < drafts.size(); ++i)
    for (std::size_t j = i + 1; j < drafts.size(); ++j) check_pair(drafts[i], drafts[j], faults);
  std::vector<Zone> zones;
  for (ZoneDraft& draft : drafts) zones.push_back(std::move(draft.zone));
  return zones;
}

}  // namespace lodestar
