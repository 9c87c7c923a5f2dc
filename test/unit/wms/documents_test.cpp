// The documents as they are, octet by octet: test/data/wms holds one example of each, which docs/wms_integration.md
// shows and the test `wms_schemas` holds against the official schemas. LODESTAR_WRITE_EXAMPLES=1 writes them anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lodestar/wms/epcis.hpp"
#include "lodestar/wms/event_hash.hpp"
#include "lodestar/wms/iso_time.hpp"
#include "lodestar/wms/vda5050.hpp"
#include "support/bridge_params.hpp"
#include "support/pallet_changes.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using test::change;
using test::correction;
using test::gone;
using test::uncertain;
using test::uuid;

const EpcisParams kParams = test::bridge_params("").epcis;

std::string document(const PalletChange& change, const std::vector<std::string>& told = {}, WallClock clock = {}) {
  return epcis_document(epcis_draft(kParams, change),
                        {uuid(900), change.sequence, change.stamp + from_seconds(2), clock, told});
}

json events_of(const std::string& document) { return json::parse(document)["epcisBody"]["eventList"]; }

void expect_example(const std::string& name, const std::string& text) {
  const std::string path = std::string(LODESTAR_SOURCE_DIR) + "/test/data/wms/" + name + ".json";
  if (std::getenv("LODESTAR_WRITE_EXAMPLES") != nullptr) std::ofstream(path) << json::parse(text).dump(2) << "\n";
  std::ifstream file(path);
  std::stringstream example;
  example << file.rdbuf();
  EXPECT_EQ(json::parse(text).dump(2) + "\n", example.str()) << path;
}

TEST(Documents, Examples) {
  expect_example("epcis_pick", document(change(1)));
  expect_example("epcis_drop", document(change(2)));
  expect_example("epcis_correction",
                 document(correction(PalletState::kStanding), {document(change(1)), document(change(2))}));
  expect_example("epcis_uncertain", document(uncertain(), {}, {true, from_seconds(3600)}));
  expect_example("epcis_gone", document(gone()));
}

TEST(Documents, PickTiesThePalletToTheTruck) {
  const json event = events_of(document(change(1)))[0];
  EXPECT_EQ(event["type"], "AssociationEvent");
  EXPECT_EQ(event["action"], "ADD");
  EXPECT_EQ(event["parentID"], "https://id.gs1.org/8004/4012345TRUCK7");
  EXPECT_EQ(event["childEPCs"], json({"https://id.gs1.org/00/106141412345678908"}));
  EXPECT_FALSE(event.contains("bizLocation"));
}

TEST(Documents, APickInDoubtIsOnTheForkAllTheSame) {
  PalletChange pick = uncertain();
  pick.kind = PalletChangeKind::kPick;
  const json event = events_of(document(pick))[0];
  EXPECT_EQ(event["bizStep"], "transporting");
  EXPECT_EQ(event["disposition"], "unknown");
  EXPECT_EQ(event["lodestar:state"], "uncertain");
  EXPECT_FALSE(event.contains("bizLocation"));
}

TEST(Documents, DropTellsWhereItStands) {
  const json events = events_of(document(change(2)));
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0]["type"], "AssociationEvent");
  EXPECT_EQ(events[0]["action"], "DELETE");
  EXPECT_EQ(events[1]["type"], "ObjectEvent");
  EXPECT_EQ(events[1]["action"], "OBSERVE");
  EXPECT_EQ(events[1]["readPoint"]["id"], "https://id.gs1.org/414/4012345000115/254/A-1");
  EXPECT_EQ(events[1]["bizLocation"], events[1]["readPoint"]);
  const json reports = events[1]["sensorElementList"][0]["sensorReport"];
  const struct {
    const char* component;
    double value, sigma;
  } expected[] = {{"x", 0.5, 0.01}, {"y", 3.0, 0.02}, {"z", 0.144, 0.001}, {"azimuth", 0.5, 0.005}};
  ASSERT_EQ(reports.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(reports[i]["component"], expected[i].component);
    EXPECT_NEAR(reports[i]["value"].get<double>(), expected[i].value, 1e-9);
    EXPECT_NEAR(reports[i]["sDev"].get<double>(), expected[i].sigma, 1e-9);
    EXPECT_EQ(reports[i]["coordinateReferenceSystem"], "https://hall-12.example/crs/map");
  }
}

