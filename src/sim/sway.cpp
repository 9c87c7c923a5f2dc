#include "lodestar/sim/sway.hpp"

#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

constexpr double kStep_s = 0.005;
constexpr double kSettle_s = 5;  // before the first instant asked for, at rest
constexpr double kMemory_s = 10;

}  // namespace

Sway::Sway(const SwayParams& params, Drive drive) : params_(params), drive_(std::move(drive)) {}

void Sway::restart(double time_s) {
  steps_.assign(1, {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()});
  begin_s_ = std::floor((time_s - kSettle_s) / kStep_s) * kStep_s;
}

/// One step of the classic Runge-Kutta method on angle'' = w^2 (rest - angle) - 2 d w angle'.
void Sway::advance() {
  const double w = 2 * kPi * params_.frequency_hz;
  const double t = begin_s_ + kStep_s * static_cast<double>(steps_.size() - 1);
  const auto rest = [&](double time) -> Eigen::Vector2d {
    const Eigen::Vector2d a = drive_(time);
    return params_.tilt_per_acceleration_rad * Eigen::Vector2d(a.y(), -a.x());  // outwards; nose up when speeding up
  };
  const auto derivative = [&](const Step& s, const Eigen::Vector2d& r) -> Step {
    return {s.rate, w * w * (r - s.angle) - 2 * params_.damping * w * s.rate};
  };
  const auto plus = [](const Step& s, const Step& d, double h) -> Step {
    return {s.angle + h * d.angle, s.rate + h * d.rate};
  };
  const Eigen::Vector2d r0 = rest(t), r1 = rest(t + 0.5 * kStep_s), r2 = rest(t + kStep_s);
  const Step s = steps_.back();
  const Step k1 = derivative(s, r0);
  const Step k2 = derivative(plus(s, k1, 0.5 * kStep_s), r1);
  const Step k3 = derivative(plus(s, k2, 0.5 * kStep_s), r1);
  const Step k4 = derivative(plus(s, k3, kStep_s), r2);
  steps_.push_back({s.angle + kStep_s / 6 * (k1.angle + 2 * k2.angle + 2 * k3.angle + k4.angle),
                    s.rate + kStep_s / 6 * (k1.rate + 2 * k2.rate + 2 * k3.rate + k4.rate)});
  if (static_cast<double>(steps_.size()) * kStep_s > kMemory_s) {
    steps_.pop_front();
    begin_s_ += kStep_s;
  }
}

Eigen::Vector2d Sway::at(double time_s) {
  if (params_.tilt_per_acceleration_rad == 0) return Eigen::Vector2d::Zero();
  if (steps_.empty() || time_s < begin_s_) restart(time_s);
  while (begin_s_ + kStep_s * static_cast<double>(steps_.size() - 1) <= time_s) advance();
  const double position = (time_s - begin_s_) / kStep_s;
  const auto i = std::min(static_cast<std::size_t>(position), steps_.size() - 2);
  const Step &a = steps_[i], &b = steps_[i + 1];
  const double x = position - static_cast<double>(i);  // cubic Hermite
  return a.angle * ((1 + 2 * x) * (1 - x) * (1 - x)) + b.angle * (x * x * (3 - 2 * x)) +
         kStep_s * (a.rate * (x * (1 - x) * (1 - x)) - b.rate * (x * x * (1 - x)));
}

}  // namespace lodestar::sim
