// The bridge as a node: from /pallets/events to a site over a broker of the test's own.
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/BatteryState.h>
#include <signal.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lodestar/LoadState.h"
#include "lodestar/PalletArray.h"
#include "lodestar/PalletEvent.h"
#include "lodestar/PalletEventsAfter.h"
#include "lodestar/PoseIntegrity.h"
#include "lodestar/ros/convert/message_drop.hpp"
#include "lodestar/ros/convert/pallet.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/nodelets/wms_params.hpp"
#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/mqtt_link.hpp"
#include "lodestar/wms/outbox.hpp"
#include "lodestar/wms/site_client.hpp"
#include "lodestar/wms/site_messages.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/node_process.hpp"
#include "ros/support/waiting.hpp"
#include "support/broker.hpp"
#include "support/pallet_changes.hpp"
#include "support/real_time.hpp"
#include "support/rtree_damage.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace lodestar;
using lodestar::test::change;
using lodestar::test::Diagnostics;
using lodestar::test::NodeProcess;
using lodestar::test::wait_for;
using nlohmann::json;

const char* const kNode = "wms_bridge";
const char* const kTracking = "pallet_tracking";

class WmsBridge : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::Broker::installed()) GTEST_SKIP() << "mosquitto is not installed";
    broker_ = std::make_unique<test::Broker>();
    set_parameters();
    MqttParams mqtt;
    mqtt.brokers = {broker_->uri()};
    mqtt.client_id = "site";
    site_ = std::make_unique<SiteClient>(
        link_to_each(mqtt), BackOff{from_seconds(0.05), from_seconds(0.2)}, "lodestar", "truck7",
        [this](const std::string&, const std::string& document) { arrived_.push_back(json::parse(document)); });
    mqtt.client_id = "master_control";
    vda_ = std::make_unique<MqttLink>(mqtt);
    vda_->connect(0, {});
  }

  void set_parameters() {
    ros::param::del("/wms_bridge");
    const auto set = [](const std::string& key, const auto& value) { ros::param::set("/wms_bridge/" + key, value); };
    set("site", ros::param::param<std::string>("/site", ""));
    set("store", folder_ / "wms.db");
    set("manufacturer", "lodestar");
    set("serial", "truck7");
    set("giai", "4012345TRUCK7");
    set("gln", "4012345000115");
    set("coordinate_reference_system", "https://hall-12.example/crs/map");
    set("brokers", std::vector<std::string>{broker_->uri()});
    set("back_off_first_s", 0.05);
    set("back_off_at_most_s", 0.2);
    set("state_period_s", 0.2);
  }

  bool until(const std::function<bool()>& condition, double limit_s = 60) {
    return wait_for(
        [&] {
          site_->poll(test::clocks().monotonic);
          for (const LinkEvent& event : vda_->take()) {
            if (std::holds_alternative<LinkUp>(event)) vda_->subscribe("uagv/v2/lodestar/truck7/#", 0);
            if (std::holds_alternative<LinkDown>(event)) vda_->connect(0, {});
            if (const auto* message = std::get_if<MqttMessage>(&event))
              vda_heard_[message->topic.substr(message->topic.rfind('/') + 1)] = json::parse(message->payload);
          }
          return condition();
        },
        limit_s);
  }
  /// Empty before it was heard.
  std::string vda_said(const std::string& topic, const std::string& key) const {
    const auto heard = vda_heard_.find(topic);
    return heard == vda_heard_.end() ? "" : heard->second.value(key, "");
  }
  bool counted(const std::string& key, long at_least) {
    return until([&] { return diagnostics_.count(kNode, key) >= at_least; });
  }
  bool says(const std::string& words, int at_least = diagnostic_msgs::DiagnosticStatus::ERROR) {
    return until([&] {
      return diagnostics_.message(kNode).find(words) != std::string::npos && diagnostics_.level(kNode) >= at_least;
    });
  }
  void publish(int first, int last) {
    for (int n = first; n <= last; ++n) events_.publish(pallet_event_message(change(n), "map"));
  }
  void expect_arrived(std::size_t count) {
    ASSERT_TRUE(until([&] { return arrived_.size() >= count; }))
        << arrived_.size() << "; recorded " << diagnostics_.value(kNode, "recorded") << ", in memory "
        << diagnostics_.value(kNode, "in memory") << ", on their way " << diagnostics_.value(kNode, "on their way")
        << ", missed " << diagnostics_.value(kNode, "missed") << ", " << diagnostics_.message(kNode);
    for (std::size_t i = 0; i < arrived_.size(); ++i) EXPECT_EQ(arrived_[i]["lodestar:sequence"], i + 1);
    EXPECT_EQ(arrived_.size(), count);
  }

  test::TemporaryFolder folder_;
  ros::NodeHandle nh_;
  Diagnostics diagnostics_{nh_};
  ros::Publisher events_ = nh_.advertise<PalletEvent>("/pallets/events", 1000);
  ros::Publisher state_ = nh_.advertise<PalletArray>("/pallets/state", 1, true);
  ros::Publisher pose_ = nh_.advertise<geometry_msgs::PoseWithCovarianceStamped>("/pose", 100);
  ros::Publisher battery_ = nh_.advertise<sensor_msgs::BatteryState>("/battery", 1, true);
  ros::Publisher integrity_ = nh_.advertise<PoseIntegrity>("/pose/integrity", 1);
  std::unique_ptr<test::Broker> broker_;
  std::unique_ptr<MqttLink> vda_;
  std::unique_ptr<SiteClient> site_;
  std::vector<json> arrived_;
  std::map<std::string, json> vda_heard_;
};

