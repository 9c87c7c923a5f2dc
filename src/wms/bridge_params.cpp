#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/gs1.hpp"

namespace lodestar {

const char* name(BridgeDrop reason) {
  switch (reason) {
    case BridgeDrop::kPalletId:
      return "pallet_id";
    case BridgeDrop::kLabel:
      return "label";
    case BridgeDrop::kKnown:
      return "known";
    case BridgeDrop::kLost:
      return "lost";
    case BridgeDrop::kCount:
      break;
  }
  return "";
}

Faults check(const BridgeParams& params, const std::string& file) {
  Faults faults;
  const auto fault = [&](const std::string& what) { faults.push_back({file, 0, what}); };
  const auto level = [&](const std::string& key, const std::string& value) {
    if (!valid_topic_level(value))
      fault(key + ": is '" + value + "', must be 1 to 64 characters without / + # to stand in a topic");
  };
  level("manufacturer", params.vda.manufacturer);
  level("serial", params.vda.serial);
  level("vda_interface", params.vda.interface_name);
  if (!valid_giai(params.epcis.giai))
    fault("giai: is '" + params.epcis.giai + "', must be 1 to 30 characters of GS1's set 82");
  if (!valid_gln(params.epcis.gln))
    fault("gln: is '" + params.epcis.gln + "', must be 13 digits, the last of them the check digit");
  if (params.epcis.coordinate_reference_system.find(':') == std::string::npos)
    fault("coordinate_reference_system: is '" + params.epcis.coordinate_reference_system + "', must be a URI");
  if (params.store.path.empty()) fault("store: is missing: give the path of a file");
  if (params.brokers == 0) fault("brokers: is empty: give at least one, such as tcp://wms.example:1883");
  return faults;
}

}  // namespace lodestar
