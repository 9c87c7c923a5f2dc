#pragma once

#include <optional>
#include <vector>

#include "lodestar/wms/clock.hpp"
#include "lodestar/wms/vda5050.hpp"

namespace lodestar {

/// Says which VDA 5050 message goes when: connection and factsheet as a connection begins, state each period and when
/// loads, errors or driving change, visualization each period.
class Telemetry {
 public:
  explicit Telemetry(const VdaParams& params) : params_(params), messages_(params) {}

  void take_pose(const PoseEstimate& pose, Instant now);
  /// @param trusted the pose may be used for what it is
  void take_integrity(bool trusted, double protection_level_m);
  /// @param on_fork empty: nobody knows
  void take_loads(std::optional<std::vector<Pallet>> on_fork);
  void take_battery(const Battery& battery, Instant now);
  void set_outbox_full(bool full);

  /// What the broker shall say when the link breaks.
  MqttMessage will(Stamp now) { return messages_.connection(VdaConnection::kBroken, now); }
  std::vector<MqttMessage> at_connect(const ClockReading& now);
  std::vector<MqttMessage> due(const ClockReading& now);
  MqttMessage farewell(Stamp now) { return messages_.connection(VdaConnection::kOffline, now); }

 private:
  void refresh(Instant now);

  VdaParams params_;
  Vda5050 messages_;
  TruckState truck_;
  bool trusted_ = false, changed_ = false;
  std::optional<PoseEstimate> moved_from_;  ///< against which driving is judged
  Instant pose_heard_{}, battery_heard_{};
  std::optional<Instant> state_sent_, visualization_sent_;
};

}  // namespace lodestar