TEST_F(WmsBridge, EveryEventArrivesOnceWhateverDies) {
  auto node = std::make_unique<NodeProcess>(kNode, folder_ / "node.log");
  ASSERT_TRUE(until([&] { return events_.getNumSubscribers() > 0; })) << node->output();
  publish(1, 30);
  expect_arrived(30);
  EXPECT_TRUE(counted("acknowledged", 30));
  EXPECT_EQ(diagnostics_.value(kNode, "broker"), broker_->uri());
  EXPECT_EQ(diagnostics_.hardware_id(kNode), "truck7");

  broker_->kill();
  publish(31, 60);
  EXPECT_TRUE(counted("recorded", 60));
  EXPECT_TRUE(until([&] { return diagnostics_.message(kNode).find("no broker") != std::string::npos; }));
  node->end(SIGKILL);
  broker_->start();
  node = std::make_unique<NodeProcess>(kNode, folder_ / "node.log");
  expect_arrived(60);

  // What it cannot use, and what it misses, it says.
  ASSERT_TRUE(until([&] { return events_.getNumSubscribers() > 0; }));
  PalletEvent wrong = pallet_event_message(change(61), "odom");
  events_.publish(wrong);
  EXPECT_TRUE(counted(std::string("dropped: ") + name(MessageDrop::kFrame), 1));
  publish(64, 64);
  EXPECT_TRUE(counted("missed", 2));
  EXPECT_TRUE(until([&] { return diagnostics_.message(kNode).find("not heard") != std::string::npos; }));
  wrong = pallet_event_message(change(65), "map");
  wrong.pallet.id = "'; DROP TABLE event; --";
  events_.publish(wrong);
  EXPECT_TRUE(counted(std::string("dropped: ") + name(BridgeDrop::kPalletId), 1));
  expect_arrived(61);
  EXPECT_EQ(diagnostics_.count(kNode, "missed"), 2) << "what is of no use was heard";
  EXPECT_TRUE(WIFEXITED(node->end(SIGINT)));
  EXPECT_TRUE(until([&] { return vda_said("connection", "connectionState") == "OFFLINE"; }));
}

/// The truck's own pallet tracking beside the bridge.
class Tracking {
 public:
  Tracking(ros::NodeHandle& nh, const test::TemporaryFolder& folder, Diagnostics& diagnostics)
      : log_(folder / "tracking.log"), diagnostics_(diagnostics) {
    pose_ = nh.advertise<geometry_msgs::PoseWithCovarianceStamped>("/pose", 100);
    load_ = nh.advertise<LoadState>("/load", 100);
    ros::param::del("/pallet_tracking");
    for (const std::string key : {"site", "vehicle"})
      ros::param::set("/pallet_tracking/" + key, ros::param::param<std::string>("/pallet_" + key, ""));
    ros::param::set("/pallet_tracking/memory", folder / "pallets");
    ros::param::set("/pallet_tracking/diagnostic_period", 0.1);
  }

