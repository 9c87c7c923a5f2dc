#pragma once

#include <cstdint>
#include <vector>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/sim/beacon_light.hpp"
#include "lodestar/sim/random.hpp"
#include "lodestar/sim/scene.hpp"

namespace lodestar::sim {

struct IrReceiverParams {
  RigidTransform T_base_ir = RigidTransform::Identity();  ///< true; the array looks along z
  int diodes = 8;                                         ///< the first up, the others around it
  double tilt_rad = 0.8726646;                            ///< of the others from the vertical: 50 deg
  double response_exponent = 1;
  double half_angle_rad = 1.3089969;  ///< 75 deg
  double level_1m = 6;                ///< straight on, ADC full scale = 1; clipped there
  double min_level = 0.01;            ///< the strongest diode needs this much for a frame to be heard
  double level_noise = 0.002;
  double bit_error_rate = 0;
  double junk_rate_hz = 0;  ///< frames of noise alone
  double stamp_noise_s = 20e-6;
  double sample_noise = 0.01;  ///< of each sample, where samples are handed over
};

/// The photodiode array and its decoder of bits (optical_link.md, sections 2 and 3).
class IrReceiver {
 public:
  IrReceiver(const IrReceiverParams& params, std::uint64_t seed);

  /// A beacon on air: where it really is, and what it says of itself.
  struct Sender {
    Eigen::Vector3d position_map = Eigen::Vector3d::Zero();
    Beacon announced;
  };

  /// What is heard in one slot. Two beacons at once: the one that is twice as strong as the others, else garbage.
  /// @param slot_begin_s s since the start; superframe 0 of the simulation begins at 0 s
  /// @return frames with the offset of each to the slot's begin
  struct Heard {
    double offset_s = 0;
    RawIrFrame frame;  ///< without a stamp
  };
  std::vector<Heard> listen(const std::vector<Sender>& senders, const Link& link, const BeaconLightParams& light,
                            const Scene& scene, const RigidTransform& T_map_base, int slot, std::uint32_t superframe);

  /// Every frame on air in one slot, without its stamp and before noise: what a receiver that samples gets to hear.
  std::vector<RawIrFrame> on_air(const std::vector<Sender>& senders, const Link& link, const BeaconLightParams& light,
                                 const Scene& scene, const RigidTransform& T_map_base, int slot,
                                 std::uint32_t superframe) const;

  /// Level of each diode, before noise, of a sender as strong as `light`.
  std::vector<float> levels(const Eigen::Vector3d& position_map, const BeaconLightParams& light,
                            const RigidTransform& T_map_base) const;

 private:
  void damage(RawIrFrame& frame);
  RawIrFrame junk();

  IrReceiverParams params_;
  Random random_;
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace lodestar::sim