TEST(Documents, AnUnreadPalletGoesByItsUuid) {
  EXPECT_EQ(events_of(document(uncertain()))[0]["childEPCs"], json({"urn:uuid:" + uuid(3)}));
}

/// What a document declares wrong, each with what replaces it, and what else it tells.
struct Told {
  std::vector<std::pair<json, json>> replaced;
  std::vector<json> others;
};
Told told_in(const std::string& document) {
  Told out;
  std::map<std::string, json> right;
  for (const json& event : events_of(document)) {
    if (event.contains("errorDeclaration")) {
      EXPECT_EQ(event["errorDeclaration"]["reason"], "incorrect_data");
      EXPECT_EQ(event["errorDeclaration"]["correctiveEventIDs"].size(), 1u);
      out.replaced.push_back({event, nullptr});
      out.replaced.back().first.erase("errorDeclaration");
    } else if (event.contains("lodestar:toldAnew")) {
      right[event["eventID"]] = event;
    } else {
      out.others.push_back(event);
    }
  }
  std::size_t i = 0;
  for (const json& event : events_of(document))
    if (event.contains("errorDeclaration"))
      out.replaced[i++].second = right[event["errorDeclaration"]["correctiveEventIDs"][0].get<std::string>()];
  EXPECT_EQ(right.size(), out.replaced.size());
  for (const auto& [wrong, event] : out.replaced) {
    EXPECT_EQ(event["type"], wrong["type"]);
    EXPECT_EQ(event["action"], wrong["action"]);
    EXPECT_EQ(event["eventTime"], wrong["eventTime"]) << "it happened then";
  }
  return out;
}

std::string picked() { return document(change(1)); }
std::string dropped() { return document(change(2)); }
const char kLabel[] = "https://id.gs1.org/00/106141412345678908";

/// The pallet of change(1) and change(2) before its label was read.
std::string unread(std::uint64_t n) {
  PalletChange out = change(n);
  out.pallet.sscc.clear();
  return document(out);
}

TEST(Documents, AnotherPlaceReplacesTheSetDownAndLeavesThePick) {
  const std::string corrected = document(correction(PalletState::kStanding), {picked(), dropped()});
  const Told told = told_in(corrected);
  ASSERT_EQ(told.replaced.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(told.replaced[i].first, events_of(dropped())[i]) << "word for word";
    EXPECT_EQ(told.replaced[i].second["readPoint"]["id"], "https://id.gs1.org/414/4012345000115/254/A-2");
  }
  EXPECT_EQ(events_of(corrected)[0]["errorDeclaration"]["lodestar:reason"], "stood one place further");
  ASSERT_EQ(told.others.size(), 1u);
  EXPECT_EQ(told.others[0]["action"], "OBSERVE");
}

TEST(Documents, AnotherPoseInTheSameZoneLeavesTheSetDownToo) {
  PalletChange moved = correction(PalletState::kStanding);
  moved.pallet.zone = change(2).pallet.zone;
  moved.pallet.T_map_pallet.translation().x() += 1.25;
  const Told told = told_in(document(moved, {picked(), dropped()}));
  ASSERT_EQ(told.replaced.size(), 1u);
  EXPECT_EQ(told.replaced[0].first, events_of(dropped())[1]);
  const json element = told.replaced[0].second["sensorElementList"][0];
  EXPECT_EQ(element["sensorReport"][0]["value"], 1.75);
  EXPECT_EQ(element["sensorMetadata"], events_of(dropped())[1]["sensorElementList"][0]["sensorMetadata"]);
}

TEST(Documents, APoseThatSomebodyMeasuredIsNotCoasting) {
  PalletChange coasted = change(2), moved = correction(PalletState::kStanding);
  coasted.pallet.coasting = true;
  moved.pallet.T_map_pallet.translation().x() += 1.25;
  const Told told = told_in(document(moved, {picked(), document(coasted)}));
  ASSERT_EQ(told.replaced.size(), 2u);
  EXPECT_EQ(told.replaced[1].first["lodestar:coasting"], true);
  EXPECT_EQ(told.replaced[1].second["lodestar:coasting"], false);
}

