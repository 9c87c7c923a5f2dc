// The documents as they are, octet by octet: test/data/wms holds one example of each, which docs/wms_integration.md
// shows and the test `wms_schemas` holds against the official schemas. LODESTAR_WRITE_EXAMPLES=1 writes them anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
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

std::string document(const PalletChange& change, const std::string& corrected = "", Duration step = Duration(0)) {
  return epcis_document(epcis_draft(kParams, change),
                        {uuid(900), change.sequence, change.stamp + from_seconds(2), step, corrected});
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
  expect_example("epcis_correction", document(correction(PalletState::kStanding), document(change(2))));
  expect_example("epcis_uncertain", document(uncertain(), "", from_seconds(3600)));
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

TEST(Documents, ACorrectionDeclaresTheOldAndTellsTheNew) {
  const json old_events = events_of(document(change(2)));
  const json events = events_of(document(correction(PalletState::kStanding), document(change(2))));
  ASSERT_EQ(events.size(), 3u);
  for (int i = 0; i < 2; ++i) {
    json declared = events[i];
    const json error = declared["errorDeclaration"];
    EXPECT_EQ(error["reason"], "incorrect_data");
    EXPECT_EQ(error["lodestar:reason"], "stood one place further");
    EXPECT_EQ(error["correctiveEventIDs"], json({events[2]["eventID"]}));
    declared.erase("errorDeclaration");
    EXPECT_EQ(declared, old_events[i]);
  }
  EXPECT_FALSE(events[2].contains("errorDeclaration"));
  // What is corrected a second time is the correction, not what it had corrected.
  PalletChange second = correction(PalletState::kStanding);
  second.sequence = 4;
  const json twice = events_of(document(second, document(correction(PalletState::kStanding), document(change(2)))));
  ASSERT_EQ(twice.size(), 2u);
  EXPECT_EQ(twice[0]["eventID"], events[2]["eventID"]);
  // Nothing is known of what it corrects.
  EXPECT_EQ(events_of(document(correction(PalletState::kGone))).size(), 1u);
}

TEST(Documents, EventIdsAreTheHashesOfTheEvents) {
  const json namespaces = json::parse(document(change(2)))["@context"][1];
  for (const PalletChange& what : {change(1), change(2), uncertain(), gone()})
    for (const json& event : events_of(document(what))) EXPECT_EQ(event["eventID"], event_hash_id(event, namespaces));
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
  truck.loads = {change(1).pallet};
  truck.battery = Battery{0.75, 48.5, false};
  expect_example("vda5050_connection", messages.connection(VdaConnection::kOnline, test::at(0)).payload);
  expect_example("vda5050_state", messages.state(truck, test::at(1)).payload);
  expect_example("vda5050_visualization", messages.visualization(truck, test::at(2)).payload);
  expect_example("vda5050_factsheet", messages.factsheet(test::at(3)).payload);
  truck = TruckState();
  truck.outbox_full = true;
  expect_example("vda5050_state_in_trouble", messages.state(truck, test::at(4)).payload);
  params.version = "3.0.0";
  EXPECT_EQ(Vda5050(params).connection(VdaConnection::kOffline, test::at(0)).topic,
            "uagv/v3/lodestar/truck7/connection");
}

}  // namespace
}  // namespace lodestar
