#include <gtest/gtest.h>

#include <random>
#include <string>

#include "lodestar/base/site/site.hpp"
#include "lodestar/base/site/vehicle.hpp"

namespace lodestar {
namespace {

const std::string kSite = R"(site: {name: hall-12, frame_id: map}
link: {bit_rate_bps: 19200, slot_s: 0.025, slot_count: 32, key_file: ""}
tone_table_hz: [6, 8, 10, 12]
beacons:
  - {id: 1, position_m: [3.50, 3.75, 8.02], tones_hz: [6, 10], slot: 0, waveform: sine, sigma_m: 0.02}
  - id: 2
    position_m: [10, -3.75, 8]
    tones_hz: [12]
    slot: 3
zones:
  - {code: A, kind: storage, polygon_m: [[0, 0], [9, 0], [9, 9]], z_m: [0, 5], levels_m: [0, 2],
     places: {first_m: [6, 2], pitch_m: [1.3, 0.9], columns: 2, rows: 2, yaw_deg: 0}}
  - {code: IN, kind: dock, polygon_m: [[-9, 0], [-1, 0], [-1, 9]]}
)";

const std::string kVehicle = R"(vehicle: {name: t7}
camera: {mount: {xyz_m: [0, 0, 2], rpy_deg: [0, 0, 0]}, rate_hz: 60, mains_hz: 50}
imu: {gyro_noise_deg_s: 0.1}
)";

/// Bytes replaced, taken out and doubled; pieces that mean something to YAML put in.
std::string mutated(std::string text, std::mt19937& random) {
  static const std::string kPieces[] = {"{", "}",    "[",     "]",  ":",   "- ",   "&a ",  "*a",
                                        "!", "\"",   "'",     "\n", "\t",  ".nan", "-1",   "1e400",
                                        "~", "<<: ", "---\n", "? ", "|\n", "%",    "\xff", "0x10"};
  const int changes = 1 + static_cast<int>(random() % 4);
  for (int i = 0; i < changes; ++i) {
    const std::size_t at = random() % text.size();
    switch (random() % 4) {
      case 0:
        text[at] = static_cast<char>(random() % 256);
        break;
      case 1:
        text.erase(at, 1 + random() % 8);
        break;
      case 2:
        text.insert(at, text.substr(random() % text.size(), random() % 30));
        break;
      default:
        text.insert(at, kPieces[random() % (sizeof(kPieces) / sizeof(kPieces[0]))]);
    }
    if (text.empty()) text = " ";
  }
  return text;
}

template <class T>
void expect_told(const Result<T, Faults>& result, const std::string& text) {
  if (result.ok()) return;
  EXPECT_FALSE(result.error().empty()) << text;
  for (const Fault& fault : result.error()) {
    EXPECT_EQ(fault.file, "x.yaml");
    EXPECT_GE(fault.line, 0) << text;
    EXPECT_FALSE(fault.what.empty());
  }
}

TEST(HostileText, never_throws_and_never_refuses_without_a_fault) {
  std::mt19937 random(20240522);
  for (int trial = 0; trial < 3000; ++trial) {
    const std::string site = mutated(kSite, random);
    ASSERT_NO_THROW(expect_told(parse_site(site, "x.yaml"), site)) << site;
    const std::string vehicle = mutated(kVehicle, random);
    ASSERT_NO_THROW(expect_told(parse_vehicle(vehicle, "x.yaml"), vehicle)) << vehicle;
  }
}

TEST(HostileText, what_loads_is_within_its_limits) {
  std::mt19937 random(7);
  int loaded = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto site = parse_site(mutated(kSite, random), "x.yaml");
    if (!site.ok()) continue;
    ++loaded;
    EXPECT_GE(site->tone_table_hz.size(), 1u);
    for (const Beacon& beacon : site->beacons) {
      EXPECT_TRUE(beacon.position_map.allFinite());
      EXPECT_GT(beacon.sigma_m, 0);
      EXPECT_LT(beacon.slot, site->link.slot_count);
      EXPECT_LT(beacon.tones.indices().back(), static_cast<int>(site->tone_table_hz.size()));
    }
  }
  EXPECT_GT(loaded, 20);
}

TEST(HostileText, nesting_and_circles_end) {
  expect_told(parse_site(std::string(400, '['), "x.yaml"), "brackets");
  expect_told(parse_site("&a {site: *a, link: *a, tone_table_hz: *a, beacons: [*a]}", "x.yaml"), "a circle");
  expect_told(parse_site("beacons: &a [*a, *a]\n", "x.yaml"), "a circle");
}

}  // namespace
}  // namespace lodestar