TEST(Documents, ALabelThatIsReadOnTheForkReplacesThePick) {
  PalletChange read = change(1);
  read.kind = PalletChangeKind::kCorrection;
  read.stamp = test::at(1.5);
  const Told told = told_in(document(read, {unread(1)}));
  ASSERT_EQ(told.replaced.size(), 1u);
  EXPECT_EQ(told.replaced[0].first["childEPCs"], json({"urn:uuid:" + uuid(1)}));
  EXPECT_EQ(told.replaced[0].second["childEPCs"], json({kLabel}));
  EXPECT_EQ(told.replaced[0].second["action"], "ADD");
  EXPECT_EQ(told.others.at(0)["epcList"], json({kLabel}));
}

TEST(Documents, ALabelThatIsReadLaterReplacesAllThatWasToldWithoutIt) {
  PalletChange read = correction(PalletState::kStanding);
  read.pallet = change(2).pallet;
  const Told told = told_in(document(read, {unread(1), unread(2)}));
  ASSERT_EQ(told.replaced.size(), 3u);
  EXPECT_EQ(told.replaced[0].second["childEPCs"], json({kLabel}));
  EXPECT_EQ(told.replaced[0].second["bizStep"], "transporting");
  EXPECT_EQ(told.replaced[1].second["action"], "DELETE");
  EXPECT_EQ(told.replaced[2].second["epcList"], json({kLabel}));
}

TEST(Documents, WhatProvesToBeAnotherPalletIsToldOfThatOne) {
  // Pallet 3 was lifted in doubt as pallet 9, and proves to be itself.
  PalletChange lifted = change(5), merged = change(5), ended = change(5);
  lifted.pallet.id = merged.pallet.id = ended.pallet.id = uuid(9);
  lifted.pallet.state = PalletState::kUncertain;
  lifted.candidates = {uuid(3), uuid(4)};
  merged.kind = ended.kind = PalletChangeKind::kCorrection;
  merged.pallet.id = uuid(3);
  ended.pallet.state = PalletState::kGone;
  const Told told = told_in(document(merged, {document(lifted)}));
  ASSERT_EQ(told.replaced.size(), 1u);
  EXPECT_EQ(told.replaced[0].second["childEPCs"], json({"urn:uuid:" + uuid(3)}));
  EXPECT_EQ(told.replaced[0].second["disposition"], "in_transit");
  EXPECT_FALSE(told.replaced[0].second.contains("lodestar:candidate"));
  const Told end = told_in(document(ended, {document(lifted)}));
  EXPECT_TRUE(end.replaced.empty());
  EXPECT_EQ(end.others.at(0)["bizStep"], "decommissioning");
  EXPECT_EQ(end.others.at(0)["epcList"], json({"urn:uuid:" + uuid(9)}));
}

/// How change(2) left by a dock, and what was told about it then.
PalletChange told_gone(PalletChangeKind kind) {
  PalletChange out = kind == PalletChangeKind::kDrop ? change(2) : correction(PalletState::kGone);
  out.pallet.state = PalletState::kGone;
  out.pallet.zone = "DOCK-1";
  return out;
}

TEST(Documents, ALabelThatIsToldAfterTheDepartureReplacesAllNames) {
  PalletChange unread_gone = told_gone(PalletChangeKind::kDrop);
  unread_gone.pallet.sscc.clear();
  const std::string departed = document(unread_gone);
  const std::string labelled = document(told_gone(PalletChangeKind::kCorrection), {unread(1), departed});
  const Told told = told_in(labelled);
  ASSERT_EQ(told.replaced.size(), 3u);
  EXPECT_EQ(told.replaced[0].second["childEPCs"], json({kLabel}));
  EXPECT_EQ(told.replaced[1].second["childEPCs"], json({kLabel}));
  EXPECT_EQ(told.replaced[2].second["epcList"], json({kLabel}));
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(told.replaced[i].second["bizStep"], "departing");
    EXPECT_EQ(told.replaced[i].second["lodestar:state"], "gone");
    EXPECT_EQ(told.replaced[i].second["readPoint"], events_of(departed)[1]["readPoint"]);
  }
  ASSERT_EQ(told.others.size(), 1u);
  EXPECT_EQ(told.others[0]["bizStep"], "departing");
}

