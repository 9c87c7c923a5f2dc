#include "equidistant_lens.hpp"

namespace lodestar {
namespace {
constexpr double kMaxTheta_rad = 3.14;
}

EquidistantLens::EquidistantLens(const std::array<double, 8>& k) : k1_(k[0]), k2_(k[1]), k3_(k[2]), k4_(k[3]) {}

CurvePoint EquidistantLens::distort(double theta_rad) const {
  const double s = theta_rad * theta_rad;
  return {theta_rad * (1 + s * (k1_ + s * (k2_ + s * (k3_ + s * k4_)))),
          1 + s * (3 * k1_ + s * (5 * k2_ + s * (7 * k3_ + s * 9 * k4_)))};
}

double EquidistantLens::limit_rad() const {
  return rising_limit([this](double theta_rad) { return distort(theta_rad).slope; }, kMaxTheta_rad);
}

}  // namespace lodestar
