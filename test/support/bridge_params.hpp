#pragma once

#include "lodestar/wms/bridge.hpp"

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
  return params;
}

}  // namespace lodestar::test
