#include "lodestar/ros/convert/pallet.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestar/base/measurement/pose_limits.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"

namespace lodestar {
namespace {

using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

constexpr double kLowestFork_m = -1, kHighestFork_m = 30;  // trucks lift to 18 m

}  // namespace

Result<LoadSample, MessageDrop> load_sample_from(const LoadState& message) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  if (!std::isfinite(message.fork_height_m)) return MessageDrop::kNotFinite;
  if (message.fork_height_m < kLowestFork_m || message.fork_height_m > kHighestFork_m) return MessageDrop::kRange;
  return LoadSample{stamp_from(message.header.stamp), message.fork_height_m, message.load_present != 0,
                    message.load_id};
}

LoadState load_message(const LoadSample& sample, const std::string& fork_frame) {
  LoadState message;
  message.header.stamp = ros_time(sample.stamp);
  message.header.frame_id = fork_frame;
  message.fork_height_m = sample.fork_height_m;
  message.load_present = sample.load_present;
  message.load_id = sample.label;
  return message;
}

Result<Pallet, MessageDrop> pallet_from(const PalletEntry& message) {
  if (message.state < PalletEntry::ON_FORK || message.state > PalletEntry::UNCERTAIN) return MessageDrop::kRange;
  const auto T_map_pallet = transform_from(message.pose.pose);
  if (!T_map_pallet) return T_map_pallet.error();
  Pallet pallet;
  pallet.id = message.id;
  pallet.sscc = message.sscc;
  pallet.type = message.type;
  pallet.state = static_cast<PalletState>(message.state);
  pallet.changed = stamp_from(message.changed);
  pallet.T_map_pallet = *T_map_pallet;
  pallet.covariance = Eigen::Map<const RowMajor6>(message.pose.covariance.data());
  if (!pallet.covariance.allFinite()) return MessageDrop::kNotFinite;
  if (!is_possible(pallet.T_map_pallet, pallet.covariance)) return MessageDrop::kRange;
  pallet.level = message.level;
  pallet.zone = message.zone;
  pallet.coasting = message.coasting != 0;
  return pallet;
}

PalletEntry pallet_message(const Pallet& pallet) {
  PalletEntry message;
  message.id = pallet.id;
  message.sscc = pallet.sscc;
  message.type = pallet.type;
  message.state = static_cast<std::uint8_t>(pallet.state);
  message.changed = ros_time(pallet.changed);
  message.pose.pose = pose_message(pallet.T_map_pallet);
  Eigen::Map<RowMajor6>(message.pose.covariance.data()) = pallet.covariance;
  message.level = static_cast<std::uint8_t>(
      std::clamp(pallet.level, 0, static_cast<int>(std::numeric_limits<std::uint8_t>::max())));
  message.zone = pallet.zone;
  message.coasting = pallet.coasting;
  return message;
}

PalletArray pallet_array_message(const std::vector<Pallet>& pallets, Stamp stamp, const std::string& map_frame) {
  PalletArray message;
  message.header.stamp = ros_time(stamp);
  message.header.frame_id = map_frame;
  for (const Pallet& pallet : pallets) message.pallets.push_back(pallet_message(pallet));
  return message;
}

Result<PalletChange, MessageDrop> pallet_change_from(const PalletEvent& message, const std::string& map_frame) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  if (message.header.frame_id != map_frame) return MessageDrop::kFrame;
  if (message.kind < PalletEvent::PICK || message.kind > PalletEvent::CORRECTION) return MessageDrop::kRange;
  auto pallet = pallet_from(message.pallet);
  if (!pallet) return pallet.error();
  PalletChange change;
  change.sequence = message.sequence;
  change.life = message.life;
  change.stamp = stamp_from(message.header.stamp);
  change.kind = static_cast<PalletChangeKind>(message.kind);
  change.pallet = std::move(pallet).value();
  change.candidates = message.candidates;
  change.reason = message.reason;
  change.corrects = message.corrects;
  return change;
}

PalletEvent pallet_event_message(const PalletChange& change, const std::string& map_frame) {
  PalletEvent message;
  message.header.stamp = ros_time(change.stamp);
  message.header.frame_id = map_frame;
  message.sequence = change.sequence;
  message.life = change.life;
  message.kind = static_cast<std::uint8_t>(change.kind);
  message.pallet = pallet_message(change.pallet);
  message.candidates = change.candidates;
  message.reason = change.reason;
  message.corrects = change.corrects;
  return message;
}

}  // namespace lodestar
