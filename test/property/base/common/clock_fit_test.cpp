#include "lodestar/base/common/clock_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/noise.hpp"

namespace lodestar {
namespace {

struct Link {
  double rate_hz;       ///< of samples
  double drift;         ///< of the host's clock against the device's
  double mean_delay_s;  ///< exponential
  double busy;          ///< share of the samples that a busy computer delays by up to 5 ms more
  double stuck_s = 0;   ///< of each ten seconds: all samples come 0.1 s later
};

/// Largest error of the mapped time of each sample after five seconds, over a minute.
double largest_error_s(const Link& link, std::uint64_t seed) {
  test::Noise noise(seed);
  ClockFitParams params;
  params.tick_hz = 1e6;
  params.counter_bits = 32;
  ClockFit fit(params);
  const Stamp start(std::chrono::seconds(1'700'000'000));
  const std::uint64_t first_ticks = noise.bits();
  double largest_s = 0;
  for (double t_s = 0; t_s < 60; t_s += 1 / link.rate_hz) {
    const std::uint64_t ticks =
        (first_ticks + static_cast<std::uint64_t>(std::llround(t_s * params.tick_hz))) & 0xFFFFFFFF;
    const Stamp truth = start + from_seconds(t_s * (1 + link.drift));
    double delay_s = -link.mean_delay_s * std::log(noise.uniform(1e-9, 1));
    if (noise.uniform(0, 1) < link.busy) delay_s += noise.uniform(0, 5e-3);
    if (std::fmod(t_s, 10) > 10 - link.stuck_s) delay_s += 0.1;
    fit.add(ticks, truth + from_seconds(delay_s));
    if (t_s > 5) largest_s = std::max(largest_s, std::abs(seconds(fit.to_host(ticks).value() - truth)));
  }
  EXPECT_EQ(fit.restarts(), 0u);
  return largest_s;
}

double largest_error_s(const Link& link) {
  double largest_s = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) largest_s = std::max(largest_s, largest_error_s(link, seed));
  testing::Test::RecordProperty("largest_error_us", std::to_string(largest_s * 1e6));
  return largest_s;
}

// The figures of docs/math/clock_fit.md.
TEST(ClockFitProperty, AQuietCamera) { EXPECT_LT(largest_error_s({60, 100e-6, 0.1e-3, 0}), 10e-6); }

TEST(ClockFitProperty, ACameraOnABusyComputer) { EXPECT_LT(largest_error_s({60, -100e-6, 0.5e-3, 0.3}), 40e-6); }

TEST(ClockFitProperty, ACameraOnAComputerThatIsStuckHalfTheTime) {
  EXPECT_LT(largest_error_s({60, -100e-6, 0.5e-3, 0.3, 5}), 200e-6);
}

TEST(ClockFitProperty, ABoardThatIsHeardOnceASecond) { EXPECT_LT(largest_error_s({1, 100e-6, 0.5e-3, 0.1}), 1.5e-3); }

}  // namespace
}  // namespace lodestar