  /// @param bridges that listen to poses, too
  void start(std::uint32_t bridges, const std::string& preloaded = "") {
    EXPECT_TRUE(wait_for([&] { return load_.getNumSubscribers() == 0 && pose_.getNumSubscribers() == bridges; }))
        << "of an earlier life";
    diagnostics_.forget(kTracking);
    poses_ = loads_ = 0;
    node_ = std::make_unique<NodeProcess>(kTracking, log_, preloaded);
    EXPECT_TRUE(wait_for([&] { return load_.getNumSubscribers() > 0 && pose_.getNumSubscribers() == bridges + 1; }))
        << log_;
  }
  int end(int signal) { return node_->end(signal); }
  int join() { return node_->join(); }

  /// Half a second of samples: the fork takes what is here, or lets go of it. Its time, of which the stamps alone tell.
  void work(bool present) {
    constexpr int kSamples = 12;
    constexpr std::chrono::milliseconds kStep(40);
    const Stamp began = now_;
    EXPECT_TRUE(all_is_taken());
    for (int i = 0; i < kSamples; ++i, ++poses_) {
      PoseEstimate pose;
      pose.stamp = now_ += kStep;
      pose.covariance.diagonal().setConstant(1e-6);
      pose_.publish(pose_estimate_message(pose, "map"));
    }
    EXPECT_TRUE(all_is_taken());  // the two topics are two connections
    for (int i = 1; i <= kSamples; ++i, ++loads_) {
      LoadState load;
      load.header.stamp = ros_time(began + i * kStep);
      load.header.frame_id = "fork";
      load.load_present = present;
      load_.publish(load);
    }
  }

 private:
  /// The node had time for all that it was told.
  bool all_is_taken() {
    return wait_for([&] {
      return diagnostics_.count(kTracking, "pose count") == poses_ &&
             diagnostics_.count(kTracking, "load count") == loads_;
    });
  }

  std::string log_;
  Diagnostics& diagnostics_;
  std::unique_ptr<NodeProcess> node_;
  long poses_ = 0, loads_ = 0;  ///< that were told to the node
  Stamp now_ = test::clocks().wall;
  ros::Publisher pose_, load_;
};

TEST_F(WmsBridge, AnEventThatWasWrittenDownIsToldWhoeverDies) {
  auto bridge = std::make_unique<NodeProcess>(kNode, folder_ / "node.log");
  Tracking tracking(nh_, folder_, diagnostics_);
  tracking.start(1);
  tracking.work(false);
  tracking.work(true);
  expect_arrived(1);

  // Killed after the drop was written down, before it was told.
  tracking.end(SIGKILL);
  tracking.start(1, LODESTAR_DIE_AFTER_RENAME);
  tracking.work(true);
  tracking.work(false);
  const int status = tracking.join();
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  EXPECT_FALSE(until([&] { return arrived_.size() > 1; }, 1)) << "it was told after all";
  tracking.start(1);
  expect_arrived(2);
  EXPECT_EQ(arrived_[1]["epcisBody"]["eventList"][0]["action"], "DELETE");

  // Told while there was no bridge.
  bridge->end(SIGKILL);
  tracking.work(false);
  tracking.work(true);
  tracking.work(false);
  bridge = std::make_unique<NodeProcess>(kNode, folder_ / "node.log");
  expect_arrived(4);
  EXPECT_EQ(diagnostics_.count(kNode, "missed"), 0);

  // Told while there was no bridge, under numbers that began anew: fewer than it had heard, as many, more.
  std::size_t arrived = 4;
  for (const int moves : {1, 1, 2}) {
    bridge->end(SIGKILL);
    tracking.end(SIGKILL);
    std::filesystem::remove(folder_ / "pallets");
    tracking.start(0);
    tracking.work(false);
    for (int i = 0; i < moves; ++i) {
      tracking.work(true);
      tracking.work(false);
    }
    bridge = std::make_unique<NodeProcess>(kNode, folder_ / "node.log");
    expect_arrived(arrived += 2 * moves);
  }
}

