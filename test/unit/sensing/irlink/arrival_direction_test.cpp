#include "lodestar/sensing/irlink/arrival_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lodestar {
namespace {

std::vector<float> levels_of(const DiodeArray& array, const Eigen::Vector3d& sender) {
  std::vector<float> levels;
  for (const auto& diode : array.diodes) {
    const double cosine = diode.direction_ir.dot(sender.normalized());
    const bool seen = cosine >= std::cos(array.half_angle_rad);
    levels.push_back(
        static_cast<float>(seen ? diode.gain * sender.norm() * std::pow(cosine, array.response_exponent) : 0));
  }
  return levels;
}

Eigen::Vector3d sender(double strength, double zenith_deg, double azimuth_deg) {
  const double zenith = radians(zenith_deg), azimuth = radians(azimuth_deg);
  return strength *
         Eigen::Vector3d(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith));
}

NoDirection fault(const std::vector<float>& levels, const DiodeArray& array = DiodeArray::ring()) {
  const auto found = arrival_direction(levels, array);
  return found ? NoDirection::kCount : found.error();
}

TEST(DiodeArray, the_default_ring_is_that_of_the_link) {
  const DiodeArray array = DiodeArray::ring();
  ASSERT_EQ(array.diodes.size(), 8u);
  EXPECT_EQ(array.diodes[0].direction_ir, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(array.diodes[1].direction_ir.isApprox(Eigen::Vector3d(std::sin(radians(50)), 0, std::cos(radians(50)))));
  EXPECT_GT(array.diodes[2].direction_ir.y(), 0.5);  // counter-clockwise
}

TEST(ArrivalDirection, without_noise_it_is_exact) {
  for (const double exponent : {0.7, 1.0, 2.0})
    for (double zenith_deg = 0; zenith_deg <= 60; zenith_deg += 5)
      for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 20) {
        DiodeArray array = DiodeArray::ring();
        array.response_exponent = exponent;
        array.diodes[3].gain = 0.6;
        const Eigen::Vector3d truth = sender(0.3, zenith_deg, azimuth_deg);
        const auto found = arrival_direction(levels_of(array, truth), array);
        ASSERT_TRUE(found.ok()) << zenith_deg << " " << azimuth_deg << " " << name(found.error());
        EXPECT_LT((found->direction_ir - truth.normalized()).norm(), 1e-4) << zenith_deg << " " << azimuth_deg;
        EXPECT_NEAR(found->strength, 0.3, 1e-4);
      }
}

TEST(ArrivalDirection, a_diode_that_clips_is_left_out) {
  const DiodeArray array = DiodeArray::ring();
  const Eigen::Vector3d truth = sender(1.3, 20, 40);
  std::vector<float> levels = levels_of(array, truth);
  for (float& level : levels) level = std::min(level, 1.f);
  const auto found = arrival_direction(levels, array);
  ASSERT_TRUE(found.ok());
  EXPECT_LT((found->direction_ir - truth.normalized()).norm(), 1e-3);
}

TEST(ArrivalDirection, gains_that_are_not_calibrated_widen_the_covariance) {
  DiodeArray array = DiodeArray::ring();
  const std::vector<float> levels = levels_of(array, sender(0.3, 30, 10));
  const double wide = arrival_direction(levels, array)->covariance.trace();
  array.gain_sigma = 0.01;
  EXPECT_LT(arrival_direction(levels, array)->covariance.trace(), 0.2 * wide);
}

TEST(ArrivalDirection, levels_that_say_nothing_are_refused_by_their_reason) {
  const DiodeArray array = DiodeArray::ring();
  EXPECT_EQ(fault({}), NoDirection::kLevels);
  EXPECT_EQ(fault(std::vector<float>(7, 0.1f)), NoDirection::kLevels);
  std::vector<float> levels = levels_of(array, sender(0.3, 30, 10));
  levels[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(fault(levels), NoDirection::kLevels);
  EXPECT_EQ(fault(std::vector<float>(8, 0.f)), NoDirection::kWeak);
  EXPECT_EQ(fault(std::vector<float>(8, 1.f)), NoDirection::kTooFewDiodes);
  EXPECT_EQ(fault({0.3f, 0.3f, 0, 0, 0.3f, 0, 0, 0.3f}), NoDirection::kContradiction);
  DiodeArray two = DiodeArray::ring(2);
  EXPECT_EQ(fault({0.3f, 0.2f}, two), NoDirection::kTooFewDiodes);
}

}  // namespace
}  // namespace lodestar
