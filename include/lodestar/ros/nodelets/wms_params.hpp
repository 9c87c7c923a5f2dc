#pragma once

#include "lodestar/base/site/site.hpp"
#include "lodestar/ros/params/param_reader.hpp"
#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/mqtt_link.hpp"

namespace lodestar {

struct WmsSetup {
  BridgeParams bridge;
  MqttParams mqtt;
};

/// The bridge's parameters (docs/nodes/wms_bridge.md); what is wrong with them joins the reader's faults.
WmsSetup read_wms_setup(ParamReader& params, const Site& site, const std::string& node);

}  // namespace lodestar
