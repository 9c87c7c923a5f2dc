// Published examples: github.com/RalphTro/epcis-event-hash-generator, tests/examples (expected/CBV2.0), whose hashes
// the implementation of OpenEPCIS gives too. Their identifiers are written here in canonical form, as ours are.
#include "lodestar/wms/event_hash.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace lodestar {
namespace {

using nlohmann::json;

const json kNone = json::object();

TEST(EventHash, SensorReportsWithComponents) {
  const json event = json::parse(R"({
    "type": "ObjectEvent", "eventTime": "2022-04-07T10:00:00.000Z", "eventTimeZoneOffset": "+01:00",
    "epcList": ["https://id.gs1.org/8003/040123450007718765"], "action": "OBSERVE", "bizStep": "sensor_reporting",
    "readPoint": {"id": "https://id.gs1.org/414/4012345000054"},
    "sensorElementList": [{"sensorReport": [
      {"type": "gs1:Angle", "value": 42.698334, "component": "cbv:Comp-latitude", "uom": "DD",
       "coordinateReferenceSystem": "http://www.opengis.net/def/crs/OGC/1.3/CRS84"},
      {"type": "Angle", "value": 23.319941, "component": "longitude", "uom": "DD",
       "coordinateReferenceSystem": "http://www.opengis.net/def/crs/OGC/1.3/CRS84"}]}]})");
  EXPECT_EQ(event_hash_id(event, kNone),
            "ni:///sha-256;14faa21345eb49fa31e5578aed52a2c291b7dc8ded0d53c88135955173ea91fc?ver=CBV2.0")
      << event_pre_hash(event, kNone);
}

TEST(EventHash, ExtensionsAtTheEnd) {
  const json event = json::parse(R"({
    "type": "ObjectEvent", "eventTime": "2020-03-04T10:00:30.000Z", "eventTimeZoneOffset": "+01:00",
    "recordTime": "2020-03-04T11:00:30.999+01:00",
    "epcList": ["https://id.gs1.org/00/040123450000003338", "https://id.gs1.org/00/040123450000001112",
                "https://id.gs1.org/00/040123450000002225"],
    "action": "OBSERVE", "bizStep": "departing",
    "readPoint": {"id": "https://id.gs1.org/414/4012345000115/254/987"},
    "example:myField1": {"example:mySubField1": "2", "example:mySubField2": "5"},
    "example:myField2": "0",
    "example:myField3": {"example:mySubField3": ["3", "1"]}})");
  EXPECT_EQ(event_hash_id(event, {{"example", "https://ns.example.com/epcis/"}}),
            "ni:///sha-256;6ae96341e0acc6d7a261364751f60e68278a81cdf51da0abb6b4e617014e39d7?ver=CBV2.0");
}

TEST(EventHash, ParentAndChildren) {
  const json event = json::parse(R"({
    "type": "AggregationEvent", "eventTime": "2019-10-21T09:58:56.591Z", "eventTimeZoneOffset": "+02:00",
    "parentID": "https://id.gs1.org/00/040470231111111229",
    "childEPCs": ["https://id.gs1.org/01/04047023775511/21/97", "https://id.gs1.org/01/04047023775511/21/98",
                  "https://id.gs1.org/01/04047023775511/21/107", "https://id.gs1.org/01/04047023775511/21/109"],
    "action": "ADD", "bizStep": "packing", "readPoint": {"id": "https://id.gs1.org/414/4047023000125"}})");
  EXPECT_EQ(event_hash_id(event, kNone),
            "ni:///sha-256;c941e6486c561c2be83c28dc228c150eaef9a6befb1015e6cc563982fb7414b6?ver=CBV2.0");
}

TEST(EventHash, QuantitiesAndTransactions) {
  const json event = json::parse(R"({
    "type": "TransactionEvent", "eventTime": "2019-10-21T12:58:56.591Z", "eventTimeZoneOffset": "+02:00",
    "bizTransactionList": [{"type": "inv", "bizTransaction": "urn:epcglobal:cbv:bt:4012345123456:RE1099"}],
    "quantityList": [{"epcClass": "https://id.gs1.org/01/04012345999884/10/2014-02-10", "quantity": 2030.0,
                      "uom": "KGM"}],
    "action": "ADD", "bizStep": "holding", "readPoint": {"id": "https://id.gs1.org/414/4012345000252"},
    "bizLocation": {"id": "https://id.gs1.org/414/4012345000023"}})");
  EXPECT_EQ(event_hash_id(event, kNone),
            "ni:///sha-256;b741a543ea0b2a4c4bdb3441c7dc196b41710e5b2c9870b211fac8d6d4c93427?ver=CBV2.0");
}

TEST(EventHash, IdentityTimeOfRecordAndErrorsTakeNoPart) {
  json event = {{"type", "ObjectEvent"},
                {"eventTime", "2022-02-16T15:50:00.000Z"},
                {"eventTimeZoneOffset", "+01:00"},
                {"epcList", {"https://id.gs1.org/00/140123451122233341"}},
                {"action", "OBSERVE"},
                {"bizStep", "transporting"},
                {"readPoint", {{"id", "geo:47.506694,11.104301"}}}};
  const std::string id = event_hash_id(event, kNone);
  EXPECT_EQ(id, "ni:///sha-256;1d2ec4174d8f0b5988a44795b31a636e8bc7f88ebc4bdc0d35c14f215a842e80?ver=CBV2.0");
  event["eventID"] = "urn:uuid:1";
  event["recordTime"] = "2022-02-16T15:50:01.000Z";
  event["errorDeclaration"] = {{"declarationTime", "2022-02-17T15:50:00.000Z"}};
  EXPECT_EQ(event_hash_id(event, kNone), id);
  event["disposition"] = "in_transit";
  EXPECT_NE(event_hash_id(event, kNone), id);
}

}  // namespace
}  // namespace lodestar
