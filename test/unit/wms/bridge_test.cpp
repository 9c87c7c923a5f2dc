// The bridge over a link that is a list: no broker, no thread, the time is what the test says.
#include "lodestar/wms/bridge.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/bridge_params.hpp"
#include "support/fake_link.hpp"
#include "support/pallet_changes.hpp"
#include "support/rtree_damage.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using test::change;
using test::FakeLink;
using test::uuid;

class BridgeTest : public testing::Test {
 protected:
  BridgeTest() { params_.outbox.window = 50; }

  ClockReading now() const {
    return {test::at(time_s_ + wall_offset_s_), Instant(from_seconds(1000 + time_s_)), synchronised_};
  }
  void poll(Bridge& bridge, int times = 1) {
    for (int i = 0; i < times; ++i, time_s_ += 0.01) bridge.poll(now());
  }
  void acknowledge(const Bridge& bridge, std::uint64_t sequence) {
    link_.inbox.push_back(
        MqttMessage{"wms/v1/lodestar/truck7/ack", message_text(Acknowledgement{bridge.store().stream(), sequence})});
  }

  test::TemporaryFolder folder_{test::TemporaryFolder::memory()};
  BridgeParams params_ = test::bridge_params(folder_ / "wms.db");
  FakeLink link_;
  double time_s_ = 0, wall_offset_s_ = 0;
  bool synchronised_ = true;
};

TEST_F(BridgeTest, GreetsEachConnectionAnew) {
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  EXPECT_TRUE(bridge.connected());
  ASSERT_EQ(link_.wills.size(), 1u);
  EXPECT_EQ(link_.wills[0].topic, "uagv/v2/lodestar/truck7/connection");
  EXPECT_EQ(json::parse(link_.wills[0].payload)["connectionState"], "CONNECTIONBROKEN");
  EXPECT_EQ(link_.wills[0].qos, 1);
  EXPECT_TRUE(link_.wills[0].retained);
  EXPECT_EQ(link_.subscribed, std::vector<std::string>{"wms/v1/lodestar/truck7/ack"});
  EXPECT_EQ(link_.on("/factsheet").size(), 1u);
  EXPECT_EQ(link_.on("/stream").size(), 1u);

  link_.inbox.push_back(LinkDown{"lost"});
  poll(bridge, 3);
  const auto connections = link_.on("/connection");
  ASSERT_EQ(connections.size(), 2u);
  for (const MqttMessage& message : connections) {
    EXPECT_EQ(json::parse(message.payload)["connectionState"], "ONLINE");
    EXPECT_EQ(message.qos, 1);
    EXPECT_TRUE(message.retained);
  }
  EXPECT_LT(json::parse(connections[0].payload)["headerId"], json::parse(connections[1].payload)["headerId"]);
  bridge.shut_down(now());
  EXPECT_EQ(json::parse(link_.on("/connection").back().payload)["connectionState"], "OFFLINE");
}

TEST_F(BridgeTest, EventsLeaveOnTheSitesWordOnly) {
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  for (int n = 1; n <= 120; ++n) bridge.take(change(n), now());
  poll(bridge, 5);
  EXPECT_EQ(link_.on("/event").size(), 50u);
  EXPECT_EQ(bridge.outbox().waiting(), 120u);
  for (const auto& message : link_.on("/event")) EXPECT_EQ(message.qos, 1);
  acknowledge(bridge, 50);
  poll(bridge, 2);
  EXPECT_EQ(bridge.store().acknowledged(), 50u);
  EXPECT_EQ(link_.on("/event").size(), 100u);
  acknowledge(bridge, 20);
  acknowledge(bridge, 121);
  poll(bridge, 2);
  EXPECT_EQ(bridge.store().acknowledged(), 50u);
}

