#include "lodestar/evaluation/nees_band.hpp"

#include <algorithm>

#include "lodestar/base/common/chi_square.hpp"

namespace lodestar {
namespace {

constexpr double kWindow = 5.0;  ///< correlation times that the sum goes over

/// tau of one component, in samples.
double correlation_time(const std::vector<Eigen::Vector3d>& series, Eigen::Index axis) {
  const std::size_t n = series.size();
  const auto mean_product = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = lag; i < n; ++i) sum += series[i][axis] * series[i - lag][axis];
    return sum / static_cast<double>(n - lag);
  };
  const double variance = mean_product(0);
  double tau = 1;
  for (std::size_t lag = 1; lag < n && static_cast<double>(lag) < kWindow * tau; ++lag) {
    const double correlation = variance > 0 ? std::clamp(mean_product(lag) / variance, -1.0, 1.0) : 1.0;
    tau += 2.0 * (1.0 - static_cast<double>(lag) / static_cast<double>(n)) * correlation * correlation;
  }
  return tau;
}

}  // namespace

NeesBand nees_band(double draws, int dof) {
  const double all = draws * dof;
  return {chi_square_quantile(0.025, all) / draws, chi_square_quantile(0.975, all) / draws};
}

double independent_draws(const std::vector<Eigen::Vector3d>& normalized_errors) {
  double tau = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) tau += correlation_time(normalized_errors, axis) / 3;
  return std::max(1.0, static_cast<double>(normalized_errors.size()) / tau);
}

}  // namespace lodestar
