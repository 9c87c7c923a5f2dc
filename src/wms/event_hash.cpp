#include "lodestar/wms/event_hash.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

namespace lodestar {
namespace {

using nlohmann::json;
using Names = std::vector<const char*>;

const std::string kCbv = "https://ref.gs1.org/cbv/";
const std::string kWebVocabulary = "https://ref.gs1.org/voc/";

// Sequences 2 to 22 of the canonical property order; sensor elements (23) and extensions (25) follow.
const Names kEvent = {"eventTime",
                      "eventTimeZoneOffset",
                      "epcList",
                      "parentID",
                      "inputEPCList",
                      "childEPCs",
                      "quantityList",
                      "childQuantityList",
                      "inputQuantityList",
                      "outputEPCList",
                      "outputQuantityList",
                      "action",
                      "transformationID",
                      "bizStep",
                      "disposition",
                      "readPoint",
                      "bizLocation",
                      "bizTransactionList",
                      "sourceList",
                      "destinationList"};
const Names kQuantityElement = {"epcClass", "quantity", "uom"};
const Names kSensorMetadata = {
    "time", "startTime", "endTime", "deviceID", "deviceMetadata", "rawData", "dataProcessingMethod", "bizRules"};
const Names kSensorReport = {"type",
                             "exception",
                             "deviceID",
                             "deviceMetadata",
                             "rawData",
                             "dataProcessingMethod",
                             "time",
                             "microorganism",
                             "chemicalSubstance",
                             "value",
                             "component",
                             "stringValue",
                             "booleanValue",
                             "hexBinaryValue",
                             "uriValue",
                             "minValue",
                             "maxValue",
                             "meanValue",
                             "sDev",
                             "percRank",
                             "percValue",
                             "uom",
                             "coordinateReferenceSystem"};
// The type stands before what it tells of, as in every published example.
const Names kBizTransaction = {"type", "bizTransaction"}, kSource = {"type", "source"},
            kDestination = {"type", "destination"};

bool starts_with(const std::string& text, const std::string& head) { return text.compare(0, head.size(), head) == 0; }

/// Bare words of the standard vocabulary, and CURIEs, as full URIs.
std::string vocabulary(const std::string& word, const std::string& base) {
  if (starts_with(word, "cbv:")) return kCbv + word.substr(4);
  if (starts_with(word, "gs1:")) return kWebVocabulary + word.substr(4);
  return word.find(':') == std::string::npos ? base + word : word;
}

/// As text; numbers without trailing zeros.
std::string plain(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  std::string text = value.dump();
  if (value.is_number_float() && text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0)
    text.erase(text.size() - 2);
  return text;
}

std::string sorted_and_joined(std::vector<std::string> parts) {
  std::sort(parts.begin(), parts.end());
  return std::accumulate(parts.begin(), parts.end(), std::string());
}

/// name=value of each field that is there, in the order given.
std::string fields(const json& object, const Names& order, const std::string& type_base) {
  std::string out;
  for (const char* name : order) {
    if (!object.contains(name)) continue;
    std::string value = plain(object[name]);
    const std::string key = name;
    if (key == "type") value = vocabulary(value, type_base);
    if (key == "component") value = vocabulary(value, kCbv + "Comp-");
    if (key == "exception") value = vocabulary(value, kWebVocabulary);
    out += key + "=" + value;
  }
  return out;
}

/// The list's name, then its elements sorted, each with its own name and fields.
std::string elements(const std::string& list, const json& array, const std::string& element, const Names& order,
                     const std::string& type_base) {
  std::vector<std::string> parts;
  for (const json& entry : array) parts.push_back(element + fields(entry, order, type_base));
  return list + sorted_and_joined(std::move(parts));
}

std::string property(const std::string& name, const json& value) {
  if (name == "bizStep") return name + "=" + vocabulary(plain(value), kCbv + "BizStep-");
  if (name == "disposition") return name + "=" + vocabulary(plain(value), kCbv + "Disp-");
  if (name == "readPoint" || name == "bizLocation") return name + "id=" + plain(value.at("id"));
  if (name == "bizTransactionList") return elements(name, value, "", kBizTransaction, kCbv + "BTT-");
  if (name == "sourceList") return elements(name, value, "", kSource, kCbv + "SDT-");
  if (name == "destinationList") return elements(name, value, "", kDestination, kCbv + "SDT-");
  if (!value.is_array()) return name + "=" + plain(value);
  if (name.find("uantityList") != std::string::npos)
    return elements(name, value, "quantityElement", kQuantityElement, "");
  std::vector<std::string> parts;
  for (const json& epc : value) parts.push_back("epc=" + plain(epc));
  return name + sorted_and_joined(std::move(parts));
}

std::string sensor_elements(const json& list) {
  std::vector<std::string> parts;
  for (const json& element : list) {
    std::string part = "sensorElement";
    if (element.contains("sensorMetadata"))
      part += "sensorMetadata" + fields(element["sensorMetadata"], kSensorMetadata, "");
    part += elements("", element.at("sensorReport"), "sensorReport", kSensorReport, kWebVocabulary);
    parts.push_back(std::move(part));
  }
  return sorted_and_joined(std::move(parts));
}

std::string extensions(const json& object, const json& namespaces);

/// {namespace}name=value; an object's or list's parts follow its name.
std::string extension(const std::string& name, const json& value, const json& namespaces) {
  if (value.is_array()) {
    std::vector<std::string> parts;
    for (const json& entry : value) parts.push_back(extension(name, entry, namespaces));
    return sorted_and_joined(std::move(parts));
  }
  const std::size_t colon = name.find(':');
  const std::string key = "{" + namespaces.at(name.substr(0, colon)).get<std::string>() + "}" + name.substr(colon + 1);
  return value.is_object() ? key + extensions(value, namespaces) : key + "=" + plain(value);
}

/// No field of the standard has a colon in its name, every extension has.
std::string extensions(const json& object, const json& namespaces) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : object.items())
    if (name.find(':') != std::string::npos) parts.push_back(extension(name, value, namespaces));
  return sorted_and_joined(std::move(parts));
}