TEST_F(WmsBridge, AGapIsAskedForUntilItIsAnsweredAndNoLonger) {
  int oldest = 1, newest = 6, asked = 0;
  bool answers = false;
  using Request = PalletEventsAfter::Request;
  using Response = PalletEventsAfter::Response;
  const boost::function<bool(Request&, Response&)> after = [&](Request& request, Response& response) {
    ++asked;
    for (int n = std::max(oldest, static_cast<int>(request.sequence) + 1); n <= newest; ++n)
      response.events.push_back(pallet_event_message(change(n), n == 7 ? "odom" : "map"));
    return answers;
  };
  const auto tell_state = [&] {
    PalletArray state;
    state.header.frame_id = "map";
    state.last_event = newest;
    state_.publish(state);
  };
  ros::ServiceServer service = nh_.advertiseService("/pallets/events_after", after);
  tell_state();
  NodeProcess node(kNode, folder_ / "node.log");
  ASSERT_TRUE(until([&] { return events_.getNumSubscribers() > 0 && asked > 0; })) << node.output();
  publish(6, 6);
  EXPECT_TRUE(counted("waiting for earlier ones", 1));
  EXPECT_TRUE(
      says("pallet tracking does not tell the events before the newest", diagnostic_msgs::DiagnosticStatus::WARN));
  EXPECT_TRUE(until([&] { return asked >= 2; })) << asked;
  EXPECT_TRUE(arrived_.empty()) << "with a gap before it";
  answers = true;
  expect_arrived(6);

  // The newest event is no use: it is counted and asked for once.
  newest = 7;
  tell_state();
  EXPECT_TRUE(counted(std::string("dropped: ") + name(MessageDrop::kFrame), 1));
  const int before = asked;
  EXPECT_FALSE(until([&] { return asked > before; }, 2.5));
  publish(8, 8);
  EXPECT_TRUE(until([&] { return arrived_.size() == 7; }));
  EXPECT_TRUE(counted("recorded", 7));
  EXPECT_EQ(diagnostics_.count(kNode, std::string("dropped: ") + name(MessageDrop::kFrame)), 1);
  EXPECT_EQ(diagnostics_.count(kNode, "missed"), 0);

  // Nobody has 9 to 11 any more.
  oldest = newest = 12;
  publish(12, 12);
  EXPECT_TRUE(says("3 pallet events were not heard", diagnostic_msgs::DiagnosticStatus::WARN));
  EXPECT_TRUE(until([&] { return arrived_.size() == 8; }));
}

TEST_F(WmsBridge, ADamagedStoreBeginsAnewInTheOrderOfWhatHappened) {
  int newest = 0;
  const boost::function<bool(PalletEventsAfter::Request&, PalletEventsAfter::Response&)> after =
      [&](PalletEventsAfter::Request& request, PalletEventsAfter::Response& response) {
        for (int n = static_cast<int>(request.sequence) + 1; n <= newest; ++n)
          response.events.push_back(pallet_event_message(change(n), "map"));
        return true;
      };
  ros::ServiceServer service = nh_.advertiseService("/pallets/events_after", after);
  const auto happens = [&](int first, int last) {
    PalletArray state;
    state.header.frame_id = "map";
    state.last_event = newest = last;
    state_.publish(state);
    publish(first, last);
  };
  happens(1, 0);
  NodeProcess node(kNode, folder_ / "node.log");
  ASSERT_TRUE(until([&] { return events_.getNumSubscribers() > 0; })) << node.output();
  happens(1, 4);
  expect_arrived(4);

  test::damage_rtree(folder_ / "wms.db");
  happens(5, 7);
  ASSERT_TRUE(until([&] { return arrived_.size() >= 4 + 7; })) << arrived_.size();
  const auto told_at = [&](std::size_t i) { return arrived_[i]["epcisBody"]["eventList"][0]["eventTime"]; };
  for (std::size_t n = 1; n <= 7; ++n) EXPECT_EQ(arrived_[3 + n]["lodestar:sequence"], n);
  for (std::size_t n = 1; n <= 4; ++n) EXPECT_EQ(told_at(3 + n), told_at(n - 1)) << n;
  for (std::size_t n = 2; n <= 7; ++n) EXPECT_GT(told_at(3 + n), told_at(2 + n)) << n;
  EXPECT_EQ(diagnostics_.count(kNode, "missed"), 0);
}

