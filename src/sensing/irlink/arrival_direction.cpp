#include "lodestar/sensing/irlink/arrival_direction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lodestar {

namespace {

constexpr float kClipped = 0.98f;
constexpr int kMaxIterations = 15;
constexpr double kConverged = 1e-6;  // relative step
constexpr double kWidest_rad = 0.5;
constexpr double kEdge_rad = 0.2;
constexpr double kGrazing = 0.02;  // keeps the model finite beside and behind a diode
constexpr double kMaxChi2PerDof = 16;

/// A level as the model has it, and how it changes with the sender's vector: strength times direction.
struct Expected {
  double level = 0;
  Eigen::RowVector3d J = Eigen::RowVector3d::Zero();
  double outside_rad = 0;  ///< of the diode's field of view; negative: within
};

Expected expect(const DiodeArray::Diode& diode, const DiodeArray& array, const Eigen::Vector3d& sender) {
  const double strength = sender.norm();
  const double cosine = std::clamp(diode.direction_ir.dot(sender) / strength, kGrazing, 1.0);
  const double m = array.response_exponent, power = std::pow(cosine, m);
  Expected out;
  out.outside_rad = std::acos(cosine) - array.half_angle_rad;
  out.level = diode.gain * strength * power;
  out.J = diode.gain *
          ((1 - m) * power * sender.transpose() / strength + m * power / cosine * diode.direction_ir.transpose());
  return out;
}

/// Whether a diode takes part. Near the edge of its view the level itself says whether it sees the sender, for there
/// the model jumps by more than the direction can tell.
bool sees(const Expected& expected, const float* level) {
  if (level == nullptr) return expected.outside_rad <= 0;
  if (*level >= kClipped || expected.outside_rad > kEdge_rad) return false;
  return expected.outside_rad < -kEdge_rad || *level > 0.5 * expected.level;
}

double variance(const Expected& expected, const DiodeArray& array) {
  return std::pow(array.level_noise, 2) + std::pow(array.gain_sigma * expected.level, 2);
}

struct Normal {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double chi2 = 0;
  int diodes = 0;
};

/// @param levels none: only A is of use
Normal normal_equations(const Eigen::Vector3d& sender, const DiodeArray& array, const std::vector<float>* levels) {
  Normal normal;
  for (std::size_t i = 0; i < array.diodes.size(); ++i) {
    const Expected expected = expect(array.diodes[i], array, sender);
    if (!sees(expected, levels != nullptr ? &(*levels)[i] : nullptr)) continue;
    const double weight = 1 / variance(expected, array);
    const double residual = levels != nullptr ? (*levels)[i] - expected.level : 0;
    normal.A += weight * expected.J.transpose() * expected.J;
    normal.b += weight * residual * expected.J.transpose();
    normal.chi2 += weight * residual * residual;
    ++normal.diodes;
  }
  return normal;
}

/// Of the sender's vector to that of its direction.
Eigen::Matrix3d direction_covariance(const Eigen::Vector3d& sender, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d u = sender.normalized();
  const Eigen::Matrix3d J = (Eigen::Matrix3d::Identity() - u * u.transpose()) / sender.norm();
  return J * covariance * J.transpose();
}

Eigen::Vector3d first_guess(const std::vector<float>& levels, const DiodeArray& array) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < levels.size(); ++i)
    sum += std::max(0.f, levels[i]) / array.diodes[i].gain * array.diodes[i].direction_ir;
  const float most = *std::max_element(levels.begin(), levels.end());
  return sum.norm() > 0 ? Eigen::Vector3d(most * sum.normalized()) : sum;
}

}  // namespace

const char* name(NoDirection reason) {
  switch (reason) {
    case NoDirection::kLevels:
      return "levels";
    case NoDirection::kTooFewDiodes:
      return "too few diodes";
    case NoDirection::kWeak:
      return "weak";
    case NoDirection::kContradiction:
      return "contradiction";
    case NoDirection::kCount:
      break;
  }
  return "unknown";
}

Result<ArrivalDirection, NoDirection> arrival_direction(const std::vector<float>& levels, const DiodeArray& array) {
  const bool finite = std::all_of(levels.begin(), levels.end(), [](float level) { return std::isfinite(level); });
  if (levels.empty() || levels.size() != array.diodes.size() || !finite) return NoDirection::kLevels;
  Eigen::Vector3d sender = first_guess(levels, array);
  if (!(sender.norm() > array.level_noise)) return NoDirection::kWeak;

  Normal normal;
  Eigen::Matrix3d covariance;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    normal = normal_equations(sender, array, &levels);
    if (normal.diodes < 3) return NoDirection::kTooFewDiodes;
    bool regular = false;
    normal.A.computeInverseWithCheck(covariance, regular, 1e-12);
    if (!regular) return NoDirection::kTooFewDiodes;
    const Eigen::Vector3d step = covariance * normal.b;
    const double shortest = std::min(1.0, 0.5 * sender.norm() / step.norm());  // the model is no line far off
    sender += shortest * step;
    if (step.norm() < kConverged * sender.norm()) break;
  }
  // What the model does not know, as light from a wall, shows in the residuals.
  const double excess = normal.diodes > 3 ? std::max(1.0, normal.chi2 / (normal.diodes - 3)) : 1.0;
  if (excess > kMaxChi2PerDof) return NoDirection::kContradiction;
  ArrivalDirection out;
  out.strength = sender.norm();
  out.direction_ir = sender / out.strength;
  out.covariance = direction_covariance(sender, excess * covariance);
  if (!(out.covariance.trace() < kWidest_rad * kWidest_rad)) return NoDirection::kWeak;
  return out;
}

Eigen::Matrix3d least_direction_covariance(const ArrivalDirection& truth, const DiodeArray& array) {
  const Eigen::Vector3d sender = truth.strength * truth.direction_ir;
  return direction_covariance(sender, normal_equations(sender, array, nullptr).A.inverse());
}

}  // namespace lodestar