TEST(Documents, WhatLeftInDoubtIsGoneUnderItsRightName) {
  PalletChange lifted = change(1), left = told_gone(PalletChangeKind::kDrop), merged = left, ended = left;
  for (PalletChange* each : {&lifted, &left}) {
    each->pallet.id = uuid(9);
    each->pallet.sscc.clear();
    each->candidates = {uuid(1), uuid(4)};
  }
  lifted.pallet.state = PalletState::kUncertain;
  merged.kind = ended.kind = PalletChangeKind::kCorrection;
  ended.pallet.id = uuid(9);
  ended.pallet.sscc.clear();
  const std::vector<std::string> before = {document(lifted), document(left)};
  const Told told = told_in(document(merged, before));
  ASSERT_EQ(told.replaced.size(), 3u);
  EXPECT_EQ(told.replaced[0].second["disposition"], "in_transit");
  EXPECT_EQ(told.replaced[0].second["lodestar:state"], "on_fork");
  for (const auto& [wrong, right] : told.replaced) {
    EXPECT_EQ(right["lodestar:pallet"], "urn:uuid:" + uuid(1));
    EXPECT_FALSE(right.contains("lodestar:candidate"));
    EXPECT_EQ(right["bizStep"], wrong["bizStep"]);
  }
  EXPECT_EQ(told.replaced[2].second["lodestar:state"], "gone");
  EXPECT_EQ(told.replaced[2].second["disposition"], "in_transit");

  merged.pallet.sscc.clear();
  EXPECT_EQ(told_in(document(merged, before)).replaced.size(), 3u) << "it has another name, though no label";
  EXPECT_TRUE(told_in(document(ended, before)).replaced.empty());
}

TEST(Documents, TheEndOfANameStaysTold) {
  PalletChange nameless = told_gone(PalletChangeKind::kCorrection);
  nameless.pallet.sscc.clear();
  const std::string ended = document(nameless, {unread(1), unread(2)});
  ASSERT_EQ(events_of(ended).at(0)["bizStep"], "decommissioning");
  for (const PalletState state : {PalletState::kGone, PalletState::kStanding})
    for (const auto& [wrong, right] : told_in(document(correction(state), {unread(1), unread(2), ended})).replaced)
      EXPECT_NE(wrong["bizStep"], "decommissioning");
}

TEST(Documents, DoubtAndDepartureAreNoErrors) {
  PalletChange doubt = correction(PalletState::kUncertain), sure = correction(PalletState::kStanding);
  doubt.pallet.zone = sure.pallet.zone = change(2).pallet.zone;
  const std::string doubted = document(doubt, {picked(), dropped()});
  EXPECT_EQ(events_of(doubted).size(), 1u);
  EXPECT_EQ(events_of(doubted)[0]["disposition"], "unknown");
  EXPECT_EQ(events_of(doubted)[0]["lodestar:reason"], "stood one place further");
  EXPECT_EQ(events_of(document(sure, {picked(), dropped(), doubted})).size(), 1u);
  const json gone = events_of(document(correction(PalletState::kGone), {picked(), dropped()}));
  ASSERT_EQ(gone.size(), 1u);
  EXPECT_EQ(gone[0]["bizStep"], "departing");
}

TEST(Documents, APalletInDoubtThatTheForkCarriesStandsNowhere) {
  PalletChange doubt = correction(PalletState::kUncertain);
  const json event = events_of(document(doubt, {picked()}))[0];
  EXPECT_EQ(event["bizStep"], "transporting");
  EXPECT_FALSE(event.contains("bizLocation"));
  EXPECT_FALSE(event.contains("sensorElementList"));
}

