#include "lodestar/wms/epcis.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/wms/event_hash.hpp"
#include "lodestar/wms/gs1.hpp"
#include "lodestar/wms/iso_time.hpp"

namespace lodestar {
namespace {

using nlohmann::json;

const json kNamespaces = {{"lodestar", "https://lodestar.example/epcis/"}};
constexpr char kContext[] = "https://ref.gs1.org/standards/epcis/2.0.0/epcis-context.jsonld";

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

std::string utf8(const std::string& text) { return json::parse(text_of(text)).get<std::string>(); }

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

/// What all events of a change share.
json event(const EpcisParams& params, const PalletChange& change, const char* type, const char* action) {
  const Pallet& pallet = change.pallet;
  const bool gone = pallet.state == PalletState::kGone, in_doubt = pallet.state == PalletState::kUncertain;
  json out = {{"type", type},
              {"action", action},
              {"eventTime", iso_time(change.stamp)},
              {"eventTimeZoneOffset", "+00:00"},
              {"readPoint", place(params, pallet)},
              {"lodestar:pallet", uuid_uri(pallet.id)},
              {"lodestar:state", name(pallet.state)}};
  if (change.kind == PalletChangeKind::kPick || pallet.state == PalletState::kOnFork) {
    out["bizStep"] = "transporting";
    out["disposition"] = in_doubt ? "unknown" : "in_transit";
  } else {
    out["bizStep"] = gone ? "departing" : "storing";
    out["disposition"] = gone ? "in_transit" : in_doubt ? "unknown" : "in_progress";
    if (!gone) out["bizLocation"] = place(params, pallet);
  }
  if (!pallet.type.empty()) out["lodestar:palletType"] = utf8(pallet.type);
  if (!pallet.zone.empty() && !valid_gln_extension(pallet.zone)) out["lodestar:zone"] = utf8(pallet.zone);
  for (const std::string& candidate : change.candidates)
    if (valid_uuid(candidate)) out["lodestar:candidate"].push_back(uuid_uri(candidate));
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
  return {{"type", type},
          {"component", component},
          {"value", rounded(value)},
          {"sDev", rounded(std::sqrt(std::max(variance, 0.0)))},
          {"uom", unit},
          {"coordinateReferenceSystem", params.coordinate_reference_system}};
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

void identify(json& event, const HandOver& hand_over) {
  if (hand_over.clock_step != Duration::zero()) {
    event["lodestar:clock"] = "unsynchronised";
    event["lodestar:clockStep_s"] = rounded(seconds(hand_over.clock_step));
  }
  event["eventID"] = event_hash_id(event, kNamespaces);
}

/// The events of the corrected document, each called wrong; what was itself told again in it is left out.
json declared_wrong(const HandOver& hand_over, const std::string& reason, const json& corrective_ids) {
  json out = json::array();
  if (hand_over.corrected.empty()) return out;
  const json corrected = json::parse(hand_over.corrected);
  for (json event : corrected.at("epcisBody").at("eventList")) {
    if (event.contains("errorDeclaration")) continue;
    event["errorDeclaration"] = {{"declarationTime", iso_time(hand_over.now)},
                                 {"reason", "incorrect_data"},
                                 {"correctiveEventIDs", corrective_ids}};
    if (!reason.empty()) event["errorDeclaration"]["lodestar:reason"] = reason;
    out.push_back(std::move(event));
  }
  return out;
}

}  // namespace

std::string epcis_draft(const EpcisParams& params, const PalletChange& change) {
  json events = json::array();
  switch (change.kind) {
    case PalletChangeKind::kPick:
      events = {association(params, change, "ADD")};
      break;
    case PalletChangeKind::kDrop:
      events = {association(params, change, "DELETE"), observation(params, change)};
      break;
    case PalletChangeKind::kCorrection:
      events = {observation(params, change)};
      break;
  }
  return text_of({{"events", events}, {"reason", utf8(change.reason)}});
}

std::string epcis_document(const std::string& draft_text, const HandOver& hand_over) {
  const json draft = json::parse(draft_text);
  json events = draft.at("events"), ids = json::array();
  for (json& event : events) {
    identify(event, hand_over);
    ids.push_back(event["eventID"]);
  }
  json list = declared_wrong(hand_over, draft.at("reason"), ids);
  list.insert(list.end(), events.begin(), events.end());
  return text_of({{"@context", {kContext, kNamespaces}},
                  {"type", "EPCISDocument"},
                  {"schemaVersion", "2.0"},
                  {"creationDate", iso_time(hand_over.now)},
                  {"lodestar:stream", uuid_uri(hand_over.stream)},
                  {"lodestar:sequence", hand_over.sequence},
                  {"epcisBody", {{"eventList", list}}}});
}

}  // namespace lodestar
