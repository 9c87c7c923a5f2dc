#include "lodestar/wms/epcis.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <vector>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/wms/event_hash.hpp"
#include "lodestar/wms/gs1.hpp"
#include "lodestar/wms/iso_time.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using Keys = std::initializer_list<const char*>;

const json kNamespaces = {{"lodestar", "https://lodestar.example/epcis/"}};
constexpr char kContext[] = "https://ref.gs1.org/standards/epcis/2.0.0/epcis-context.jsonld";

/// What is not UTF-8 in it is replaced.
std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

/// To a tenth of a millimetre or milliradian: more is noise. Minus zero is zero.
double rounded(double value) { return std::round(value * 1e4) / 1e4 + 0.0; }

const char* name(PalletState state) {
  switch (state) {
    case PalletState::kOnFork:
      return "on_fork";
    case PalletState::kStanding:
      return "standing";
    case PalletState::kGone:
      return "gone";
    case PalletState::kUncertain:
      return "uncertain";
  }
  return "";
}

std::string pallet_uri(const Pallet& pallet) {
  return pallet.sscc.empty() ? uuid_uri(pallet.id) : sscc_uri(pallet.sscc);
}

json place(const EpcisParams& params, const Pallet& pallet) {
  return {{"id", valid_gln_extension(pallet.zone) ? place_uri(params.gln, pallet.zone) : place_uri(params.gln)}};
}

/// What all events of a change share. Key by key, as all that is made often: each pair of a list would be made into an
/// array first.
json event(const EpcisParams& params, const PalletChange& change, const char* type, const char* action) {
  const Pallet& pallet = change.pallet;
  const bool gone = pallet.state == PalletState::kGone, in_doubt = pallet.state == PalletState::kUncertain;
  json out;
  out["type"] = type;
  out["action"] = action;
  out["eventTime"] = iso_time(change.stamp);
  out["eventTimeZoneOffset"] = "+00:00";
  out["readPoint"] = place(params, pallet);
  out["lodestar:pallet"] = uuid_uri(pallet.id);
  out["lodestar:state"] = name(pallet.state);
  if (change.kind == PalletChangeKind::kPick || pallet.state == PalletState::kOnFork) {
    out["bizStep"] = "transporting";
    out["disposition"] = in_doubt ? "unknown" : "in_transit";
  } else {
    out["bizStep"] = gone ? "departing" : "storing";
    out["disposition"] = gone ? "in_transit" : in_doubt ? "unknown" : "in_progress";
    if (!gone) out["bizLocation"] = out["readPoint"];
  }
  if (!pallet.type.empty()) out["lodestar:palletType"] = pallet.type;
  if (!pallet.zone.empty() && !valid_gln_extension(pallet.zone)) out["lodestar:zone"] = pallet.zone;
  for (const std::string& candidate : change.candidates)
    if (valid_uuid(candidate)) out["lodestar:candidate"].push_back(uuid_uri(candidate));
  if (!change.reason.empty()) out["lodestar:reason"] = change.reason;
  return out;
}

json association(const EpcisParams& params, const PalletChange& change, const char* action) {
  json out = event(params, change, "AssociationEvent", action);
  out["parentID"] = giai_uri(params.giai);
  out["childEPCs"] = {pallet_uri(change.pallet)};
  return out;
}

json report(const EpcisParams& params, const char* type, const char* component, const char* unit, double value,
            double variance) {
  json out;
  out["type"] = type;
  out["component"] = component;
  out["value"] = rounded(value);
  out["sDev"] = rounded(std::sqrt(std::max(variance, 0.0)));
  out["uom"] = unit;
  out["coordinateReferenceSystem"] = params.coordinate_reference_system;
  return out;
}

