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

/// AssociationEvent_all_possible_fields. It spells the number 23 in a list as "23.0", which ours never do.
TEST(EventHash, AnAssociationWithAllThatCanBeSaid) {
  json event = json::parse(R"({
    "type": "AssociationEvent", "eventTime": "2019-11-01T13:00:00.000Z", "eventTimeZoneOffset": "+01:00",
    "parentID": "https://id.gs1.org/8003/04012345555554987",
    "childEPCs": ["https://id.gs1.org/8004/400000112346", "https://id.gs1.org/8004/400000112345"],
    "childQuantityList": [
      {"epcClass": "https://id.gs1.org/01/04012345987652", "quantity": 10.0},
      {"epcClass": "https://id.gs1.org/01/04012345123456/10/998877", "quantity": 200.5, "uom": "KGM"}],
    "action": "ADD", "bizStep": "assembling", "disposition": "in_progress",
    "readPoint": {"id": "https://id.gs1.org/414/4012345000016"},
    "bizLocation": {"id": "https://id.gs1.org/414/0614141008889"},
    "bizTransactionList": [
      {"type": "po", "bizTransaction": "https://id.gs1.org/253/06141410000121618034"},
      {"type": "pedigree", "bizTransaction": "https://id.gs1.org/8018/061414100000102534"}],
    "sourceList": [
      {"type": "location", "source": "https://id.gs1.org/414/4012345002256"},
      {"type": "possessing_party", "source": "https://id.gs1.org/417/4012345002256"},
      {"type": "owning_party", "source": "https://id.gs1.org/417/4012345002256"}],
    "destinationList": [
      {"type": "location", "destination": "https://id.gs1.org/414/0614141007776"},
      {"type": "possessing_party", "destination": "https://id.gs1.org/417/0614141007776"},
      {"type": "owning_party", "destination": "https://id.gs1.org/417/0614141007776"}],
    "sensorElementList": [{
      "sensorMetadata": {
        "time": "2019-04-02T13:05:00.000Z", "deviceID": "https://id.gs1.org/8004/4000001111",
        "deviceMetadata": "https://id.gs1.org/8004/4000001111", "rawData": "https://id.gs1.org/8004/401234599999",
        "startTime": "2019-04-02T12:55:01.000Z", "endTime": "2019-04-02T13:55:00.000Z",
        "dataProcessingMethod": "https://id.gs1.org/253/4012345000054987",
        "bizRules": "https://id.gs1.org/253/4012345000054987", "ext1:someFurtherMetadata": "someText"},
      "sensorReport": [{
        "type": "Temperature", "microorganism": "https://www.ncbi.nlm.nih.gov/taxonomy/1126011",
        "chemicalSubstance": "https://identifiers.org/inchikey:CZMRCDWAGMRECN-UGDNZRGBSA-N",
        "time": "2019-07-19T13:00:00.000Z", "value": 26.0, "component": "example:x", "stringValue": "SomeString",
        "booleanValue": true, "hexBinaryValue": "f0f0f0", "uriValue": "https://id.gs1.org/8004/4000001111",
        "minValue": 26.0, "maxValue": 26.2, "meanValue": 13.2, "percRank": 50.0, "percValue": 12.7,
        "deviceID": "https://id.gs1.org/8004/4000001111", "deviceMetadata": "https://id.gs1.org/8004/4000001111",
        "rawData": "https://id.gs1.org/8004/401234599999",
        "dataProcessingMethod": "https://id.gs1.org/253/4012345000054987", "uom": "CEL", "sDev": 0.1,
        "ext1:someFurtherReportData": "someText"}]}]})");
  const json added = json::parse(R"({
    "ext1:default": "stringAsDefaultValue", "ext1:int": "10", "ext1:float": "20",
    "ext1:time": "2013-06-08T14:58:56.591Z", "ext1:boolean": "true", "ext1:string": "string",
    "ext1:object": {"ext2:string": "stringInObject", "ext2:array": ["11", "21", "stringInArrayInObject"],
                    "ext2:object": {"ext3:string": "stringInObjectInObject"}},
    "ext1:array": ["12", "22", "2013-06-08T14:58:56.591Z", "true", "stringInArray",
                   {"ext1:object": {"ext2:int": "13", "ext2:string": "stringInObjectInArray",
                                    "ext2:array": ["14", "23", "stringInArrayInObjectInArray"],
                                    "ext2:object": {"ext3:string": "stringInObjectInObjectInArray"}}}]})");
  event.update(added);
  event["sensorElementList"][0].update(added);
  const json namespaces = {
      {"ext1", "http://example.com/ext1/"}, {"ext2", "http://example.com/ext2/"}, {"ext3", "http://example.com/ext3/"}};
  EXPECT_EQ(event_hash_id(event, namespaces),
            "ni:///sha-256;3dada0cdabe84618e9f0b842031159cb49534f487d5714cac9cfd647bf5f6c54?ver=CBV2.0")
      << event_pre_hash(event, namespaces);
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
