#include "lodestar/wms/telemetry.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr Duration kPoseStale = std::chrono::seconds(2), kBatteryStale = std::chrono::minutes(1);
constexpr Duration kJudgeMotion = std::chrono::milliseconds(300);
constexpr double kDriving_m_s = 0.05, kTurning_rad_s = 0.05;

bool due_again(const std::optional<Instant>& sent, Instant now, double period_s) {
  return !sent || now - *sent >= from_seconds(period_s);
}

bool same_loads(const std::optional<std::vector<Pallet>>& a, const std::optional<std::vector<Pallet>>& b) {
  const auto same = [](const Pallet& p, const Pallet& q) { return p.id == q.id && p.sscc == q.sscc; };
  return a.has_value() == b.has_value() && (!a || std::equal(a->begin(), a->end(), b->begin(), b->end(), same));
}

}  // namespace

void Telemetry::take_pose(const PoseEstimate& pose, Instant now) {
  truck_.pose = pose;
  pose_heard_ = now;
  if (!moved_from_ || pose.stamp < moved_from_->stamp) moved_from_ = pose;
  const Duration since = pose.stamp - moved_from_->stamp;
  if (since < kJudgeMotion) return;
  const RigidTransform T_from_base = moved_from_->T_map_base.inverse() * pose.T_map_base;
  const double distance_m = T_from_base.translation().head<2>().norm();
  const double angle_rad = std::abs(so3_log(T_from_base.linear()).z());
  const bool driving = distance_m > kDriving_m_s * seconds(since) || angle_rad > kTurning_rad_s * seconds(since);
  changed_ |= driving != truck_.driving;
  truck_.driving = driving;
  moved_from_ = pose;
}

void Telemetry::take_integrity(bool trusted, double protection_level_m) {
  trusted_ = trusted;
  truck_.protection_level_m = protection_level_m;
}

void Telemetry::take_loads(std::optional<std::vector<Pallet>> on_fork) {
  changed_ |= !same_loads(on_fork, truck_.loads);
  truck_.loads = std::move(on_fork);
}

void Telemetry::take_battery(const Battery& battery, Instant now) {
  changed_ |= !truck_.battery || truck_.battery->charging != battery.charging;
  truck_.battery = battery;
  battery_heard_ = now;
}

void Telemetry::set_outbox_full(bool full) {
  changed_ |= full != truck_.outbox_full;
  truck_.outbox_full = full;
}

/// A pose that nobody renews is not trusted, whatever was said of it, and tells no motion; a charge is then not known.
void Telemetry::refresh(Instant now) {
  const bool renewed = truck_.pose && now - pose_heard_ < kPoseStale, localized = trusted_ && renewed;
  changed_ |= localized != truck_.localized;
  truck_.localized = localized;
  if (!renewed) {
    changed_ |= truck_.driving.has_value();
    truck_.driving.reset();
    moved_from_.reset();
  }
  if (now - battery_heard_ >= kBatteryStale) truck_.battery.reset();
}

std::vector<MqttMessage> Telemetry::at_connect(const ClockReading& now) {
  refresh(now.monotonic);
  state_sent_.reset();
  visualization_sent_.reset();
  return {messages_.connection(VdaConnection::kOnline, now.wall), messages_.factsheet(now.wall)};
}

std::vector<MqttMessage> Telemetry::due(const ClockReading& now) {
  refresh(now.monotonic);
  std::vector<MqttMessage> out;
  if (changed_ || due_again(state_sent_, now.monotonic, params_.state_period_s)) {
    out.push_back(messages_.state(truck_, now.wall));
    state_sent_ = now.monotonic;
    changed_ = false;
  }
  if (due_again(visualization_sent_, now.monotonic, params_.visualization_period_s)) {
    out.push_back(messages_.visualization(truck_, now.wall));
    visualization_sent_ = now.monotonic;
  }
  return out;
}

}  // namespace lodestar
