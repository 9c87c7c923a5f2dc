#include "lodestar/sensing/beacon/centre_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

constexpr double kMinSigmaPx = 0.3, kMaxSigmaPx = 3.0;

/// Share of a Gaussian's light in each of the patch's columns (or rows), with derivatives by centre and width.
struct Profile {
  std::array<double, Demodulation::kSide> share, by_centre, by_sigma;

  Profile(double centre, double sigma) {
    double edge_cdf[Demodulation::kSide + 1], edge_pdf[Demodulation::kSide + 1], edge_z[Demodulation::kSide + 1];
    for (int i = 0; i <= Demodulation::kSide; ++i) {
      const double z = (i - 0.5 - centre) / sigma;
      edge_z[i] = z;
      edge_cdf[i] = 0.5 * std::erfc(-z / std::sqrt(2.0));
      edge_pdf[i] = std::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi);
    }
    for (std::size_t i = 0; i < share.size(); ++i) {
      share[i] = edge_cdf[i + 1] - edge_cdf[i];
      by_centre[i] = -(edge_pdf[i + 1] - edge_pdf[i]) / sigma;
      by_sigma[i] = -(edge_pdf[i + 1] * edge_z[i + 1] - edge_pdf[i] * edge_z[i]) / sigma;
    }
  }
};

struct NormalEquations {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  double chi2 = 0;
  int pixels = 0;
};

/// @param theta light (grey levels), u, v, sigma (px)
NormalEquations linearize(const Eigen::Vector4d& theta, const Eigen::Array<float, 1, Demodulation::kPixels>& amplitude,
                          const Eigen::Array<float, 1, Demodulation::kPixels>& variance,
                          const Eigen::Array<bool, 1, Demodulation::kPixels>& valid) {
  const Profile u(theta[1], theta[3]), v(theta[2], theta[3]);
  NormalEquations sum;
  for (int i = 0; i < Demodulation::kPixels; ++i) {
    if (!valid[i]) continue;
    const auto x = static_cast<std::size_t>(i % Demodulation::kSide),
               y = static_cast<std::size_t>(i / Demodulation::kSide);
    const double shape = u.share[x] * v.share[y];
    const double weight = 1.0 / variance[i];
    const double residual = amplitude[i] - theta[0] * shape;
    const Eigen::Vector4d J(shape, theta[0] * u.by_centre[x] * v.share[y], theta[0] * u.share[x] * v.by_centre[y],
                            theta[0] * (u.by_sigma[x] * v.share[y] + u.share[x] * v.by_sigma[y]));
    sum.information += weight * J * J.transpose();
    sum.gradient += weight * J * residual;
    sum.chi2 += weight * residual * residual;
    ++sum.pixels;
  }
  return sum;
}

Eigen::Vector4d start_value(const Eigen::Array<float, 1, Demodulation::kPixels>& amplitude,
                            const Eigen::Array<bool, 1, Demodulation::kPixels>& valid) {
  double light = 0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  const float highest = valid.select(amplitude, 0.0f).maxCoeff();
  for (int i = 0; i < Demodulation::kPixels; ++i) {
    if (!valid[i] || amplitude[i] < 0.2f * highest) continue;
    light += amplitude[i];
    moment += amplitude[i] * Demodulation::place(i).cast<double>();
  }
  if (light <= 0) return {0, 0, 0, 1};
  return {1.2 * light, moment.x() / light, moment.y() / light, 1.0};
}

}  // namespace

std::optional<CentreFit> fit_centre(const Eigen::Array<float, 1, Demodulation::kPixels>& amplitude,
                                    const Eigen::Array<float, 1, Demodulation::kPixels>& variance,
                                    const Eigen::Array<bool, 1, Demodulation::kPixels>& valid) {
  constexpr int kMaxSteps = 30;
  Eigen::Vector4d theta = start_value(amplitude, valid);
  if (theta[0] <= 0) return std::nullopt;
  NormalEquations here = linearize(theta, amplitude, variance, valid);
  if (here.pixels < 8) return std::nullopt;

  // Levenberg-Marquardt: the width and the light of a bridged core are nearly one parameter.
  double damping = 1e-3;
  for (int step = 0; step < kMaxSteps; ++step) {
    Eigen::Matrix4d damped = here.information;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::Vector4d change = damped.ldlt().solve(here.gradient);
    Eigen::Vector4d next = theta + change;
    next[3] = std::clamp(next[3], kMinSigmaPx, kMaxSigmaPx);
    if (!next.allFinite()) return std::nullopt;
    const NormalEquations there = linearize(next, amplitude, variance, valid);
    if (there.chi2 > here.chi2) {
      damping *= 10;
      if (damping > 1e8) break;
      continue;
    }
    const double moved = (next - theta).segment<2>(1).norm();
    theta = next;
    here = there;
    damping = std::max(1e-9, damping * 0.1);
    if (moved < 1e-5) break;
  }

  const bool inside = theta[0] > 0 && theta[1] > 0 && theta[1] < Demodulation::kSide - 1 && theta[2] > 0 &&
                      theta[2] < Demodulation::kSide - 1;
  if (!inside) return std::nullopt;
  const double scale = std::max(1.0, here.chi2 / std::max(1, here.pixels - 4));
  const Eigen::Matrix4d covariance = here.information.ldlt().solve(Eigen::Matrix4d::Identity()) * scale;
  CentreFit fit{theta.segment<2>(1), covariance.block<2, 2>(1, 1), theta[3]};
  if (!fit.covariance.allFinite() || fit.covariance.diagonal().minCoeff() <= 0) return std::nullopt;
  return fit;
}

}  // namespace lodestar
