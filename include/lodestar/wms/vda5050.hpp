#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/measurement/battery.hpp"
#include "lodestar/base/measurement/pallet.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/wms/message_link.hpp"

namespace lodestar {

/// What the factsheet tells of the truck.
struct TruckData {
  std::string series = "unknown";
  double max_load_kg = 0;
  double speed_max_m_s = 0, acceleration_max_m_s2 = 0, deceleration_max_m_s2 = 0;
  double length_m = 0, width_m = 0, height_max_m = 0;
};

struct VdaParams {
  std::string interface_name = "uagv";
  std::string version = "2.1.0";  ///< its first number stands in the topics
  std::string manufacturer, serial;
  std::string map_id;          ///< the site's name
  double alert_limit_m = 0.5;  ///< a protection level so large makes the localization score 0
  double state_period_s = 5;   ///< of state at least; a change of loads, errors or driving is told at once
  double visualization_period_s = 0.5;
  TruckData truck;
};

/// The truck as its messages tell it.
struct TruckState {
  std::optional<PoseEstimate> pose;
  bool localized = false;                    ///< the pose is trusted
  double protection_level_m = 0;             ///< of the pose; told while it is trusted
  std::optional<bool> driving;               ///< or turning; empty: not known
  std::optional<std::vector<Pallet>> loads;  ///< on the fork; empty: not known
  bool outbox_full = false;
  std::optional<Battery> battery;  ///< empty: not known
};

enum class VdaConnection { kOnline, kOffline, kBroken };

/// The messages of VDA 5050 (interface for AGV communication, 2.1.0, section 6) that a truck with a driver can send: it
/// takes no orders, so order, nodes and edges are empty and operatingMode is MANUAL. Emergency stop and protective
/// fields belong to the truck's safety controller, which nothing here speaks to; they, and a battery or a motion that
/// is not known, are fillings that the schema requires, and `information` says so. Loads that are not known are left
/// out.
class Vda5050 {
 public:
  explicit Vda5050(const VdaParams& params) : params_(params) {}

  MqttMessage connection(VdaConnection state, Stamp now);
  MqttMessage state(const TruckState& truck, Stamp now);
  MqttMessage visualization(const TruckState& truck, Stamp now);
  MqttMessage factsheet(Stamp now);

 private:
  std::string topic(const std::string& name) const;

  VdaParams params_;
  std::map<std::string, std::uint64_t> header_ids_;  ///< each topic counts its own
};

}  // namespace lodestar
