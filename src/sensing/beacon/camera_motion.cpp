#include "lodestar/sensing/beacon/camera_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lodestar {

CameraMotion::CameraMotion(double buffer_s) : buffer_s_(buffer_s) {}

void CameraMotion::set_mount(const RigidTransform& T_base_camera) { T_base_camera_ = T_base_camera; }

void CameraMotion::add_imu(const ImuSample& sample) {
  append(angular_, sample.stamp, sample.angular_velocity_rad_s, buffer_s_);
}

void CameraMotion::add_odometry(const OdometrySample& sample) {
  append(linear_, sample.stamp, {sample.velocity_m_s.x(), sample.velocity_m_s.y(), 0}, buffer_s_);
  append(yaw_, sample.stamp, {0, 0, sample.yaw_rate_rad_s}, buffer_s_);
}

void CameraMotion::reset() {
  angular_.clear();
  yaw_.clear();
  linear_.clear();
}

void CameraMotion::append(Rates& rates, Stamp stamp, const Eigen::Vector3d& value, double buffer_s) {
  if (!value.allFinite() || (!rates.empty() && stamp <= rates.back().stamp)) return;
  rates.push_back({stamp, value});
  const auto recent = std::find_if(rates.begin(), rates.end(),
                                   [&](const Rate& rate) { return seconds(stamp - rate.stamp) <= buffer_s; });
  rates.erase(rates.begin(), recent);
}

bool CameraMotion::heard(const Rates& rates, Stamp now) {
  return !rates.empty() && seconds(now - rates.back().stamp) <= kSilent_s;
}

Eigen::Vector3d CameraMotion::rate_at(const Rates& rates, Stamp stamp) {
  if (rates.empty()) return Eigen::Vector3d::Zero();
  const auto after = std::lower_bound(rates.begin(), rates.end(), stamp,
                                      [](const Rate& rate, Stamp when) { return rate.stamp < when; });
  if (after == rates.begin()) return after->value;
  if (after == rates.end()) return rates.back().value;
  const auto before = std::prev(after);
  const double share = seconds(stamp - before->stamp) / seconds(after->stamp - before->stamp);
  return before->value + share * (after->value - before->value);
}

RigidTransform CameraMotion::T_base_before_base_after(Stamp before, Stamp after) const {
  const double interval_s = seconds(after - before);
  const Stamp middle = before + (after - before) / 2;
  const Eigen::Vector3d turn = rate_at(heard(angular_, after) ? angular_ : yaw_, middle) * interval_s;
  RigidTransform T = RigidTransform::Identity();
  T.linear() = so3_exp(turn);
  T.translation() = so3_exp(0.5 * turn) * rate_at(linear_, middle) * interval_s;
  return T;
}

RigidTransform CameraMotion::T_then_now(Stamp then, Stamp now) const {
  constexpr double kMaxStep_s = 0.02;
  if (!known(now)) return RigidTransform::Identity();
  const auto steps = std::max<std::int64_t>(1, std::llround(std::ceil(seconds(now - then) / kMaxStep_s)));
  RigidTransform T_then_base_now = RigidTransform::Identity();
  for (std::int64_t i = 0; i < steps; ++i) {
    T_then_base_now = T_then_base_now *
                      T_base_before_base_after(then + (now - then) * i / steps, then + (now - then) * (i + 1) / steps);
  }
  return T_base_camera_.inverse() * T_then_base_now * T_base_camera_;
}

}  // namespace lodestar
