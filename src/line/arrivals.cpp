#include "lodestar/line/arrivals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kLeastHeight_m = 3;    // of a beacon above the receiver: what driving turns a bearing by
constexpr double kUnknown_rad_s = 0.5;  // by which bearings turn when no wheels say it
constexpr double kOdometryGood_s = 0.5;
constexpr double kLeastDistance_m = 0.5;
constexpr double kModelSigma_rad = 0.05;  // light that comes by way of a wall
constexpr double kAtOnce_s = 0.006;       // a frame sent on by a wire comes no later; less than a quarter of a slot
constexpr double kGate_chi2 = 27.6;       // of two degrees of freedom: one true frame in a million is beyond it

double turning_rad_s(const OdometrySample& odometry) {
  return std::abs(odometry.yaw_rate_rad_s) + odometry.velocity_m_s.norm() / kLeastHeight_m;
}

}  // namespace

Arrivals::Arrivals(const DiodeArray& array, Duration max_age) : array_(array), max_age_(max_age) {}

double Arrivals::moved_rad(Stamp stamp) const {
  const double ahead_s = seconds(stamp - odometry_->stamp);
  const double wheels_s = std::min(ahead_s, kOdometryGood_s);
  return moved_rad_ + turning_rad_s(*odometry_) * wheels_s + kUnknown_rad_s * (ahead_s - wheels_s);
}

double Arrivals::turned_rad(const Heard& heard, Stamp now) const {
  if (odometry_ && heard.moved_rad) return moved_rad(now) - *heard.moved_rad;
  return kUnknown_rad_s * seconds(now - heard.arrival.stamp);
}

void Arrivals::add_odometry(const OdometrySample& sample) {
  if (odometry_ && sample.stamp > odometry_->stamp) moved_rad_ = moved_rad(sample.stamp);
  if (!odometry_ || sample.stamp > odometry_->stamp) odometry_ = sample;
}

bool Arrivals::plausible(const Announcement& announcement, const PoseEstimate& pose) const {
  if (!T_base_ir_) return true;
  const auto direction = arrival_direction(announcement.levels, array_);
  if (!direction) return true;
  const Eigen::Matrix3d R_map_base = pose.T_map_base.linear();
  const Eigen::Vector3d ray_map = announcement.position_map - pose.T_map_base * T_base_ir_->translation();
  const double distance_m = std::max(ray_map.norm(), kLeastDistance_m);
  const Eigen::Vector3d u = ray_map / distance_m;
  const Eigen::Matrix3d R_map_ir = R_map_base * T_base_ir_->linear();
  Eigen::Matrix<double, 3, 6> J;  // of the direction in map by the pose; its rotation turns what the diodes say
  J << -Eigen::Matrix3d::Identity() / distance_m, skew(u);
  const Eigen::Vector3d off = R_map_ir * direction->direction_ir - u;
  const Eigen::Matrix3d S = R_map_ir * direction->covariance * R_map_ir.transpose() +
                            J * pose.covariance * J.transpose() + u * u.transpose() +
                            kModelSigma_rad * kModelSigma_rad * Eigen::Matrix3d::Identity();
  return off.dot(S.llt().solve(off)) < kGate_chi2;
}

void Arrivals::add(const Announcement& announcement) {
  if (!T_base_ir_) return;
  const auto direction = arrival_direction(announcement.levels, array_);
  if (!direction) return drops_.add(direction.error());
  heard_[announcement.beacon] = {arrival(announcement, *direction),
                                 odometry_ ? std::optional<double>(moved_rad(announcement.stamp)) : std::nullopt};
}

Arrival Arrivals::arrival(const Announcement& announcement, const ArrivalDirection& direction) const {
  const Eigen::Matrix3d R = T_base_ir_->linear();
  return {announcement.beacon, announcement.stamp, R * direction.direction_ir,
          R * direction.covariance * R.transpose()};
}

bool Arrivals::add_again(const Announcement& announcement) {
  const auto known = heard_.find(announcement.beacon);
  if (known == heard_.end()) return false;
  const Arrival& first = known->second.arrival;
  if (std::abs(seconds(announcement.stamp - first.stamp)) > kAtOnce_s) return false;
  const auto direction = arrival_direction(announcement.levels, array_);
  if (!direction) return false;
  const Arrival second = arrival(announcement, *direction);
  const Eigen::Vector3d off = second.direction_base - first.direction_base, u = first.direction_base;
  const Eigen::Matrix3d S = first.covariance + second.covariance + u * u.transpose() +
                            2 * kModelSigma_rad * kModelSigma_rad * Eigen::Matrix3d::Identity();
  if (off.dot(S.llt().solve(off)) < kGate_chi2) return false;
  doubt(announcement.beacon, announcement.stamp);
  return true;
}

std::vector<Arrival> Arrivals::recent(Stamp now) const {
  std::vector<Arrival> out;
  for (const auto& [id, heard] : heard_) {
    const auto doubted = doubted_.find(id);
    if (!within_max_age(heard.arrival.stamp, now)) continue;
    if (doubted != doubted_.end() && within_max_age(doubted->second, now)) continue;
    out.push_back(heard.arrival);
    Arrival& arrival = out.back();
    const double turned = turned_rad(heard, now);
    const Eigen::Vector3d& u = arrival.direction_base;
    arrival.covariance += turned * turned * (Eigen::Matrix3d::Identity() - u * u.transpose());
  }
  return out;
}

void Arrivals::reset() {
  heard_.clear();
  doubted_.clear();
  odometry_.reset();
  moved_rad_ = 0;
}

}  // namespace lodestar
