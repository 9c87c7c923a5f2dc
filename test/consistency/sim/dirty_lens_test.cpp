// The camera goes blind on the way: the photodiodes keep the pose, degraded, and the covariance says how far.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "lodestar/sim/line_run.hpp"

namespace lodestar {
namespace {

struct Blind {
  double worst_m = 0, worst_sigmas = 0, last_sigma_m = 0;
  std::size_t most_seen = 0;  ///< beacons at once through the dirt
  double moved_s = 0;         ///< of that time
  bool lost = false;
};

constexpr int kClean_px = 80;  // to each side of the middle; the beacons' images are 160 apart

/// What a lens shows that is dirty but for a patch in the middle, as wide as one beacon's share of the ceiling.
Image through_dirt(const Image& image) {
  const auto pixels = std::make_shared<std::vector<std::uint8_t>>(image.data, image.row<std::uint8_t>(image.height_px));
  for (int v = 0; v < image.height_px; ++v) {
    std::uint8_t* row = pixels->data() + static_cast<std::size_t>(v) * image.stride_bytes;
    const int clean = std::abs(v - image.height_px / 2) <= kClean_px ? kClean_px : 0;
    std::memset(row, 0, static_cast<std::size_t>(image.width_px / 2 - clean));
    std::memset(row + image.width_px / 2 + clean, 0, static_cast<std::size_t>(image.width_px / 2 - clean));
  }
  Image dirty = image;
  dirty.data = pixels->data();
  dirty.owner = pixels;
  return dirty;
}

/// Round and round through the hall, with no image after `from_s`, or with a patch of each.
Blind drive_blind(double from_s, bool photodiodes, double until_s, bool patch = false) {
  auto loaded = sim::load_scenario(std::string(LODESTAR_SOURCE_DIR) + "/test/golden/sim/line.yaml");
  EXPECT_TRUE(loaded.ok());
  sim::Scenario scenario = *loaded;
  scenario.duration_s = until_s;
  scenario.odometry.yaw_scale_error = 0.02;
  scenario.route.waypoints = {{{5, 10}, 2}, {{5, 24}, 2, 1.5}, {{15, 24}, 2, 1.5}, {{15, 6}, 2, 1.5}, {{5, 6}, 2, 1.5}};
  scenario.route.repeat = true;
  sim::Simulation simulation(scenario);
  LocalizationLine line = sim::make_line(scenario);
  Blind out;
  while (const auto event = simulation.next()) {
    const double time_s = seconds(event->received - scenario.start);
    const auto* image = std::get_if<Image>(&event->data);
    const bool frame = std::holds_alternative<RawIrFrame>(event->data);
    if (time_s > from_s && ((image && !patch) || (frame && !photodiodes))) continue;
    if (time_s > from_s && image) {
      if (const auto outcome = line.process(through_dirt(*image)))
        out.most_seen = std::max(out.most_seen, outcome->sightings.sightings.size());
    } else {
      sim::feed(line, *event);
    }
    const auto* truth = std::get_if<sim::TrueBase>(&event->data);
    if (truth == nullptr || time_s < from_s) continue;
    if (simulation.truck().motion(time_s).velocity_map_m_s.norm() > 0.5) out.moved_s += 1 / scenario.truth_rate_hz;
    const auto estimate = line.fusion().filter().estimate_at(truth->stamp);
    out.lost = !estimate;
    if (!estimate) continue;
    const Eigen::Vector2d off = (estimate->T_map_base.translation() - truth->T_map_base.translation()).head<2>();
    const Eigen::Matrix2d P = estimate->covariance.topLeftCorner<2, 2>();
    out.worst_m = std::max(out.worst_m, off.norm());
    out.worst_sigmas = std::max(out.worst_sigmas, std::sqrt(off.dot(P.inverse() * off)));
    out.last_sigma_m = std::sqrt(P.trace());
  }
  return out;
}

TEST(DirtyLens, PhotodiodesKeepThePoseThatTheCameraLoses) {
  const Blind with = drive_blind(3, true, 63), without = drive_blind(3, false, 63);
  std::printf(
      "blind for a minute, driving %.0f s of it: worst %.2f m, %.1f sigma; sigma at the end %.2f m, without %.2f m\n",
      with.moved_s, with.worst_m, with.worst_sigmas, with.last_sigma_m, without.last_sigma_m);
  EXPECT_GT(with.moved_s, 55);
  EXPECT_FALSE(with.lost);
  EXPECT_LT(with.worst_m, 0.5);
  EXPECT_LT(with.worst_sigmas, 4.5);
  EXPECT_LT(with.last_sigma_m, 0.6 * without.last_sigma_m) << "wheels and gyro alone know less and less";
}

TEST(DirtyLens, BlindFromTheStartTheTruckStillHasAPose) {
  const Blind with = drive_blind(0, true, 30), without = drive_blind(0, false, 5);
  std::printf("blind from the start: worst %.2f m, %.1f sigma, sigma at the end %.2f m\n", with.worst_m,
              with.worst_sigmas, with.last_sigma_m);
  EXPECT_GT(with.moved_s, 25);
  EXPECT_TRUE(without.lost);
  EXPECT_FALSE(with.lost);
  EXPECT_LT(with.worst_m, 1.5);
  EXPECT_LT(with.worst_sigmas, 4.5);
}

TEST(DirtyLens, WithOneBeaconLeftFromTheStartTheTruckStillHasAPose) {
  const Blind with = drive_blind(0, true, 15, true);
  std::printf("one beacon left from the start: worst %.2f m, %.1f sigma, sigma at the end %.2f m, %zu at once\n",
              with.worst_m, with.worst_sigmas, with.last_sigma_m, with.most_seen);
  EXPECT_EQ(with.most_seen, 1u);
  EXPECT_FALSE(with.lost);
  EXPECT_LT(with.worst_m, 1.5);
  EXPECT_LT(with.worst_sigmas, 4.5);
}

}  // namespace
}  // namespace lodestar