TEST(Documents, ADepartureThatWasNoneIsReplaced) {
  PalletChange gone = change(2);
  gone.pallet.state = PalletState::kGone;
  const Told told = told_in(document(correction(PalletState::kStanding), {picked(), document(gone)}));
  ASSERT_EQ(told.replaced.size(), 2u);
  for (const auto& [wrong, right] : told.replaced) {
    EXPECT_EQ(wrong["bizStep"], "departing");
    EXPECT_EQ(right["bizStep"], "storing");
    EXPECT_EQ(right["disposition"], "in_progress");
    EXPECT_EQ(right["lodestar:state"], "standing");
    EXPECT_TRUE(right.contains("bizLocation"));
  }
}

TEST(Documents, ACorrectionCanBeCorrectedBack) {
  const std::string first = document(correction(PalletState::kStanding), {picked(), dropped()});
  PalletChange back = correction(PalletState::kStanding);
  back.stamp += from_seconds(60);
  back.pallet.zone = change(2).pallet.zone;
  const Told told = told_in(document(back, {picked(), dropped(), first}));
  ASSERT_EQ(told.replaced.size(), 3u) << "what was declared wrong before is not declared again";
  for (const json& event : events_of(dropped()))
    for (const auto& [wrong, right] : told.replaced) {
      EXPECT_NE(wrong["eventID"], event["eventID"]);
      EXPECT_NE(right["eventID"], event["eventID"]) << "declared wrong and right";
    }
}

TEST(Documents, ACorrectionOfWhatNobodyKnowsStandsAlone) {
  EXPECT_EQ(events_of(document(correction(PalletState::kStanding))).size(), 1u);
}

TEST(Documents, EventIdsAreTheHashesOfTheEvents) {
  const json namespaces = json::parse(document(change(2)))["@context"][1];
  for (const std::string& each : {picked(), dropped(), document(uncertain()), document(gone()),
                                  document(correction(PalletState::kStanding), {picked(), dropped()})})
    for (const json& event : events_of(each)) EXPECT_EQ(event["eventID"], event_hash_id(event, namespaces));
}

TEST(Documents, APlaceThatNoKeyCanNameIsTheSites) {
  PalletChange odd = change(2);
  odd.pallet.zone = "Tor 3 <links>";
  const json event = events_of(document(odd))[1];
  EXPECT_EQ(event["bizLocation"]["id"], "https://id.gs1.org/414/4012345000115");
  EXPECT_EQ(event["lodestar:zone"], odd.pallet.zone);
}

TEST(Documents, Times) {
  EXPECT_EQ(iso_time(Stamp(std::chrono::milliseconds(1790000000125))), "2026-09-21T14:13:20.125Z");
  EXPECT_EQ(iso_time(Stamp(std::chrono::nanoseconds(999999))), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(iso_time(Stamp(std::chrono::milliseconds(-1))), "1969-12-31T23:59:59.999Z");
}

TEST(Documents, Vda5050Examples) {
  VdaParams params = test::bridge_params("").vda;
  params.truck = {"Simulated", 1600, 3, 0.6, 1.2, 2.1, 0.95, 4.5};
  Vda5050 messages(params);
  TruckState truck;
  truck.pose.emplace();
  truck.pose->T_map_base = Eigen::Translation3d(12.5, 3.25, 0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  truck.localized = true;
  truck.protection_level_m = 0.125;
  truck.driving = true;
  truck.loads.emplace({change(1).pallet});
  truck.battery = Battery{0.75, 48.5, false};
  expect_example("vda5050_connection", messages.connection(VdaConnection::kOnline, test::at(0)).payload);
  expect_example("vda5050_state", messages.state(truck, test::at(1)).payload);
  expect_example("vda5050_visualization", messages.visualization(truck, test::at(2)).payload);
  expect_example("vda5050_factsheet", messages.factsheet(test::at(3)).payload);
  truck.localized = false;
  const json lost = json::parse(Vda5050(params).state(truck, test::at(4)).payload)["agvPosition"];
  EXPECT_FALSE(lost.contains("deviationRange")) << "nobody knows how far it may be off";
  truck = TruckState();
  truck.outbox_full = true;
  expect_example("vda5050_state_in_trouble", messages.state(truck, test::at(4)).payload);
  params.version = "3.0.0";
  EXPECT_EQ(Vda5050(params).connection(VdaConnection::kOffline, test::at(0)).topic,
            "uagv/v3/lodestar/truck7/connection");
}

}  // namespace
}  // namespace lodestar
