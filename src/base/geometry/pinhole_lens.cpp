#include "pinhole_lens.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {
constexpr double kMaxTheta_rad = 1.5707;  ///< 89.995 deg; the pinhole image ends at 90 deg
}

PinholeLens::PinholeLens(const std::array<double, 8>& c)
    : k1_(c[0]), k2_(c[1]), p1_(c[2]), p2_(c[3]), k3_(c[4]), k4_(c[5]), k5_(c[6]), k6_(c[7]) {}

PinholeLens::Factor PinholeLens::factor(double s) const {
  const double N = 1 + s * (k1_ + s * (k2_ + s * k3_));
  const double D = 1 + s * (k4_ + s * (k5_ + s * k6_));
  const double dN = k1_ + s * (2 * k2_ + s * 3 * k3_);
  const double dD = k4_ + s * (2 * k5_ + s * 3 * k6_);
  return {N / D, (dN - N / D * dD) / D};
}

PinholeLens::Distorted PinholeLens::distort(const Eigen::Vector2d& point) const {
  const double x = point.x(), y = point.y(), s = point.squaredNorm();
  const Factor L = factor(s);
  Distorted out;
  out.point << x * L.value + 2 * p1_ * x * y + p2_ * (s + 2 * x * x),
      y * L.value + p1_ * (s + 2 * y * y) + 2 * p2_ * x * y;
  const double cross = 2 * L.slope * x * y + 2 * p1_ * x + 2 * p2_ * y;
  out.J << L.value + 2 * L.slope * x * x + 2 * p1_ * y + 6 * p2_ * x, cross,  //
      cross, L.value + 2 * L.slope * y * y + 6 * p1_ * y + 2 * p2_ * x;
  return out;
}

CurvePoint PinholeLens::distort_radius(double radius) const {
  const double s = radius * radius;
  const Factor L = factor(s);
  return {radius * L.value, L.value + 2 * s * L.slope};
}

// J is symmetric, hence the map is one-to-one on a disc throughout which J is positive definite. The radial part of J
// has the eigenvalues d(rL)/dr and L; those of the tangential part are above -6 |p| r.
double PinholeLens::margin(double radius) const {
  const double s = radius * radius;
  if (1 + s * (k4_ + s * (k5_ + s * k6_)) <= 0) return -1;
  const Factor L = factor(s);
  return std::min(L.value, L.value + 2 * s * L.slope) - 6 * std::hypot(p1_, p2_) * radius;
}

double PinholeLens::limit() const {
  return std::tan(rising_limit([this](double theta_rad) { return margin(std::tan(theta_rad)); }, kMaxTheta_rad));
}

std::optional<Eigen::Vector2d> PinholeLens::undistort(const Eigen::Vector2d& distorted, double limit) const {
  const double radius = distorted.norm();
  const double reach = distort_radius(limit).value;
  const bool tangential = p1_ != 0 || p2_ != 0;
  if (!(radius <= reach + 3 * std::hypot(p1_, p2_) * limit * limit)) return std::nullopt;
  const double start = invert_rising([this](double r) { return distort_radius(r); }, std::min(radius, reach), limit);
  Eigen::Vector2d point = radius > 0 ? Eigen::Vector2d(distorted * (start / radius)) : Eigen::Vector2d::Zero();
  if (!tangential) return point;

  // Newton in the plane. Steps are halved until they help; they may look a little beyond the disc on their way.
  Distorted at = distort(point);
  double error = (distorted - at.point).norm();
  for (int i = 0; i < 60 && error > 0; ++i) {
    Eigen::Vector2d step = at.J.inverse() * (distorted - at.point);
    bool better = false;
    for (int halving = 0; halving < 30 && !better; ++halving, step *= 0.5) {
      const Eigen::Vector2d next = point + step;
      if (!(next.norm() <= 1.01 * limit)) continue;
      const Distorted at_next = distort(next);
      const double next_error = (distorted - at_next.point).norm();
      if (!(next_error < error)) continue;
      point = next;
      at = at_next;
      error = next_error;
      better = true;
    }
    if (!better) break;
  }
  if (!(error <= 1e-12 * (1 + radius)) || point.norm() > limit) return std::nullopt;
  return point;
}

}  // namespace lodestar