TEST_F(WmsBridge, SaysWhatIsWrongWithItsStore) {
  std::ofstream(folder_ / "wms.db") << std::string(10000, 'x');
  ros::param::set("/wms_bridge/store_max_mib", 1);
  NodeProcess node(kNode, folder_ / "node.log");
  EXPECT_TRUE(says("a damaged store was set aside: " + folder_ / "wms.db.corrupt-1")) << node.output();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "wms.db.corrupt-1"));

  const std::string stream = diagnostics_.value(kNode, "stream");
  EXPECT_TRUE(until([&] {  // beyond all that follows: one that comes late must not be true by then
    vda_->publish({site_topics("lodestar", "truck7").ack, message_text(Acknowledgement{stream, 1000}), 1, false});
    return diagnostics_.count(kNode, std::string("dropped: ") + name(AckDrop::kAhead)) > 0;
  }));
  EXPECT_TRUE(says("the site acknowledged events that were never sent"));

  ASSERT_TRUE(until([&] { return events_.getNumSubscribers() > 0; }));
  broker_->kill();
  constexpr int kTooMany = 150;
  for (int n = 1; n <= kTooMany; ++n) {
    PalletChange large = change(n);
    large.pallet.type = std::string(10000, 'x');
    events_.publish(pallet_event_message(large, "map"));
  }
  EXPECT_TRUE(says("the store takes no events: they wait in memory"));
  EXPECT_TRUE(counted("in memory", 1));
  broker_->start();
  expect_arrived(kTooMany);
  EXPECT_TRUE(until([&] { return diagnostics_.message(kNode).find("takes no events") == std::string::npos; }));
}

TEST_F(WmsBridge, TellsTheTrucksState) {
  NodeProcess node(kNode, folder_ / "node.log");
  ASSERT_TRUE(until([&] { return pose_.getNumSubscribers() > 0 && integrity_.getNumSubscribers() > 0; }));
  PalletArray pallets;
  pallets.header.frame_id = "map";
  for (const int n : {1, 4}) pallets.pallets.push_back(pallet_message(change(n).pallet));
  state_.publish(pallets);
  sensor_msgs::BatteryState charge;
  charge.percentage = 0.5F;
  battery_.publish(charge);
  PoseIntegrity integrity;
  integrity.mode = PoseIntegrity::TRACKING;
  integrity.protection_level_m = 0.25;
  PoseEstimate pose;
  pose.T_map_base = Eigen::Translation3d(3, 4, 0);
  EXPECT_TRUE(until([&] {
    pose.stamp = test::clocks().wall;
    pose_.publish(pose_estimate_message(pose, "map"));
    integrity_.publish(integrity);
    const json& state = vda_heard_["state"];
    return state.contains("agvPosition") && state["agvPosition"]["positionInitialized"] == true;
  })) << vda_heard_["state"].dump();
  const json& state = vda_heard_["state"];
  EXPECT_EQ(state["agvPosition"]["mapId"], "test-hall");
  EXPECT_EQ(state["agvPosition"]["x"], 3.0);
  EXPECT_EQ(state["agvPosition"]["localizationScore"], 0.5);
  const auto drops = [&](double level_m, MessageDrop reason) {
    integrity.protection_level_m = level_m;
    integrity_.publish(integrity);
    return counted(std::string("dropped: ") + name(reason), 1);
  };
  EXPECT_TRUE(drops(std::numeric_limits<double>::quiet_NaN(), MessageDrop::kNotFinite));
  EXPECT_TRUE(drops(-0.1, MessageDrop::kRange));
  ASSERT_TRUE(until([&] { return state["loads"].size() == 1; })) << state.dump();
  EXPECT_EQ(state["loads"][0]["loadId"], "106141412345678908");

  // What is lifted is a load, although nobody knows which pallet it is; what stands in doubt is none.
  PalletChange doubtful = change(5);
  doubtful.pallet.state = PalletState::kUncertain;
  doubtful.pallet.sscc.clear();
  pallets.pallets = {pallet_message(doubtful.pallet), pallet_message(test::uncertain().pallet)};
  pallets.pallets[1].id = test::uuid(7);
  events_.publish(pallet_event_message(doubtful, "map"));
  EXPECT_TRUE(counted("recorded", 1));
  state_.publish(pallets);
  EXPECT_TRUE(until([&] {
    const json& loads = vda_heard_["state"]["loads"];
    return loads.size() == 1 && loads[0]["loadId"] == "urn:uuid:" + doubtful.pallet.id;
  })) << vda_heard_["state"].dump();
  events_.publish(pallet_event_message(test::uncertain(), "map"));
  EXPECT_TRUE(counted("recorded", 2));
  state_.publish(pallets);
  EXPECT_TRUE(until([&] { return vda_heard_["state"]["loads"].empty(); })) << vda_heard_["state"].dump();
  EXPECT_TRUE(until([&] { return vda_heard_["state"]["batteryState"]["batteryCharge"] == 50.0; }));
  EXPECT_TRUE(until([&] { return vda_said("connection", "connectionState") == "ONLINE"; }));
  EXPECT_TRUE(until([&] { return vda_said("factsheet", "version") == "2.1.0"; }));
  EXPECT_TRUE(until([&] { return vda_heard_.count("visualization") > 0; }));
  // Nobody tells the pose any more.
  EXPECT_TRUE(until([&] { return !vda_heard_["state"]["errors"].empty(); }));
  EXPECT_EQ(vda_heard_["state"]["errors"][0]["errorType"], "localizationLost");
}