/// Metres and radians by their codes of UN/CEFACT recommendation 20.
json pose_element(const EpcisParams& params, const PalletChange& change) {
  const Pallet& pallet = change.pallet;
  const auto position = pallet.T_map_pallet.translation();
  const double yaw_rad = roll_pitch_yaw(pallet.T_map_pallet.linear()).yaw_rad;
  return {{"sensorMetadata", {{"time", iso_time(change.stamp)}, {"deviceID", giai_uri(params.giai)}}},
          {"sensorReport",
           {report(params, "Length", "x", "MTR", position.x(), pallet.covariance(0, 0)),
            report(params, "Length", "y", "MTR", position.y(), pallet.covariance(1, 1)),
            report(params, "Length", "z", "MTR", position.z(), pallet.covariance(2, 2)),
            report(params, "Angle", "azimuth", "C81", yaw_rad, pallet.covariance(5, 5))}}};
}

json observation(const EpcisParams& params, const PalletChange& change) {
  json out = event(params, change, "ObjectEvent", "OBSERVE");
  out["epcList"] = {pallet_uri(change.pallet)};
  if (change.pallet.state == PalletState::kOnFork) return out;
  out["sensorElementList"] = {pose_element(params, change)};
  out["lodestar:level"] = change.pallet.level;
  out["lodestar:coasting"] = change.pallet.coasting;
  return out;
}

/// The name of a pallet without a label means nothing any more: it is known to be another, or nobody knows where.
json end_of_name(const EpcisParams& params, const PalletChange& change) {
  json out = event(params, change, "ObjectEvent", "DELETE");
  out["epcList"] = {pallet_uri(change.pallet)};
  out["bizStep"] = "decommissioning";
  out["disposition"] = "inactive";
  return out;
}

json correction(const EpcisParams& params, const PalletChange& change) {
  const bool ended = change.pallet.state == PalletState::kGone && change.pallet.sscc.empty();
  return ended ? end_of_name(params, change) : observation(params, change);
}

bool ends_name(const json& event) { return event["bizStep"] == "decommissioning"; }

/// Whether the correction may say another name for the pallet of this event. The end of a name is told of that name,
/// and gives its own pallet no other.
bool may_rename(const json& correction, const json& told) {
  return !ends_name(told) && !(ends_name(correction) && told["lodestar:pallet"] == correction["lodestar:pallet"]);
}

void identify(json& event) { event["eventID"] = event_hash_id(event, kNamespaces); }

/// What was told and holds yet: what a later document declared wrong is gone from it.
std::vector<json> in_force(const std::vector<std::string>& documents) {
  std::vector<json> out;
  for (const std::string& document : documents) {
    const json whole = json::parse(document);
    for (const json& event : whole.at("epcisBody").at("eventList")) {
      const auto is_it = [&](const json& told) { return told["eventID"] == event["eventID"]; };
      if (event.contains("errorDeclaration")) {
        out.erase(std::remove_if(out.begin(), out.end(), is_it), out.end());
      } else {
        out.push_back(event);
      }
    }
  }
  return out;
}

/// As `better` has them; a key that it lacks goes.
void copy(const Keys& keys, const json& better, json& event) {
  for (const char* key : keys) {
    event.erase(key);
    if (better.contains(key)) event[key] = better[key];
  }
}

/// The event with the right name of its pallet.
json renamed(json event, const json& correction) {
  event[event.contains("childEPCs") ? "childEPCs" : "epcList"] = correction["epcList"];
  copy({"lodestar:pallet", "lodestar:palletType"}, correction, event);
  return event;
}

/// ... and where it was set down.
json moved(json event, const json& correction) {
  copy({"readPoint", "bizLocation", "bizStep", "lodestar:zone"}, correction, event);
  if (!event.contains("sensorElementList")) return event;
  copy({"lodestar:level", "lodestar:coasting"}, correction, event);
  event["sensorElementList"][0]["sensorReport"] = correction["sensorElementList"][0]["sensorReport"];
  return event;
}

/// As certain as the correction is, of the place where that is the same, else of the name alone.
void settle(const json& correction, bool stands, json& event) {
  if (stands) copy({"disposition", "lodestar:state"}, correction, event);
  const bool answered = event.contains("lodestar:candidate") && !correction.contains("lodestar:candidate");
  if (!stands && answered && event["disposition"] == "unknown") {
    const bool on_fork = event["bizStep"] == "transporting";
    event["disposition"] = on_fork ? "in_transit" : "in_progress";
    event["lodestar:state"] = name(on_fork ? PalletState::kOnFork : PalletState::kStanding);
  }
  copy({"lodestar:candidate"}, correction, event);
}

