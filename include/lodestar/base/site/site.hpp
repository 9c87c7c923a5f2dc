#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/common/fault.hpp"
#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/tone_set.hpp"
#include "lodestar/base/site/zone.hpp"

namespace lodestar {

enum class Waveform { kSine, kSquare };

/// One beacon as surveyed, or as it announces itself.
struct Beacon {
  BeaconId id;
  Eigen::Vector3d position_map = Eigen::Vector3d::Zero();  ///< m
  ToneSet tones;                                           ///< indices into Site::tone_table_hz
  int slot = 0;
  Waveform waveform = Waveform::kSine;
  double sigma_m = 0.01;  ///< of the survey, each axis
};

/// The data channel's parameters (optical_link.md, section 2).
struct Link {
  double bit_rate_bps = 19200;
  double slot_s = 0.025;
  int slot_count = 32;
  std::optional<std::array<std::uint8_t, 16>> key;  ///< of the site; when set, unsigned frames are refused
  std::string key_file;                             ///< as the site file names it; empty: no key
};

/// The surveyed site: shared interface "Site file". Reference: docs/nodes/site_and_vehicle_files.md.
struct Site {
  std::string name;
  std::string frame_id = "map";
  Link link;
  std::vector<double> tone_table_hz;  ///< 1 to ToneSet::kMaxTones, positive, no two the same
  std::vector<Beacon> beacons;        ///< may be empty: then positions come from announcements alone
  std::vector<Zone> zones;            ///< may be empty; no two cover the same ground at the same height
  std::vector<int> tone_table_lines;  ///< where each tone stands in its file, for faults; empty: not from a file
};

/// What the site's tones must get along with; known from the vehicle file or from a recording.
struct FrameRate {
  double rate_hz = 60;
  double mains_hz = 50;
  std::optional<int> window_frames = std::nullopt;  ///< empty: window_frames(tone table, rate)
};

/// Tones nearer than this are one and the same: it is what two clocks 100 ppm off make of 10 Hz.
constexpr double kSameTone_hz = 0.001;

/// Within this distance no two beacons share a code or a slot.
constexpr double kReuseDistance_m = 30.0;

/// Reads and checks a site file; every fault is listed with file and line: unknown key, missing key, duplicate id,
/// code or slot clash within 30 m, NaN, a dimensioned key without its unit, slot out of range, more than 3 tones,
/// tone not in the table, unreadable key file, a zone without a code of its own or on another's ground. A relative
/// key_file is looked for beside the site file.
Result<Site, Faults> load_site(const std::string& path);

/// The same for text at hand. `file_name` is for the faults and for a relative key_file. Throws nothing, whatever the
/// text holds.
Result<Site, Faults> parse_site(const std::string& text, const std::string& file_name);

/// Reads a site file for code planning: as load_site, but no beacon needs tones_hz or slot and the file no
/// tone_table_hz; where they are, they are passed over, as is waveform. Tone table and codes are empty, slots 0.
Result<Site, Faults> load_survey(const std::string& path);

/// The site as text that parse_site reads back to the same site.
std::string to_yaml(const Site& site);

/// Checks the tones against a frame rate: above Nyquist, or on an alias of the mains' flicker (100 and 120 Hz and their
/// multiples fold to |m - k fs|), or closer to one another (or to 0 Hz) than rate / window. `path` is for the faults
/// alone.
Faults check_tones(const Site& site, const FrameRate& frame_rate, const std::string& path);

/// The window of the interfaces page: the shortest multiple of rate / smallest tone spacing (0 Hz counted in) that has
/// at least 15 frames. A measured rate (24.98) is no round number: each multiple is taken to the nearest whole frame
/// first, so that 24.98 and 25 give the same window. 0 when there is none: no tone, two tones the same, or a rate that
/// is not positive.
int window_frames(const std::vector<double>& tone_table_hz, double frame_rate_hz);

}  // namespace lodestar
