#include "lodestar/wms/vda5050.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/wms/gs1.hpp"
#include "lodestar/wms/iso_time.hpp"

namespace lodestar {
namespace {

using nlohmann::json;

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json header(const VdaParams& params, std::uint64_t& id, Stamp now) {
  return {{"headerId", id++},
          {"timestamp", iso_time(now)},
          {"version", params.version},
          {"manufacturer", params.manufacturer},
          {"serialNumber", params.serial}};
}

const char* name(VdaConnection state) {
  switch (state) {
    case VdaConnection::kOnline:
      return "ONLINE";
    case VdaConnection::kOffline:
      return "OFFLINE";
    case VdaConnection::kBroken:
      return "CONNECTIONBROKEN";
  }
  return "";
}

json position(const VdaParams& params, const TruckState& truck) {
  const auto& T_map_base = truck.pose->T_map_base;
  const double score = 1.0 - std::min(1.0, truck.protection_level_m / params.alert_limit_m);
  json out = {{"x", T_map_base.translation().x()},
              {"y", T_map_base.translation().y()},
              {"theta", roll_pitch_yaw(T_map_base.linear()).yaw_rad},
              {"mapId", params.map_id},
              {"positionInitialized", truck.localized},
              {"localizationScore", truck.localized ? score : 0.0}};
  if (truck.localized) out["deviationRange"] = truck.protection_level_m;
  return out;
}

json load(const Pallet& pallet) {
  return {{"loadId", pallet.sscc.empty() ? uuid_uri(pallet.id) : pallet.sscc},
          {"loadType", pallet.type},
          {"loadPosition", "fork"}};
}

json loads(const std::vector<Pallet>& on_fork) {
  json out = json::array();
  for (const Pallet& pallet : on_fork) out.push_back(load(pallet));
  return out;
}

json error(const char* type, const char* description) {
  return {{"errorType", type}, {"errorDescription", description}, {"errorLevel", "WARNING"}};
}

json errors(const TruckState& truck) {
  json out = json::array();
  if (truck.outbox_full) out.push_back(error("outboxFull", "pallet events wait in memory: the store has no room"));
  if (!truck.localized) out.push_back(error("localizationLost", "the pose cannot be trusted, or there is none"));
  return out;
}

json battery(const std::optional<Battery>& known) {
  if (!known) return {{"batteryCharge", 0.0}, {"charging", false}};
  json out = {{"batteryCharge", 100 * known->charge}, {"charging", known->charging}};
  if (known->voltage_v) out["batteryVoltage"] = *known->voltage_v;
  return out;
}

/// The schema requires values even for what nobody measures.
json filling(const char* field) {
  return {{"infoType", "notMeasured"},
          {"infoLevel", "INFO"},
          {"infoDescription", std::string(field) + " is a filling: it is not known here"}};
}

}  // namespace

std::string Vda5050::topic(const std::string& name) const {
  const std::string major = params_.version.substr(0, params_.version.find('.'));
  return params_.interface_name + "/v" + major + "/" + params_.manufacturer + "/" + params_.serial + "/" + name;
}

MqttMessage Vda5050::connection(VdaConnection state, Stamp now) {
  json message = header(params_, header_ids_["connection"], now);
  message["connectionState"] = name(state);
  return {topic("connection"), text_of(message), 1, true};
}

MqttMessage Vda5050::state(const TruckState& truck, Stamp now) {
  json message = header(params_, header_ids_["state"], now);
  message.update({{"orderId", ""},
                  {"orderUpdateId", 0},
                  {"lastNodeId", ""},
                  {"lastNodeSequenceId", 0},
                  {"nodeStates", json::array()},
                  {"edgeStates", json::array()},
                  {"actionStates", json::array()},
                  {"driving", truck.driving.value_or(false)},
                  {"operatingMode", "MANUAL"},
                  {"batteryState", battery(truck.battery)},
                  {"safetyState", {{"eStop", "NONE"}, {"fieldViolation", false}}},
                  {"errors", errors(truck)},
                  {"information", json::array({filling("safetyState")})}});
  if (!truck.battery) message["information"].push_back(filling("batteryState"));
  if (!truck.driving) message["information"].push_back(filling("driving"));
  if (truck.loads) message["loads"] = loads(*truck.loads);
  if (truck.pose) message["agvPosition"] = position(params_, truck);
  return {topic("state"), text_of(message), 0, false};
}

MqttMessage Vda5050::visualization(const TruckState& truck, Stamp now) {
  json message = header(params_, header_ids_["visualization"], now);
  if (truck.pose) message["agvPosition"] = position(params_, truck);
  return {topic("visualization"), text_of(message), 0, false};
}

MqttMessage Vda5050::factsheet(Stamp now) {
  const TruckData& truck = params_.truck;
  json message = header(params_, header_ids_["factsheet"], now);
  message["typeSpecification"] = {
      {"seriesName", truck.series},       {"agvKinematic", "THREEWHEEL"},       {"agvClass", "FORKLIFT"},
      {"maxLoadMass", truck.max_load_kg}, {"localizationTypes", {"REFLECTOR"}}, {"navigationTypes", json::array()}};
  // speedMin is the slowest speed that is held steadily, not that of driving backwards; a driver creeps as he likes.
  message["physicalParameters"] = {{"speedMin", 0.0},
                                   {"speedMax", truck.speed_max_m_s},
                                   {"accelerationMax", truck.acceleration_max_m_s2},
                                   {"decelerationMax", truck.deceleration_max_m_s2},
                                   {"heightMax", truck.height_max_m},
                                   {"width", truck.width_m},
                                   {"length", truck.length_m}};
  message["protocolLimits"] = {{"maxStringLens", json::object()},
                               {"maxArrayLens", json::object()},
                               {"timing",
                                {{"minOrderInterval", 0.0},
                                 {"minStateInterval", 0.0},
                                 {"defaultStateInterval", params_.state_period_s},
                                 {"visualizationInterval", params_.visualization_period_s}}}};
  message["protocolFeatures"] = {{"optionalParameters", json::array()}, {"agvActions", json::array()}};
  message["agvGeometry"] = json::object();
  message["loadSpecification"] = {{"loadPositions", {"fork"}}};
  return {topic("factsheet"), text_of(message), 0, true};
}

}  // namespace lodestar