TEST_F(BridgeTest, ResendsTheSameOctetsEvenAfterARestart) {
  std::vector<MqttMessage> first;
  {
    Bridge bridge(params_, link_, now());
    poll(bridge, 2);
    for (int n = 1; n <= 5; ++n) bridge.take(change(n), now());
    poll(bridge, 2);
    first = link_.on("/event");
    ASSERT_EQ(first.size(), 5u);
  }
  time_s_ += 77;
  link_ = FakeLink();
  Bridge bridge(params_, link_, now());
  poll(bridge, 3);
  const auto again = link_.on("/event");
  ASSERT_EQ(again.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(again[i].payload, first[i].payload);
}

TEST_F(BridgeTest, OneOfTwoBrokersDies) {
  params_.brokers = 2;
  link_.working = {true, true};
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  bridge.take(change(1), now());
  poll(bridge);
  link_.working[0] = false;
  link_.inbox.push_back(LinkDown{"lost"});
  poll(bridge, 4);
  EXPECT_EQ(link_.tried, (std::vector<std::size_t>{0, 0, 1}));
  EXPECT_EQ(bridge.broker(), 1u);
  EXPECT_EQ(link_.on("/event").size(), 2u);
}

TEST_F(BridgeTest, WhereTheSiteDoesNotAnswerTheNextBrokerIsTried) {
  params_.brokers = 2;
  link_.working = {true, true};
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  time_s_ += 3600;
  poll(bridge);
  EXPECT_EQ(bridge.broker(), 0u) << "there is nothing to answer";
  bridge.take(change(1), now());
  poll(bridge);
  time_s_ += 29;
  poll(bridge, 3);
  EXPECT_EQ(bridge.broker(), 0u);
  time_s_ += 1;
  poll(bridge, 3);
  ASSERT_EQ(bridge.broker(), 1u);
  EXPECT_TRUE(bridge.connected());
  const auto connections = link_.on("/connection");
  ASSERT_EQ(connections.size(), 3u);
  EXPECT_EQ(json::parse(connections[1].payload)["connectionState"], "OFFLINE");
  EXPECT_EQ(document_key_from(link_.on("/event").back().payload)->sequence, 1u);
  // The site is slow, but answers.
  for (int n = 2; n <= 9; ++n) {
    bridge.take(change(n), now());
    acknowledge(bridge, n - 1);
    poll(bridge, 2);
    time_s_ += 20;
    poll(bridge, 2);
  }
  EXPECT_EQ(link_.tried, (std::vector<std::size_t>{0, 1}));
}

TEST_F(BridgeTest, ASiteThatForgotWhatItSaidIsToldWhereTheStreamIs) {
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  for (int n = 1; n <= 12; ++n) bridge.take(change(n), now());
  poll(bridge);
  acknowledge(bridge, 12);
  poll(bridge, 2);
  bridge.take(change(13), now());
  poll(bridge, 2);
  const std::size_t notices = link_.on("/stream").size(), events = link_.on("/event").size();
  acknowledge(bridge, 3);
  poll(bridge, 2);
  EXPECT_FALSE(bridge.outbox().site_fell_back()) << "it may be a word that came late";
  time_s_ += 2;
  acknowledge(bridge, 3);
  poll(bridge, 2);
  EXPECT_EQ(bridge.outbox().site_fell_back(), 3u);
  ASSERT_EQ(link_.on("/stream").size(), notices + 1);
  EXPECT_EQ(stream_notice_from(link_.on("/stream").back().payload)->acknowledged, 12u);
  ASSERT_EQ(link_.on("/event").size(), events + 1);
  EXPECT_EQ(document_key_from(link_.on("/event").back().payload)->sequence, 13u);
  acknowledge(bridge, 13);
  poll(bridge, 2);
  EXPECT_FALSE(bridge.outbox().site_fell_back());
}

TEST_F(BridgeTest, AnEventThatIsTakenTwiceIsRecordedOnce) {
  Bridge bridge(params_, link_, now());
  for (const int n : {2, 3, 6, 7, 7}) bridge.take(change(n), now());
  EXPECT_EQ(bridge.drops()[BridgeDrop::kKnown], 1u);
  PalletChange anew = change(7);
  anew.life = uuid(701);
  bridge.take(anew, now());
  EXPECT_EQ(bridge.store().last(), 5u) << "another of the same number";
  anew.life = "";
  bridge.take(anew, now());
  EXPECT_EQ(bridge.drops()[BridgeDrop::kLife], 1u);
}

TEST_F(BridgeTest, ATrackerFromAnOldBackupTellsNothingTwiceAndAllThatIsNew) {
  params_.store.history = 1;
  Bridge bridge(params_, link_, now());
  constexpr int kEvents = 3000;
  const auto of_life = [](int life, std::uint64_t n) {
    PalletChange out = change(n);
    out.life = uuid(700 + life);
    return out;
  };
  // A life for each hundred, as with a restart a day; all is acknowledged and forgotten.
  for (int n = 1; n <= kEvents; ++n) {
    bridge.take(of_life(n / 100, n), now());
    if (n % 50 != 0) continue;
    poll(bridge, 2);  // connects, sends
    acknowledge(bridge, n);
    poll(bridge);
  }
  ASSERT_EQ(bridge.store().acknowledged(), kEvents + 0u);
  for (int n = 1; n <= 450; ++n) bridge.take(of_life(n / 100, n), now());
  EXPECT_EQ(bridge.drops()[BridgeDrop::kKnown], 450u);
  EXPECT_EQ(bridge.store().last(), kEvents + 0u);
  for (int n = 451; n <= 460; ++n) bridge.take(of_life(90, n), now());
  EXPECT_EQ(bridge.store().last(), kEvents + 10u);
  EXPECT_EQ(bridge.store().last_heard(), heard_event(of_life(90, 460)));
}

TEST_F(BridgeTest, OddLabelsAndIds) {
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  std::uint64_t n = 0;
  const std::vector<std::string> labels = {"106141412345678907", "'; DROP TABLE event; --", "<script>alert(1)</script>",
                                           std::string(10240, '1'), "\xff\xfe"};
  for (const std::string& label : labels) {
    PalletChange odd = change(++n);
    odd.pallet.sscc = label;
    odd.pallet.zone = label;
    odd.pallet.type = label;
    odd.candidates = {label, uuid(7)};
    odd.reason = label;
    bridge.take(odd, now());
  }
  EXPECT_EQ(bridge.drops()[BridgeDrop::kLabel], labels.size());
  EXPECT_EQ(bridge.store().last(), labels.size());
  for (const std::string& label : labels) {
    PalletChange odd = change(++n);
    odd.pallet.id = label;
    bridge.take(odd, now());
  }
  EXPECT_EQ(bridge.drops()[BridgeDrop::kPalletId], labels.size());
  EXPECT_EQ(bridge.store().last(), labels.size());
  poll(bridge, 2);
  const auto events = link_.on("/event");
  ASSERT_EQ(events.size(), labels.size());
  for (const auto& message : events)
    for (const json& event : json::parse(message.payload)["epcisBody"]["eventList"])
      EXPECT_EQ(event.value("childEPCs", event.value("epcList", json()))[0].get<std::string>().substr(0, 9),
                "urn:uuid:");
}

TEST_F(BridgeTest, AFullStoreHoldsNewEventsInMemoryAndSaysSo) {
  params_.store.max_pages = 60;
  params_.store.reserve_pages = 24;
  params_.store.history = 1;
  params_.most_in_memory = 20;
  Bridge bridge(params_, link_, now());
  std::uint64_t n = 0;
  while (bridge.in_memory() < 20 && n < 5000) bridge.take(change(++n), now());
  ASSERT_EQ(bridge.in_memory(), 20u);
  EXPECT_EQ(bridge.drops()[BridgeDrop::kLost], 0u);
  bridge.take(change(n + 1), now());
  EXPECT_EQ(bridge.drops()[BridgeDrop::kLost], 1u);
  poll(bridge, 3);
  const json state = json::parse(link_.on("/state").back().payload);
  EXPECT_EQ(state["errors"][0]["errorType"], "outboxFull");

  // The site works it off: all that were held arrive, in order.
  std::size_t delivered = 0;
  std::uint64_t expected = 1;
  for (int i = 0; i < 4000 && bridge.outbox().acknowledged() < n; ++i) {
    const auto events = link_.on("/event");
    for (; delivered < events.size(); ++delivered) {
      const auto key = document_key_from(events[delivered].payload);
      ASSERT_TRUE(key);
      if (key->sequence == expected) ++expected;
    }
    acknowledge(bridge, expected - 1);
    poll(bridge);
  }
  EXPECT_EQ(bridge.outbox().acknowledged(), n);
  EXPECT_EQ(bridge.in_memory(), 0u);
  EXPECT_EQ(json::parse(link_.on("/state").back().payload)["errors"][0]["errorType"], "localizationLost");
}

TEST_F(BridgeTest, AClockThatIsSetMarksTheEventsBeforeIt) {
  Bridge bridge(params_, link_, now());
  bridge.take(change(1), now());
  wall_offset_s_ = 3600;
  poll(bridge);
  EXPECT_EQ(bridge.clock_steps(), 1u);
  bridge.take(change(2), now());
  poll(bridge, 3);
  const auto events = link_.on("/event");
  ASSERT_EQ(events.size(), 2u);
  const json before = json::parse(events[0].payload)["epcisBody"]["eventList"][0];
  EXPECT_EQ(before["lodestar:clock"], "unsynchronised");
  EXPECT_NEAR(before["lodestar:clockStep_s"].get<double>(), 3600, 0.1);
  EXPECT_FALSE(json::parse(events[1].payload)["epcisBody"]["eventList"][0].contains("lodestar:clock"));
}

TEST_F(BridgeTest, AClockThatIsSetChangesNoPeriod) {
  const auto tried_and_told = [&](double jump_s) {
    params_.store.path = folder_ / ("jump" + std::to_string(jump_s) + ".db");
    time_s_ = wall_offset_s_ = 0;
    link_ = FakeLink();
    link_.working = {false};
    Bridge bridge(params_, link_, now());
    bridge.take(change(1), now());
    for (const bool works : {false, true})
      for (const double jump : {0.0, jump_s, -jump_s}) {
        link_.working = {works};
        wall_offset_s_ = jump;
        poll(bridge, 500);
      }
    return std::vector<std::size_t>{link_.tried.size(), link_.on("/event").size(), link_.on("/state").size(),
                                    link_.on("/visualization").size()};
  };
  const auto told = tried_and_told(0);
  for (const std::size_t count : told) EXPECT_GT(count, 2u);
  EXPECT_EQ(tried_and_told(86400), told);
}

TEST_F(BridgeTest, EventsBeforeTheFirstStepBearTheMarkThoughTheyWereHandedOver) {
  synchronised_ = false;
  Bridge bridge(params_, link_, now());
  bridge.take(change(1), now());
  poll(bridge, 3);
  ASSERT_EQ(link_.on("/event").size(), 1u);
  bridge.take(change(2), now());
  wall_offset_s_ = 3600;
  synchronised_ = true;
  poll(bridge, 2);
  bridge.take(change(3), now());
  poll(bridge, 2);
  const auto events = link_.on("/event");
  ASSERT_EQ(events.size(), 3u);
  const auto event = [&](int i) { return json::parse(events[i].payload)["epcisBody"]["eventList"][0]; };
  EXPECT_EQ(event(0).value("lodestar:clock", ""), "unsynchronised");
  EXPECT_FALSE(event(0).contains("lodestar:clockStep_s")) << "nobody knew it then";
  EXPECT_EQ(event(1).value("lodestar:clock", ""), "unsynchronised");
  EXPECT_NEAR(event(1).value("lodestar:clockStep_s", 0.0), 3600, 0.1);
  EXPECT_FALSE(event(2).contains("lodestar:clock"));
}

TEST_F(BridgeTest, AClockThatIsSetMarksTheEventsThatWaitInMemoryToo) {
  Bridge bridge(params_, link_, now());
  {
    SQLite::Database other(params_.store.path, SQLite::OPEN_READWRITE);
    SQLite::Transaction busy(other, SQLite::TransactionBehavior::IMMEDIATE);
    bridge.take(change(1), now());
    wall_offset_s_ = 3600;
    poll(bridge);
    EXPECT_EQ(bridge.in_memory(), 1u);
  }
  bridge.take(change(2), now());
  time_s_ += 1;
  poll(bridge, 3);
  const auto events = link_.on("/event");
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(json::parse(events[0].payload)["epcisBody"]["eventList"][0].value("lodestar:clock", ""), "unsynchronised");
  EXPECT_FALSE(json::parse(events[1].payload)["epcisBody"]["eventList"][0].contains("lodestar:clock"));
}

TEST_F(BridgeTest, AStoreThatBreaksWhileItRunsIsReplaced) {
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  for (int n = 1; n <= 4; ++n) bridge.take(change(n), now());
  poll(bridge);
  const std::string old_stream = bridge.store().stream();
  {
    // All but the first page; the commit of another makes the store read its pages anew.
    SQLite::Database other(params_.store.path, SQLite::OPEN_READWRITE);
    other.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    std::fstream file(params_.store.path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(4096);
    file << std::string(std::filesystem::file_size(params_.store.path) - 4096, '\xee') << std::flush;
    other.exec("PRAGMA user_version = 3");
  }
  for (int n = 5; n <= 30 && bridge.set_aside().empty(); ++n) {
    bridge.take(change(n), now());
    poll(bridge);
  }
  EXPECT_NE(bridge.set_aside(), "");
  EXPECT_NE(bridge.store().stream(), old_stream);
  EXPECT_GE(bridge.store_faults(), 1u);
  // The site hears of the new numbers, and they are delivered.
  const auto notice = stream_notice_from(link_.on("/stream").back().payload);
  ASSERT_TRUE(notice);
  EXPECT_EQ(notice->stream, bridge.store().stream());
  bridge.take(change(40), now());
  poll(bridge, 2);
  EXPECT_EQ(document_key_from(link_.on("/event").back().payload)->stream, bridge.store().stream());
}

TEST_F(BridgeTest, AnRTreeThatBreaksWhileItRunsCostsNoEvent) {
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  for (int n = 1; n <= 4; ++n) bridge.take(change(n), now());
  const std::string old_stream = bridge.store().stream();
  test::damage_rtree(params_.store.path);
  bridge.take(change(5), now());
  bridge.take(change(6), now());
  EXPECT_EQ(bridge.set_aside(), params_.store.path + ".corrupt-1");
  EXPECT_NE(bridge.store().stream(), old_stream);
  poll(bridge, 2);
  EXPECT_EQ(bridge.in_memory(), 0u);
  EXPECT_EQ(bridge.store().last_heard(), heard_event(change(6)));
  EXPECT_EQ(document_key_from(link_.on("/event").back().payload)->stream, bridge.store().stream());
}

TEST_F(BridgeTest, TelemetryFollowsTheTruck) {
  Bridge bridge(params_, link_, now());
  poll(bridge, 2);
  EXPECT_FALSE(json::parse(link_.on("/state").back().payload).contains("agvPosition"));
  PoseEstimate pose;
  for (int i = 0; i <= 100; ++i) {
    pose.stamp = now().wall;
    pose.T_map_base = Eigen::Translation3d(2 + 0.01 * i, 3, 0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
    bridge.telemetry().take_pose(pose, now().monotonic);
    bridge.telemetry().take_integrity(true, 0.1);
    poll(bridge);
  }
  EXPECT_FALSE(json::parse(link_.on("/state").back().payload).contains("loads")) << "nobody has told";
  bridge.telemetry().take_loads(std::vector<Pallet>{change(1).pallet});
  bridge.telemetry().take_battery({0.5, std::nullopt, true}, now().monotonic);
  poll(bridge);
  json state = json::parse(link_.on("/state").back().payload);
  EXPECT_EQ(state["batteryState"], json({{"batteryCharge", 50.0}, {"charging", true}}));
  EXPECT_EQ(state["information"].size(), 1u) << "of safetyState alone";
  EXPECT_EQ(link_.on("/state").back().qos, 0);
  EXPECT_EQ(state["operatingMode"], "MANUAL");
  EXPECT_EQ(state["driving"], true);
  EXPECT_EQ(state["agvPosition"]["positionInitialized"], true);
  EXPECT_NEAR(state["agvPosition"]["localizationScore"].get<double>(), 0.8, 1e-9);
  EXPECT_NEAR(state["agvPosition"]["deviationRange"].get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(state["agvPosition"]["theta"].get<double>(), 0.5, 1e-9);
  EXPECT_EQ(state["loads"][0]["loadId"], "106141412345678908");
  EXPECT_TRUE(state["errors"].empty());
  const auto visualizations = link_.on("/visualization");
  EXPECT_GE(visualizations.size(), 2u);

  // Nobody renews the pose.
  time_s_ += 10;
  poll(bridge, 2);
  state = json::parse(link_.on("/state").back().payload);
  EXPECT_EQ(state["errors"][0]["errorType"], "localizationLost");
  EXPECT_EQ(state["agvPosition"]["positionInitialized"], false);
  EXPECT_EQ(state["driving"], false);
  EXPECT_EQ(state["information"].size(), 2u) << "of safetyState and driving";
  EXPECT_EQ(state["batteryState"]["batteryCharge"], 50.0);
  // Nor the battery's charge: it is not known any more.
  time_s_ += 60;
  poll(bridge, 2);
  state = json::parse(link_.on("/state").back().payload);
  EXPECT_EQ(state["batteryState"], json({{"batteryCharge", 0.0}, {"charging", false}}));
  EXPECT_EQ(state["information"].size(), 3u);
  EXPECT_EQ(state["loads"].size(), 1u);
  bridge.telemetry().take_loads(std::vector<Pallet>{});
  poll(bridge);
  EXPECT_EQ(json::parse(link_.on("/state").back().payload)["loads"], json::array()) << "nothing on the fork";
  bridge.telemetry().take_loads(std::nullopt);
  poll(bridge);
  EXPECT_FALSE(json::parse(link_.on("/state").back().payload).contains("loads")) << "nobody knows";
}

TEST(BridgeParams, AllFaultsAtOnce) {
  BridgeParams params = test::bridge_params("");
  params.epcis = {"", "4012345000116", "map"};
  params.vda.serial = "a/b";
  params.brokers = 0;
  const std::string faults = describe(check(params, "/wms_bridge"));
  for (const char* word : {"giai", "gln", "coordinate_reference_system", "serial", "store", "brokers"})
    EXPECT_NE(faults.find(word), std::string::npos) << word << " in\n" << faults;
  EXPECT_TRUE(check(test::bridge_params("/tmp/x"), "").empty());
}

bool told_wrong(const BridgeParams& params, const std::string& key, const std::string& value) {
  return describe(check(params, "/wms_bridge")).find(key + ": is '" + value + "', must be") != std::string::npos;
}

TEST(BridgeParams, TheReferenceSystemIsAUri) {
  BridgeParams params = test::bridge_params("/tmp/x");
  const auto refused = [&](const std::string& text) {
    params.epcis.coordinate_reference_system = text;
    return told_wrong(params, "coordinate_reference_system", text);
  };
  for (const char* text : {"https://lodestar.example/crs/demo/map", "https://user@hall.example:8080/a?b=c/d#e",
                           "urn:ogc:def:crs:EPSG::4326", "urn:uuid:6ba7b810-9dad-11d1-80b4-00c04fd430c8",
                           "tag:hall-12,2026:map%20a", "file:///map", "x:"})
    EXPECT_FALSE(refused(text)) << text;
  const std::string long_uri = "https://a.example/" + std::string(100000, 'a');
  for (const std::string text :
       {"", "map", "hall 12: map", "urn:hall 12", "12:map", ":map", "h\xc3\xa4ll:map", "urn:h\xc3\xa4ll", "urn:a%2",
        "urn:a%zz", "urn:<a>", "urn:a#b#c", "http://a:b", "urn:a\n", long_uri.c_str()})
    EXPECT_TRUE(refused(text)) << text.substr(0, 80);
}

TEST(BridgeParams, WhatStandsInATopicIsUtf8) {
  BridgeParams params = test::bridge_params("/tmp/x");
  const auto refused = [&](const std::string& text) {
    params.vda.manufacturer = text;
    return told_wrong(params, "manufacturer", text);
  };
  for (const char* text : {"truck7", "Z\xc3\xbcge 7", "\"7\\", "\xf0\x9f\x9a\x9a"}) EXPECT_FALSE(refused(text)) << text;
  for (const char* text :
       {"", "a/b", "a+", "#", "$SYS", "a\nb", "a\x7f", "\xff\xfe", "a\xc3", "\xc0\xaf", "\xed\xa0\x80"})
    EXPECT_TRUE(refused(text)) << text;
}

TEST(BridgeParams, TheSerialNumberIsOneOfVda5050) {
  BridgeParams params = test::bridge_params("/tmp/x");
  const auto refused = [&](const std::string& text) {
    params.vda.serial = text;
    return told_wrong(params, "serial", text);
  };
  for (const char* text : {"truck7", "A-Z_a.z:09", "7"}) EXPECT_FALSE(refused(text)) << text;
  for (const std::string& text : {std::string(), std::string(65, 'a'), std::string("truck 7"), std::string("a/b"),
                                  std::string("$7"), std::string("Z\xc3\xbcge"), std::string("a\n")})
    EXPECT_TRUE(refused(text)) << text;
}

TEST(BridgeParams, TheVersionIsNumbersWithDotsBetween) {
  BridgeParams params = test::bridge_params("/tmp/x");
  const auto refused = [&](const std::string& text) {
    params.vda.version = text;
    return told_wrong(params, "vda_version", text);
  };
  for (const char* text : {"2", "2.1", "2.1.0", "10.0.12"}) EXPECT_FALSE(refused(text)) << text;
  for (const char* text : {"", "v2.1.0", "2.", ".2", "2..1", "#", "2/1.0", "2.1.0 ", "2.1.0\n"})
    EXPECT_TRUE(refused(text)) << text;
}

}  // namespace
}  // namespace lodestar