/// What the user added to sensor elements comes after all of them, under the names of the parts that it was added to.
std::string sensor_extensions(const json& list, const json& namespaces) {
  std::vector<std::string> parts;
  for (const json& element : list) {
    std::string part;
    const auto add = [&](const std::string& name, const std::string& added) {
      if (!added.empty()) part += name + added;
    };
    if (element.contains("sensorMetadata")) add("sensorMetadata", extensions(element["sensorMetadata"], namespaces));
    for (const json& report : element.at("sensorReport")) add("sensorReport", extensions(report, namespaces));
    add("", extensions(element, namespaces));
    if (!part.empty()) parts.push_back("sensorElement" + part);
  }
  return sorted_and_joined(std::move(parts));
}

std::string sha256_hex(const std::string& text) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest;
  crypto_hash_sha256(digest.data(), reinterpret_cast<const unsigned char*>(text.data()), text.size());
  std::array<char, 2 * crypto_hash_sha256_BYTES + 1> hex;
  return sodium_bin2hex(hex.data(), hex.size(), digest.data(), digest.size());
}

}  // namespace

std::string event_pre_hash(const json& event, const json& namespaces) {
  std::string out = "eventType=" + event.at("type").get<std::string>();
  for (const char* name : kEvent)
    if (event.contains(name)) out += property(name, event[name]);
  if (event.contains("sensorElementList")) {
    out += sensor_elements(event["sensorElementList"]);
    out += sensor_extensions(event["sensorElementList"], namespaces);
  }
  return out + extensions(event, namespaces);
}

std::string event_hash_id(const json& event, const json& namespaces) {
  return "ni:///sha-256;" + sha256_hex(event_pre_hash(event, namespaces)) + "?ver=CBV2.0";
}

}  // namespace lodestar