/// Where in what was told the pallet was last lifted or set down.
struct LastMove {
  std::size_t index = 0;
  bool lifted = false;
};
LastMove last_move(const std::vector<json>& told) {
  for (std::size_t i = told.size(); i-- > 0;)
    if (told[i]["type"] == "AssociationEvent") return {i, told[i]["action"] == "ADD"};
  return {};
}

/// Events that were wrong, and what is right in place of each. Being in doubt, or out of it, is no error of what was
/// told; nor is it that a pallet is gone which was there.
struct Correction {
  json wrong = json::array(), right = json::array();
};
Correction correction_of(const std::vector<json>& told, const json& observed, Stamp now) {
  Correction out;
  const LastMove move = last_move(told);
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!may_rename(observed, told[i])) continue;
    const bool stands = !move.lifted && i >= move.index && observed.contains("bizLocation");
    json right = renamed(told[i], observed);
    if (stands) right = moved(std::move(right), observed);
    if (right == told[i]) continue;
    settle(observed, stands, right);
    right["lodestar:toldAnew"] = observed["eventTime"];  // what was declared wrong may become right again
    identify(right);
    json& wrong = out.wrong.emplace_back(told[i]);
    wrong["errorDeclaration"] = {{"declarationTime", iso_time(now)},
                                 {"reason", "incorrect_data"},
                                 {"correctiveEventIDs", json::array({right["eventID"]})}};
    copy({"lodestar:reason"}, observed, wrong["errorDeclaration"]);
    out.right.push_back(std::move(right));
  }
  return out;
}

/// A pallet in doubt that the fork carries: only what was told before says that it does.
void lift(json& event) {
  event["bizStep"] = "transporting";
  for (const char* key : {"bizLocation", "sensorElementList", "lodestar:level", "lodestar:coasting"}) event.erase(key);
}

void mark_clock(const HandOver& hand_over, json& event) {
  const bool stepped = hand_over.clock.step != Duration::zero();
  if (stepped || !hand_over.clock.synchronised) event["lodestar:clock"] = "unsynchronised";
  if (stepped) event["lodestar:clockStep_s"] = rounded(seconds(hand_over.clock.step));
}

}  // namespace

std::string epcis_draft(const EpcisParams& params, const PalletChange& change) {
  switch (change.kind) {
    case PalletChangeKind::kPick:
      return text_of(json::array({association(params, change, "ADD")}));
    case PalletChangeKind::kDrop:
      return text_of(json::array({association(params, change, "DELETE"), observation(params, change)}));
    case PalletChangeKind::kCorrection:
      return text_of(json::array({correction(params, change)}));
  }
  return "[]";
}

std::string epcis_document(const std::string& draft, const HandOver& hand_over) {
  json list = json::array();
  json events = json::parse(draft);
  if (!hand_over.told.empty()) {
    const std::vector<json> told = in_force(hand_over.told);
    json& observed = events.back();
    if (last_move(told).lifted && observed.contains("bizLocation")) lift(observed);
    const Correction correction = correction_of(told, observed, hand_over.now);
    list = correction.wrong;
    list.insert(list.end(), correction.right.begin(), correction.right.end());
  }
  for (json& event : events) {
    mark_clock(hand_over, event);
    identify(event);
    list.push_back(std::move(event));
  }
  return text_of({{"@context", {kContext, kNamespaces}},
                  {"type", "EPCISDocument"},
                  {"schemaVersion", "2.0"},
                  {"creationDate", iso_time(hand_over.now)},
                  {"lodestar:stream", uuid_uri(hand_over.stream)},
                  {"lodestar:sequence", hand_over.sequence},
                  {"epcisBody", {{"eventList", list}}}});
}

}  // namespace lodestar
