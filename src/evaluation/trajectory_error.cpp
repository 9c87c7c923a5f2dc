#include "lodestar/evaluation/trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kIntervalSlack = 0.1;  // a segment may be so much longer than asked for, relative

double yaw(const RigidTransform& T) { return roll_pitch_yaw(T.linear()).yaw_rad; }

double quantile(const std::vector<double>& sorted, double q) {
  const double position = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::optional<Eigen::Vector3d> normalized(const EstimateRow& row, const Eigen::Vector3d& error) {
  const Eigen::Vector3d sigma(row.sigma_x_m, row.sigma_y_m, row.sigma_yaw_rad);
  if (sigma.minCoeff() <= 0) return std::nullopt;
  return error.cwiseQuotient(sigma);
}

std::optional<TrajectoryError::Nees> nees(const std::vector<Eigen::Vector3d>& normalized_errors) {
  if (normalized_errors.empty()) return std::nullopt;
  double sum = 0;
  for (const Eigen::Vector3d& e : normalized_errors) sum += e.squaredNorm();
  TrajectoryError::Nees nees;
  nees.mean = sum / static_cast<double>(normalized_errors.size());
  nees.draws = independent_draws(normalized_errors);
  nees.band = nees_band(nees.draws, 3);
  return nees;
}

TrajectoryError::Sample compare(const EstimateRow& row, const RigidTransform& truth, double speed_m_s) {
  const Eigen::Vector3d difference = row.T_map_base.translation() - truth.translation();
  TrajectoryError::Sample sample;
  sample.stamp = row.stamp;
  sample.position_m = difference.head<2>().norm();
  sample.yaw_rad = wrap_angle(yaw(row.T_map_base) - yaw(truth));
  sample.z_m = difference.z();
  sample.speed_m_s = speed_m_s;
  sample.sigma_position_m = std::hypot(row.sigma_x_m, row.sigma_y_m);
  sample.sigma_yaw_rad = row.sigma_yaw_rad;
  sample.normalized = normalized(row, {difference.x(), difference.y(), sample.yaw_rad});
  return sample;
}

template <class Keep>
TrajectoryError::Part part(const std::vector<TrajectoryError::Sample>& samples, Keep&& keep) {
  std::vector<double> position, yaw, z;
  std::vector<Eigen::Vector3d> normalized_errors;
  for (const auto& sample : samples) {
    if (!keep(sample)) continue;
    position.push_back(sample.position_m);
    yaw.push_back(std::abs(sample.yaw_rad));
    z.push_back(std::abs(sample.z_m));
    if (sample.normalized) normalized_errors.push_back(*sample.normalized);
  }
  TrajectoryError::Part part;
  part.samples = position.size();
  part.position_m = error_statistics(std::move(position));
  part.yaw_rad = error_statistics(std::move(yaw));
  part.z_m = error_statistics(std::move(z));
  part.nees = nees(normalized_errors);
  return part;
}

double availability(const TruthTrack& truth, const std::vector<EstimateRow>& estimate, double stale_after_s) {
  if (estimate.empty()) return 0;
  std::size_t served = 0, total = 0, next = 0;
  for (const auto& sample : truth.samples()) {
    if (sample.stamp < estimate.front().stamp) continue;
    while (next < estimate.size() && estimate[next].stamp <= sample.stamp) ++next;
    ++total;
    served += seconds(sample.stamp - estimate[next - 1].stamp) <= stale_after_s;
  }
  return total > 0 ? static_cast<double>(served) / static_cast<double>(total) : 0.0;
}

/// x, y and yaw of b as seen from a.
Eigen::Vector3d planar_motion(const RigidTransform& a, const RigidTransform& b) {
  const Eigen::Rotation2Dd heading(yaw(a));
  Eigen::Vector3d motion;
  motion << heading.inverse() * (b.translation() - a.translation()).head<2>(), wrap_angle(yaw(b) - yaw(a));
  return motion;
}

TrajectoryError::Relative relative(const TruthTrack& truth, const std::vector<EstimateRow>& estimate,
                                   double interval_s) {
  std::vector<double> position, turn;
  std::size_t end = 0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    while (end < estimate.size() && seconds(estimate[end].stamp - estimate[i].stamp) < interval_s) ++end;
    if (end == estimate.size()) break;
    if (seconds(estimate[end].stamp - estimate[i].stamp) > interval_s * (1 + kIntervalSlack)) continue;
    const auto from = truth.at(estimate[i].stamp), to = truth.at(estimate[end].stamp);
    if (!from || !to) continue;
    const Eigen::Vector3d error =
        planar_motion(estimate[i].T_map_base, estimate[end].T_map_base) - planar_motion(*from, *to);
    position.push_back(error.head<2>().norm());
    turn.push_back(std::abs(wrap_angle(error.z())));
  }
  TrajectoryError::Relative relative;
  relative.samples = position.size();
  relative.interval_s = interval_s;
  relative.position_m = error_statistics(std::move(position));
  relative.yaw_rad = error_statistics(std::move(turn));
  return relative;
}

}  // namespace

ErrorStatistics error_statistics(std::vector<double> magnitudes) {
  if (magnitudes.empty()) return {kNaN, kNaN, kNaN, kNaN, kNaN};
  std::sort(magnitudes.begin(), magnitudes.end());
  const double n = static_cast<double>(magnitudes.size());
  double sum = 0, squares = 0;
  for (const double m : magnitudes) {
    sum += m;
    squares += m * m;
  }
  return {sum / n, std::sqrt(squares / n), quantile(magnitudes, 0.5), quantile(magnitudes, 0.95), magnitudes.back()};
}

TrajectoryError trajectory_error(const TruthTrack& truth, const std::vector<EstimateRow>& estimate,
                                 const TrajectoryErrorParams& params) {
  TrajectoryError error;
  for (const EstimateRow& row : estimate) {
    const auto pose = truth.at(row.stamp);
    const auto speed = truth.speed_m_s(row.stamp);
    if (pose && speed)
      error.samples.push_back(compare(row, *pose, *speed));
    else
      ++error.outside_truth;
  }
  const auto moving = [&](const TrajectoryError::Sample& s) { return s.speed_m_s > params.moving_above_m_s; };
  error.all = part(error.samples, [](const auto&) { return true; });
  error.standing = part(error.samples, [&](const auto& s) { return !moving(s); });
  error.moving = part(error.samples, moving);
  error.availability = availability(truth, estimate, params.stale_after_s);
  if (!estimate.empty() && !truth.empty()) error.time_to_first_fix_s = seconds(estimate.front().stamp - truth.begin());
  error.relative = relative(truth, estimate, params.relative_interval_s);
  return error;
}

}  // namespace lodestar