TEST_F(WmsBridge, ShowsTheBrokerItsUserAndPassword) {
  const std::string passwords = folder_ / "passwords", secret = folder_ / "secret";
  ASSERT_EQ(std::system(("mosquitto_passwd -b -c " + passwords + " truck7 secret && chmod 755 " + folder_ / "." +
                         " && chmod 644 " + passwords)
                            .c_str()),
            0);
  const test::Broker asks("allow_anonymous false\npassword_file " + passwords);
  std::ofstream(secret) << "secret\n";
  ros::param::set("/wms_bridge/brokers", std::vector<std::string>{asks.uri()});
  ros::param::set("/wms_bridge/user", "truck7");
  ros::param::set("/wms_bridge/password_file", secret);
  NodeProcess node(kNode, folder_ / "node.log");
  EXPECT_TRUE(until([&] { return diagnostics_.value(kNode, "broker") == asks.uri(); })) << node.output();
}

TEST_F(WmsBridge, AWrongStartListsAllFaults) {
  ros::param::set("/wms_bridge/gln", "4012345000116");
  ros::param::set("/wms_bridge/serial", "truck/7");
  ros::param::set("/wms_bridge/brokers", "tcp://localhost");
  ros::param::set("/wms_bridge/window", 0);
  ros::param::set("/wms_bridge/no_such_thing", 1);
  for (const char* key : {"password_file", "ca_file", "certificate_file", "key_file"})
    ros::param::set(std::string("/wms_bridge/") + key, std::string("/no/such/") + key);
  NodeProcess node(kNode, folder_ / "node.log");
  const int status = node.join();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == EXIT_FAILURE);
  for (const char* fault : {"gln: is '4012345000116'", "serial: is 'truck/7'", "brokers: is a text, must be a list",
                            "window: is 0, must be at least 1", "no_such_thing: is no parameter",
                            "/no/such/password_file' cannot be read", "/no/such/ca_file' cannot be read",
                            "/no/such/certificate_file' cannot be read", "/no/such/key_file' cannot be read"})
    EXPECT_NE(node.output().find(fault), std::string::npos) << fault << " in\n" << node.output();
}

TEST(WmsBridgeConfig, WhatTheBrokerIsShownReachesTheLink) {
  const test::TemporaryFolder folder;
  ros::param::set("/shown/user", "truck7");
  std::ofstream(folder / "password_file") << "secret\nanother line\n";
  ros::param::set("/shown/password_file", folder / "password_file");
  for (const std::string key : {"ca_file", "certificate_file", "key_file"}) {
    std::ofstream(folder / key) << "PEM";
    ros::param::set("/shown/" + key, folder / key);
  }
  ParamReader reader(ros::NodeHandle("/shown"));
  const MqttParams mqtt = read_wms_setup(reader, Site(), "/shown").mqtt;
  EXPECT_EQ(mqtt.user, "truck7");
  EXPECT_EQ(mqtt.password, "secret");
  EXPECT_EQ(mqtt.ca_file, folder / "ca_file");
  EXPECT_EQ(mqtt.certificate_file, folder / "certificate_file");
  EXPECT_EQ(mqtt.key_file, folder / "key_file");
}

TEST(WmsBridgeConfig, TheDemosIsWhole) {
  ros::param::set("/demo/store", "/tmp/wms.db");
  ParamReader reader(ros::NodeHandle("/demo"));
  const WmsSetup setup = read_wms_setup(reader, Site(), "/demo");
  EXPECT_TRUE(reader.faults().empty()) << describe(reader.faults());
  EXPECT_EQ(setup.mqtt.brokers.size(), 1u);
}

}  // namespace
