#include "lodestar/base/site/site.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "beacon_draft.hpp"
#include "key_file.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/base/yaml/yaml_document.hpp"
#include "lodestar/base/yaml/yaml_map.hpp"

namespace lodestar {

namespace {

const std::vector<YamlKey> kFileKeys = {{"site", true}, {"link", false}, {"tone_table_hz", true}, {"beacons", false}};
const std::vector<YamlKey> kSiteKeys = {{"name", true}, {"frame_id", false}};
const std::vector<YamlKey> kLinkKeys = {
    {"bit_rate_bps", false}, {"slot_s", false}, {"slot_count", false}, {"key_file", false}};
const std::vector<YamlKey> kBeaconKeys = {{"id", true},   {"position_m", true}, {"tones_hz", true},
                                          {"slot", true}, {"waveform", false},  {"sigma_m", false}};

/// The same keys where the code plan is still to be made.
std::vector<YamlKey> unplanned(std::vector<YamlKey> keys) {
  for (YamlKey& key : keys)
    for (const char* planned : {"tone_table_hz", "tones_hz", "slot"})
      if (std::string(planned) == key.name) key.required = false;
  return keys;
}

/// Announcements carry whole mm in 32 bits.
constexpr double kFarthest_m = std::numeric_limits<std::int32_t>::max() * 1e-3;
constexpr double kHighestTone_hz = 1000.0;
constexpr int kMostTonesOfABeacon = 3;

/// Preamble, sync and octets on air.
constexpr double kFrameBits = 16 + 16 + 8 * static_cast<double>(RawIrFrame::kOctets);

void read_identity(const YamlMap& map, Site& site) {
  site.name = map.text("name").value_or("");
  if (map.has("name") && site.name.empty()) map.fault("name", "is empty: give the site a name");
  site.frame_id = map.text("frame_id").value_or(site.frame_id);
  if (site.frame_id.empty() || site.frame_id.find_first_of("/ ") != std::string::npos)
    map.fault("frame_id", "is " + quote(site.frame_id) + ": give a tf frame without slash or space, as map");
}

void read_key(const YamlMap& map, const std::string& site_file, Link& link) {
  const std::string key_file = map.text("key_file").value_or("");
  if (key_file.empty()) return;
  link.key_file = key_file;
  const auto path = std::filesystem::path(site_file).parent_path() / key_file;
  std::string why;
  link.key = read_key_file(path.string(), why);
  if (!link.key) map.fault("key_file", quote(key_file) + " " + why);
}

Link read_link(const YamlMap& map, const std::string& site_file) {
  Link link;
  const auto bit_rate_bps = map.number("bit_rate_bps", within(100, 1e7));
  const auto slot_s = map.number("slot_s", above(0, 60));
  const auto slot_count = map.integer("slot_count", within(1, 256));
  link.bit_rate_bps = bit_rate_bps.value_or(link.bit_rate_bps);
  link.slot_s = slot_s.value_or(link.slot_s);
  if (slot_count) link.slot_count = static_cast<int>(*slot_count);
  const bool readable = (bit_rate_bps || !map.has("bit_rate_bps")) && (slot_s || !map.has("slot_s"));
  const double frame_s = kFrameBits / link.bit_rate_bps;
  if (readable && link.slot_s < frame_s)
    map.fault(map.has("slot_s") ? "slot_s" : "bit_rate_bps",
              "is too little: a frame of " + print(kFrameBits) + " bits takes " + print(frame_s) + " s at " +
                  print(link.bit_rate_bps) + " bit/s and slot_s is " + print(link.slot_s) + "; raise either");
  read_key(map, site_file, link);
  return link;
}

/// Index of the tone, or -1.
int find_tone(const std::vector<double>& table_hz, double tone_hz) {
  for (std::size_t i = 0; i < table_hz.size(); ++i)
    if (std::abs(table_hz[i] - tone_hz) < kSameTone_hz) return static_cast<int>(i);
  return -1;
}

void read_tone_table(const YamlMap& map, FaultLog& faults, Site& site) {
  const auto tones = map.numbers("tone_table_hz", 1, ToneSet::kMaxTones, above(0, kHighestTone_hz));
  if (!tones) return;
  for (const YamlMap::Number& tone : *tones) {
    if (find_tone(site.tone_table_hz, tone.value) >= 0)
      faults.add(tone.line, "tone_table_hz has " + print(tone.value) + " twice: give each tone once");
    site.tone_table_hz.push_back(tone.value);
    site.tone_table_lines.push_back(tone.line);
  }
}

double nearest_tone(const std::vector<double>& table_hz, double tone_hz) {
  return *std::min_element(table_hz.begin(), table_hz.end(),
                           [=](double a, double b) { return std::abs(a - tone_hz) < std::abs(b - tone_hz); });
}

std::optional<ToneSet> read_tones(const YamlMap& map, const std::vector<double>& table_hz, FaultLog& faults) {
  const auto tones = map.numbers("tones_hz", 1, kMostTonesOfABeacon, above(0, kHighestTone_hz));
  if (!tones || table_hz.empty()) return std::nullopt;
  ToneSet set;
  bool good = true;
  for (const YamlMap::Number& tone : *tones) {
    const int index = find_tone(table_hz, tone.value);
    if (index < 0)
      faults.add(tone.line, map.path("tones_hz") + ": " + print(tone.value) +
                                " is not in tone_table_hz; the nearest there is " +
                                print(nearest_tone(table_hz, tone.value)));
    else if (set.contains(index))
      faults.add(tone.line, map.path("tones_hz") + ": " + print(tone.value) + " is there twice: give each tone once");
    good = good && index >= 0 && !set.contains(index);
    if (index >= 0) set.insert(index);
  }
  if (!good) return std::nullopt;
  return set;
}

Waveform read_waveform(const YamlMap& map, const std::optional<ToneSet>& tones) {
  const std::string text = map.text("waveform").value_or("sine");
  if (text != "sine" && text != "square") map.fault("waveform", "is " + quote(text) + ": give sine or square");
  if (text == "square" && tones && tones->size() > 1)
    map.fault("waveform", "is square with " + std::to_string(tones->size()) + " tones: give one tone, or make it sine");
  return text == "square" ? Waveform::kSquare : Waveform::kSine;
}

/// What a survey knows: id and place.
BeaconDraft read_place(const YamlMap& map) {
  BeaconDraft draft;
  draft.line = map.line();
  draft.id_line = map.line("id");
  const auto id = map.integer("id", within(1, std::numeric_limits<std::uint32_t>::max()));
  if (id) draft.id = BeaconId{static_cast<std::uint32_t>(*id)};
  const auto position = map.numbers("position_m", 3, 3, within(-kFarthest_m, kFarthest_m));
  if (position) draft.position_map = Eigen::Vector3d((*position)[0].value, (*position)[1].value, (*position)[2].value);
  draft.sigma_m = map.number("sigma_m", above(0, 1)).value_or(draft.sigma_m);
  return draft;
}

BeaconDraft read_beacon(const YamlMap& map, const Site& site, FaultLog& faults) {
  BeaconDraft draft = read_place(map);
  draft.tones_line = map.line("tones_hz");
  draft.slot_line = map.line("slot");
  draft.tones = read_tones(map, site.tone_table_hz, faults);
  const auto slot = map.integer("slot", within(0, site.link.slot_count - 1));
  if (slot) draft.slot = static_cast<int>(*slot);
  draft.waveform = read_waveform(map, draft.tones);
  return draft;
}

/// The entries of the list, each read by `read`, and what they get wrong together.
template <class Read>
std::vector<BeaconDraft> read_drafts(const YamlMap& file, const std::vector<YamlKey>& keys, FaultLog& faults,
                                     Read&& read) {
  std::vector<BeaconDraft> drafts;
  const std::vector<YAML::Node> nodes = file.list("beacons");
  for (std::size_t i = 0; i < nodes.size(); ++i)
    drafts.push_back(read(YamlMap(nodes[i], "beacons[" + std::to_string(i) + "]", file.line("beacons"), keys, faults)));
  check_clashes(drafts, faults);
  return drafts;
}

std::vector<Beacon> read_beacons(const YamlMap& file, const Site& site, FaultLog& faults) {
  const auto read = [&](const YamlMap& map) { return read_beacon(map, site, faults); };
  std::vector<Beacon> beacons;
  for (const BeaconDraft& draft : read_drafts(file, kBeaconKeys, faults, read))
    if (draft.id && draft.position_map && draft.tones && draft.slot)
      beacons.push_back({*draft.id, *draft.position_map, *draft.tones, *draft.slot, draft.waveform, draft.sigma_m});
  return beacons;
}

Site read_frame(const YamlMap& file, const std::string& file_name) {
  Site site;
  read_identity(file.section("site", kSiteKeys), site);
  site.link = read_link(file.section("link", kLinkKeys), file_name);
  return site;
}

Site read_site(const YAML::Node& root, FaultLog& faults) {
  const YamlMap file(root, "", 1, kFileKeys, faults);
  Site site = read_frame(file, faults.file());
  read_tone_table(file, faults, site);
  site.beacons = read_beacons(file, site, faults);
  return site;
}

Site read_survey(const YAML::Node& root, FaultLog& faults) {
  const YamlMap file(root, "", 1, unplanned(kFileKeys), faults);
  Site site = read_frame(file, faults.file());
  for (const BeaconDraft& draft : read_drafts(file, unplanned(kBeaconKeys), faults, read_place))
    if (draft.id && draft.position_map)
      site.beacons.push_back({*draft.id, *draft.position_map, {}, 0, Waveform::kSine, draft.sigma_m});
  return site;
}

Result<Site, Faults> parse_survey(const std::string& text, const std::string& file_name) {
  return parse_file<Site>(text, file_name, read_survey);
}

}  // namespace

Result<Site, Faults> parse_site(const std::string& text, const std::string& file_name) {
  return parse_file<Site>(text, file_name, read_site);
}

Result<Site, Faults> load_site(const std::string& path) { return load_file<Site>(path, parse_site); }

Result<Site, Faults> load_survey(const std::string& path) { return load_file<Site>(path, parse_survey); }

}  // namespace lodestar
