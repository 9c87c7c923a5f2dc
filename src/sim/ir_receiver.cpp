#include "lodestar/sim/ir_receiver.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/measurement/diode_array.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar::sim {
namespace {

constexpr double kCapture = 2;  // so much stronger than the rest must a sender be to be heard through them

float clip(double level) { return static_cast<float>(std::clamp(level, 0.0, 1.0)); }

Announcement announcement(const Beacon& beacon, const Link& link, std::uint32_t superframe) {
  Announcement a;
  a.beacon = beacon.id;
  a.slot = static_cast<std::uint8_t>(beacon.slot);
  a.superframe = superframe;
  a.position_map = beacon.position_map;
  a.tones = beacon.tones;
  a.surveyed = true;
  a.is_signed = link.key.has_value();
  return a;
}

}  // namespace

IrReceiver::IrReceiver(const IrReceiverParams& params, std::uint64_t seed) : params_(params), random_(seed, "ir") {
  for (const auto& diode : DiodeArray::ring(params.diodes, params.tilt_rad).diodes)
    directions_.push_back(diode.direction_ir);
}

std::vector<float> IrReceiver::levels(const Eigen::Vector3d& position_map, const BeaconLightParams& light,
                                      const RigidTransform& T_map_base) const {
  const RigidTransform T_map_ir = T_map_base * params_.T_base_ir;
  const Eigen::Vector3d ray = T_map_ir.inverse() * position_map;
  const Glow glow{position_map, params_.level_1m, light.lambert_exponent, light.half_angle_rad, 0};
  const double strength = glow.electrons_towards(T_map_ir.translation()) / ray.squaredNorm();
  std::vector<float> levels;
  for (const Eigen::Vector3d& direction : directions_) {
    const double cosine = direction.dot(ray.normalized());
    const bool inside = std::acos(std::clamp(cosine, -1.0, 1.0)) <= params_.half_angle_rad && cosine > 0;
    levels.push_back(inside ? clip(strength * std::pow(cosine, params_.response_exponent)) : 0.f);
  }
  return levels;
}

void IrReceiver::damage(RawIrFrame& frame) {
  if (params_.bit_error_rate <= 0) return;
  for (auto& octet : frame.octets)
    for (int bit = 0; bit < 8; ++bit)
      if (random_.chance(params_.bit_error_rate)) octet = static_cast<std::uint8_t>(octet ^ (1u << bit));
}

RawIrFrame IrReceiver::junk() {
  RawIrFrame frame;
  for (auto& octet : frame.octets) octet = static_cast<std::uint8_t>(random_.index(256));
  for (std::size_t i = 0; i < directions_.size(); ++i) frame.levels.push_back(clip(random_.uniform(0, 0.1)));
  return frame;
}

std::vector<RawIrFrame> IrReceiver::on_air(const std::vector<Sender>& senders, const Link& link,
                                           const BeaconLightParams& light, const Scene& scene,
                                           const RigidTransform& T_map_base, int slot, std::uint32_t superframe) const {
  const Eigen::Vector3d eye = (T_map_base * params_.T_base_ir).translation();
  std::vector<RawIrFrame> out;
  for (const Sender& sender : senders) {
    if (!light.lit || sender.announced.slot != slot || scene.hidden(sender.position_map, eye)) continue;
    RawIrFrame frame;
    frame.octets = encode_ir_frame(announcement(sender.announced, link, superframe), link);
    frame.levels = levels(sender.position_map, light, T_map_base);
    out.push_back(std::move(frame));
  }
  return out;
}

std::vector<IrReceiver::Heard> IrReceiver::listen(const std::vector<Sender>& senders, const Link& link,
                                                  const BeaconLightParams& light, const Scene& scene,
                                                  const RigidTransform& T_map_base, int slot,
                                                  std::uint32_t superframe) {
  const Eigen::Vector3d eye = (T_map_base * params_.T_base_ir).translation();
  const Sender* strongest = nullptr;
  std::vector<float> strongest_levels, sum(directions_.size(), 0.f);
  double best = 0, others = 0;
  for (const Sender& sender : senders) {
    if (!light.lit || sender.announced.slot != slot || scene.hidden(sender.position_map, eye)) continue;
    const std::vector<float> heard = levels(sender.position_map, light, T_map_base);
    const double level = *std::max_element(heard.begin(), heard.end());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += heard[i];
    if (level > best) {
      others += best;
      best = level;
      strongest = &sender;
    } else {
      others += level;
    }
  }

  std::vector<Heard> out;
  if (strongest && best >= params_.min_level) {
    Heard heard;
    heard.offset_s = std::abs(random_.normal(params_.stamp_noise_s));
    if (best >= kCapture * others) {
      heard.frame.octets = encode_ir_frame(announcement(strongest->announced, link, superframe), link);
      damage(heard.frame);
    } else {
      heard.frame = junk();
    }
    heard.frame.levels.clear();
    for (const float level : sum) heard.frame.levels.push_back(clip(level + random_.normal(params_.level_noise)));
    out.push_back(std::move(heard));
  }
  if (random_.chance(params_.junk_rate_hz * link.slot_s)) out.push_back({random_.uniform(0, link.slot_s), junk()});
  return out;
}

}  // namespace lodestar::sim
