#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/mqtt_link.hpp"

namespace lodestar::test {

inline BridgeParams bridge_params(const std::string& store) {
  BridgeParams params;
  params.store.path = store;
  params.store.boot = "boot-1";
  params.store.ballast_bytes = 65536;
  params.epcis = {"4012345TRUCK7", "4012345000115", "https://hall-12.example/crs/map"};
  params.vda.manufacturer = "lodestar";
  params.vda.serial = "truck7";
  params.vda.map_id = "hall-12";
  params.back_off = {from_seconds(0.1), from_seconds(1)};
  params.outbox.resend_after = from_seconds(0.5);  // a site that comes later than the bridge missed the first window
  return params;
}

inline MqttParams mqtt(const std::string& client, std::vector<std::string> brokers) {
  MqttParams params;
  params.client_id = client;
  params.brokers = std::move(brokers);
  return params;
}

}  // namespace lodestar::test
