#include <regex>

#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/gs1.hpp"

namespace lodestar {
namespace {

constexpr std::size_t kLongestUri = 1000;

/// By RFC 3986, appendix A, but for hosts in brackets.
bool valid_uri(const std::string& text) {
  const std::string character = "[A-Za-z0-9._~!$&'()*+,;=-]|%[0-9A-Fa-f]{2}";
  const std::string in_path = "(?:" + character + "|[:@])*", in_query = "(?:" + character + "|[:@/?])*";
  const std::string authority =
      "//(?:(?:" + character + "|:)*@)?(?:" + character + ")*(?::[0-9]*)?(?:/" + in_path + ")*";
  const std::string path = "(?!//)(?:" + character + "|[:@/])*";
  static const std::regex uri("[A-Za-z][A-Za-z0-9+.-]*:(?:" + authority + "|" + path + ")(?:\\?" + in_query + ")?(?:#" +
                              in_query + ")?");
  return text.size() <= kLongestUri && std::regex_match(text, uri);
}

/// Its head stands in topics.
bool valid_version(const std::string& text) {
  static const std::regex version("[0-9]+(\\.[0-9]+)*");
  return text.size() <= 64 && std::regex_match(text, version);
}

/// By VDA 5050, 6.3.
bool valid_serial(const std::string& text) {
  static const std::regex serial("[A-Za-z0-9_.:-]{1,64}");
  return std::regex_match(text, serial);
}

}  // namespace

const char* name(BridgeDrop reason) {
  switch (reason) {
    case BridgeDrop::kPalletId:
      return "pallet_id";
    case BridgeDrop::kLife:
      return "life";
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
      fault(key + ": is '" + value + "', must be 1 to 64 characters without / + # $ to stand in a topic");
  };
  level("manufacturer", params.vda.manufacturer);
  level("vda_interface", params.vda.interface_name);
  if (!valid_serial(params.vda.serial))
    fault("serial: is '" + params.vda.serial + "', must be 1 to 64 of A-Z a-z 0-9 _ . : - to stand in a topic");
  if (!valid_version(params.vda.version))
    fault("vda_version: is '" + params.vda.version + "', must be numbers with dots between, such as 2.1.0");
  if (!valid_giai(params.epcis.giai))
    fault("giai: is '" + params.epcis.giai + "', must be 1 to 30 characters of GS1's set 82");
  if (!valid_gln(params.epcis.gln))
    fault("gln: is '" + params.epcis.gln + "', must be 13 digits, the last of them the check digit");
  if (!valid_uri(params.epcis.coordinate_reference_system))
    fault("coordinate_reference_system: is '" + params.epcis.coordinate_reference_system +
          "', must be a URI such as https://example.org/crs/hall-12 (RFC 3986: no blanks, other characters as %20)");
  if (params.store.path.empty()) fault("store: is missing: give the path of a file");
  if (params.brokers == 0) fault("brokers: is empty: give at least one, such as tcp://wms.example:1883");
  return faults;
}

}  // namespace lodestar
