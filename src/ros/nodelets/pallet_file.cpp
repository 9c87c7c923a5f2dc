#include "lodestar/ros/nodelets/pallet_file.hpp"

#include <ros/serialization.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "lodestar/PalletMemory.h"
#include "lodestar/base/measurement/pose_limits.hpp"
#include "lodestar/estimation/pallet/placing.hpp"
#include "lodestar/ros/convert/pallet.hpp"
#include "lodestar/ros/convert/transform.hpp"

namespace lodestar {
namespace {

constexpr int kRows[] = {0, 1, 2, 5};  // of a pose's covariance that a seat has

std::size_t cell(int i, int j) { return static_cast<std::size_t>(6 * kRows[i] + kRows[j]); }

geometry_msgs::PoseWithCovariance seat_message(const Seat& seat) {
  geometry_msgs::PoseWithCovariance message;
  message.pose = pose_message(seat.T_fork_pallet);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) message.covariance[cell(i, j)] = seat.covariance(i, j);
  return message;
}

std::optional<Seat> seat_from(const geometry_msgs::PoseWithCovariance& message) {
  const auto T_fork_pallet = transform_from(message.pose);
  if (!T_fork_pallet) return std::nullopt;
  Seat seat;
  seat.T_fork_pallet = *T_fork_pallet;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) seat.covariance(i, j) = message.covariance[cell(i, j)];
  const bool possible = is_possible(seat.T_fork_pallet, Eigen::Map<const Matrix6>(message.covariance.data()));
  return possible ? std::optional<Seat>(seat) : std::nullopt;
}

std::string checksum() { return ros::message_traits::MD5Sum<PalletMemory>::value(); }

std::string packed(const PalletMemory& memory) {
  std::string text(ros::serialization::serializationLength(memory), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&text[0]),
                                     static_cast<std::uint32_t>(text.size()));
  ros::serialization::serialize(stream, memory);
  return checksum() + text;
}

/// Throws when the text is shorter than it says.
std::optional<PalletMemory> unpacked(std::string text) {
  const std::size_t head = checksum().size();
  if (text.compare(0, head, checksum()) != 0) return std::nullopt;
  PalletMemory memory;
  ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(&text[0]) + head,
                                     static_cast<std::uint32_t>(text.size() - head));
  ros::serialization::deserialize(stream, memory);
  if (stream.getLength() > 0 || memory.carried.size() != memory.seats.size()) return std::nullopt;
  return memory;
}

geometry_msgs::PoseWithCovariance anywhere() {
  Pallet pallet;
  put_anywhere(pallet);
  return pallet_message(pallet).pose;
}

/// A pose that cannot be loses no pallet: a person is asked where it is.
Result<PalletChange, MessageDrop> kept_change(PalletEvent event, const std::string& map_frame) {
  if (!pallet_from(event.pallet)) {
    event.pallet.pose = anywhere();
    event.pallet.zone.clear();
    event.pallet.state = PalletEntry::UNCERTAIN;
  }
  return pallet_change_from(event, map_frame);
}

bool restore(PalletTracker& tracker, const PalletMemory& memory, const std::string& map_frame) {
  PalletTracker::Changes kept;
  for (const PalletEvent& event : memory.events) {
    const auto change = kept_change(event, map_frame);
    if (!change) return false;
    kept.push_back(*change);
  }
  std::vector<CarriedPallet> carried;
  for (std::size_t i = 0; i < memory.seats.size(); ++i) {
    auto seat = seat_from(memory.seats[i]);
    if (!seat) seat = seat_from(anywhere());
    const auto is_it = [&](const PalletChange& change) { return change.pallet.id == memory.carried[i]; };
    if (std::none_of(kept.begin(), kept.end(), is_it)) return false;
    carried.push_back({memory.carried[i], *seat});
  }
  tracker.restore(kept, carried);
  return true;
}

}  // namespace

void PalletFile::load_into(PalletTracker& tracker) {
  const auto understand = [&](const std::string& octets) {
    const auto memory = unpacked(octets);
    return memory && restore(tracker, *memory, map_frame_);
  };
  file_.load(understand, "no pallet is known");
}

void PalletFile::save(const PalletTracker& tracker) {
  if (!file_.kept()) return;
  PalletMemory memory;
  for (const PalletChange& change : tracker.ledger().kept())
    memory.events.push_back(pallet_event_message(change, map_frame_));
  for (const CarriedPallet& carried : tracker.carried()) {
    memory.carried.push_back(carried.id);
    memory.seats.push_back(seat_message(carried.seat));
  }
  file_.save(packed(memory));
}

}  // namespace lodestar
