#include "lodestar/sensing/beacon/tone_bank.hpp"

#include <gtest/gtest.h>

#include <random>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

std::vector<Stamp> even_stamps(int frames, double rate_hz) {
  std::vector<Stamp> stamps;
  for (int i = 0; i < frames; ++i) stamps.push_back(Stamp{} + std::chrono::seconds(5) + from_seconds(i / rate_hz));
  return stamps;
}

Eigen::VectorXf signal(const std::vector<Stamp>& stamps, double tone_hz, double amplitude, double phase_rad) {
  Eigen::VectorXf x(static_cast<Eigen::Index>(stamps.size()));
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    x[static_cast<Eigen::Index>(i)] = static_cast<float>(
        100 + amplitude * std::cos(2 * kPi * tone_hz * seconds(stamps[i].time_since_epoch()) + phase_rad));
  }
  return x;
}

double power(const ToneBank& bank, const Eigen::VectorXf& x, int tone) {
  return (bank.basis().middleRows(2 * tone, 2) * x).squaredNorm();
}

/// The textbook recursion, as Goertzel wrote it.
double goertzel(const Eigen::VectorXf& x, double tone_hz, double rate_hz) {
  const double coefficient = 2 * std::cos(2 * kPi * tone_hz / rate_hz);
  double s1 = 0, s2 = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double s = x[i] + coefficient * s1 - s2;
    s2 = s1;
    s1 = s;
  }
  return s1 * s1 + s2 * s2 - coefficient * s1 * s2;
}

TEST(ToneBank, EqualsTheTextbookRecursionOnEvenStamps) {
  const std::vector<double> tones = {6, 8, 10, 12, 14, 16, 24, 26};
  const auto stamps = even_stamps(30, 60);
  const ToneBank bank(stamps, tones);
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  Eigen::VectorXf x(30);
  for (auto& value : x) value = 20 + normal(random);
  for (int k = 0; k < 8; ++k) {
    const double expected = 2.0 / 30 * goertzel(x, tones[static_cast<std::size_t>(k)], 60);
    EXPECT_NEAR(power(bank, x, k), expected, 1e-3 * (1 + expected)) << tones[static_cast<std::size_t>(k)] << " Hz";
  }
}

TEST(ToneBank, AToneHasItsPowerAndItsNeighboursNone) {
  const auto stamps = even_stamps(30, 60);
  const ToneBank bank(stamps, {6, 8, 10});
  const auto x = signal(stamps, 8, 5, 1.1);
  EXPECT_NEAR(power(bank, x, 1), 5 * 5 * 30 / 2.0, 0.05);
  EXPECT_NEAR(power(bank, x, 0), 0, 1e-3);
  EXPECT_NEAR(power(bank, x, 2), 0, 1e-3);
}

TEST(ToneBank, LostAndLateFramesDoNotBendTheFrequency) {
  auto stamps = even_stamps(34, 60);
  stamps.erase(stamps.begin() + 10, stamps.begin() + 13);
  stamps.erase(stamps.begin() + 20);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> jitter(-0.2 / 60, 0.2 / 60);
  for (auto& stamp : stamps) stamp += from_seconds(jitter(random));
  const ToneBank bank(stamps, {6, 8, 10});
  const auto x = signal(stamps, 8, 5, -0.4);
  EXPECT_NEAR(power(bank, x, 1), 5 * 5 * 30 / 2.0, 20);
  EXPECT_LT(power(bank, x, 0), 40);
  EXPECT_LT(power(bank, x, 2), 40);
  // Counted in frames, as if the stamps were even, the same signal falls apart.
  const ToneBank blind(even_stamps(30, 60), {6, 8, 10});
  EXPECT_LT(power(blind, x, 1), 300);
}

TEST(ToneBank, ATonesMultiplesAreOneRhythm) {
  const ToneBank bank(30, {4, 6, 8, 12});
  EXPECT_TRUE(bank.is_one_rhythm({1}));
  EXPECT_TRUE(bank.is_one_rhythm({0, 2}));
  EXPECT_TRUE(bank.is_one_rhythm({0, 2, 3}));
  EXPECT_FALSE(bank.is_one_rhythm({0, 1}));
  EXPECT_FALSE(bank.is_one_rhythm({2, 3}));
}

TEST(ToneBank, NoiseIsChiSquareWithTwoDegreesOfFreedom) {
  const auto stamps = even_stamps(15, 25);
  const ToneBank bank(stamps, {5, 10});
  std::mt19937 random(5);
  std::normal_distribution<float> normal(0, 2);
  const int trials = 20000;
  double mean = 0;
  int beyond = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Eigen::VectorXf x(15);
    for (auto& value : x) value = 7 + normal(random);
    const double p = power(bank, x, 0) / 4;
    mean += p / trials;
    beyond += p > 2 * std::log(100.0);
  }
  EXPECT_NEAR(mean, 2.0, 0.06);
  EXPECT_NEAR(beyond, trials / 100, 60);
}

TEST(ToneBank, AnAliasOfTheConstantHasNoPower) {
  const auto stamps = even_stamps(15, 25);
  const ToneBank bank(stamps, {25});
  EXPECT_EQ(power(bank, signal(stamps, 25, 9, 0.2), 0), 0);
}

TEST(ToneBank, WavesGoOnBeyondTheWindow) {
  auto stamps = even_stamps(40, 60);
  stamps[5] += from_seconds(0.004);
  const std::vector<double> tones = {6, 26};
  const auto x = signal(stamps, 26, 5, 1.1);
  const ToneBank all(stamps, tones), window({stamps.begin(), stamps.begin() + 30}, tones);
  const Eigen::Vector2f amplitudes = window.basis().middleRows(2, 2) * x.head(30);
  const Eigen::Vector2f in_waves = window.in_waves(1, amplitudes);
  for (int slot = 30; slot < 40; ++slot) {
    EXPECT_NEAR(in_waves.dot(all.waves().block<2, 1>(2, slot)), x[slot] - 100, 1e-3);
  }
}

}  // namespace
}  // namespace lodestar
