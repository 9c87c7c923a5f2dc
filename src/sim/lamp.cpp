#include "lodestar/sim/lamp.hpp"

#include <cmath>
#include <stdexcept>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

constexpr double kTubePointPitch_m = 0.04;  // a fraction of a pixel at the ranges that a hall has

Modulation modulation(const LampParams& params, Random& random) {
  const double phase = random.uniform(-kPi, kPi);
  if (params.blink_hz > 0) return Modulation::square(params.blink_hz, phase, params.blink_duty);
  if (params.flicker_hz > 0) return Modulation::flicker({params.flicker_hz, params.flicker_depth, phase});
  return Modulation::steady();
}

}  // namespace

Lamp::Lamp(const LampParams& params, Random& random) : params_(params), modulation_(modulation(params, random)) {
  if (params.path_m.empty()) throw std::invalid_argument("a lamp needs a position");
}

Eigen::Vector3d Lamp::position(double time_s) const {
  const auto& path = params_.path_m;
  if (path.size() < 2 || params_.speed_m_s <= 0) return path.front();
  double length = 0;
  for (std::size_t i = 0; i < path.size(); ++i) length += (path[(i + 1) % path.size()] - path[i]).norm();
  double along = std::fmod(time_s * params_.speed_m_s, length);
  if (along < 0) along += length;
  for (std::size_t i = 0;; i = (i + 1) % path.size()) {
    const Eigen::Vector3d leg = path[(i + 1) % path.size()] - path[i];
    if (along <= leg.norm()) return path[i] + leg.normalized() * along;
    along -= leg.norm();
  }
}

void Lamp::shine(double begin_s, double end_s, std::vector<Glow>& out) const {
  const double electrons = params_.electrons_per_ms_1m * 1e3 * modulation_.integral(begin_s, end_s);
  Glow glow{position(0.5 * (begin_s + end_s)), electrons, params_.lambert_exponent, kPi, params_.size_m};
  if (!params_.tube_m) {
    out.push_back(glow);
    return;
  }
  const int points = 1 + static_cast<int>(std::ceil(params_.tube_m->norm() / kTubePointPitch_m));
  const Eigen::Vector3d begin = glow.position_map;
  glow.electrons_1m /= points;
  for (int i = 0; i < points; ++i) {
    glow.position_map = begin + *params_.tube_m * ((i + 0.5) / points);
    out.push_back(glow);
  }
}

}  // namespace lodestar::sim
