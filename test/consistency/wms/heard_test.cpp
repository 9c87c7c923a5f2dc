// What a site and a master control hear of a bridge over a real broker: how it is sent, and that the official schemas
// allow it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/mqtt_link.hpp"
#include "lodestar/wms/site_client.hpp"
#include "support/bridge_params.hpp"
#include "support/bridge_process.hpp"
#include "support/broker.hpp"
#include "support/pallet_changes.hpp"
#include "support/real_time.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using test::change;
using test::run_until;

/// Hears all VDA 5050 topics as they are sent: a subscription of QoS 2 lowers no QoS.
class MasterControl {
 public:
  MasterControl(const std::string& broker, const std::string& client) : link_(test::mqtt(client, {broker})) {
    link_.connect(0, {});
    EXPECT_TRUE(run_until([&] { return up_; }, [&] { poll(); }));
  }

  void poll() {
    for (const LinkEvent& event : link_.take()) {
      if (std::holds_alternative<LinkUp>(event)) up_ = true, link_.subscribe("uagv/v2/lodestar/truck7/#", 2);
      if (std::holds_alternative<LinkDown>(event)) link_.connect(0, {});
      if (const auto* message = std::get_if<MqttMessage>(&event)) heard.push_back(*message);
    }
  }
  /// The newest message on a topic holds this.
  bool says(const std::string& topic, const std::string& word) const {
    const MqttMessage* last = newest(topic);
    return last != nullptr && last->payload.find(word) != std::string::npos;
  }
  /// It comes to hold this.
  bool hears(const std::string& topic, const std::string& word) {
    return run_until([&] { return says(topic, word); }, [&] { poll(); });
  }
  const MqttMessage* newest(const std::string& topic) const {
    for (auto it = heard.rbegin(); it != heard.rend(); ++it)
      if (level(*it) == topic) return &*it;
    return nullptr;
  }
  static std::string level(const MqttMessage& message) { return message.topic.substr(message.topic.rfind('/') + 1); }

  std::vector<MqttMessage> heard;

 private:
  bool up_ = false;
  MqttLink link_;
};

/// Each kind of thing that can happen, its number being its place.
std::vector<PalletChange> all_kinds() {
  std::vector<PalletChange> out = {
      change(1),         change(2), test::correction(PalletState::kStanding), test::gone(), change(5),
      test::uncertain(), change(6), test::correction(PalletState::kGone)};
  PalletChange odd = change(2);
  odd.pallet.zone = "Tor 3 <links>";
  out.push_back(odd);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].sequence = i + 1;
    out[i].stamp = test::at(static_cast<double>(i));
  }
  return out;
}

class Heard : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::Broker::installed()) GTEST_SKIP() << "mosquitto is not installed: nothing was heard";
    broker_ = std::make_unique<test::Broker>();
  }
  void keep(const std::string& name, const std::string& text) { std::ofstream(folder_ / (name + ".json")) << text; }
  /// @return exit code: 77 says that the schema, or what reads it, is missing
  int check(const std::string& kind, const std::string& schemas) {
    const std::string command =
        "timeout 600 " LODESTAR_SCHEMAS_TEST " " + kind + " " + folder_ / "" + " '" + schemas + "'";
    return WEXITSTATUS(std::system(command.c_str()));
  }

  test::TemporaryFolder folder_{test::TemporaryFolder::memory()};
  std::unique_ptr<test::Broker> broker_;
};

TEST_F(Heard, EveryKindOfDocumentIsValid) {
  MqttLink link(test::mqtt("truck7", {broker_->uri()}));
  Bridge bridge(test::bridge_params(folder_ / "wms.db"), link, test::clocks());
  std::size_t kept = 0;
  SiteClient site(
      link_to_each(test::mqtt("site", {broker_->uri()})), BackOff(), "lodestar", "truck7",
      [&](const std::string&, const std::string& document) { keep("epcis_" + std::to_string(++kept), document); });
  const auto changes = all_kinds();
  for (const PalletChange& each : changes) bridge.take(each, test::clocks());
  ASSERT_TRUE(run_until([&] { return kept == changes.size(); },
                        [&] {
                          bridge.poll(test::clocks());
                          site.poll(test::clocks().monotonic);
                        }));
  const int verdict = check("epcis", LODESTAR_EPCIS_SCHEMA);
  if (verdict == 77) GTEST_SKIP() << "docs/wms_integration.md says how to name the schema";
  EXPECT_EQ(verdict, 0);
}

TEST_F(Heard, TheTrucksStateIsSentAsVda5050Wants) {
  MasterControl control(broker_->uri(), "control");
  {
    MqttLink link(test::mqtt("truck7", {broker_->uri()}));
    BridgeParams params = test::bridge_params(folder_ / "wms.db");
    params.vda.state_period_s = params.vda.visualization_period_s = 0.1;
    Bridge bridge(params, link, test::clocks());
    const auto until = [&](const std::function<bool()>& done) {
      return run_until(done, [&] {
        PoseEstimate pose;
        pose.stamp = test::clocks().wall;
        bridge.telemetry().take_pose(pose, test::clocks().monotonic);
        bridge.poll(test::clocks());
        control.poll();
      });
    };
    ASSERT_TRUE(until([&] { return control.newest("state") != nullptr; }));
    bridge.telemetry().take_integrity(true, 0.1);
    bridge.telemetry().take_loads(std::vector<Pallet>{change(1).pallet, change(5).pallet});
    bridge.telemetry().take_battery({0.5, 48.5, false}, test::clocks().monotonic);
    ASSERT_TRUE(until([&] { return control.says("visualization", "agvPosition"); }));
    EXPECT_TRUE(until([&] { return control.says("state", "loadId"); }));

    MasterControl late(broker_->uri(), "late");
    EXPECT_TRUE(late.hears("connection", "\"ONLINE\""));
    EXPECT_TRUE(late.hears("factsheet", "seriesName"));
    for (const MqttMessage& message : late.heard) {
      const std::string level = MasterControl::level(message);
      EXPECT_EQ(message.retained, level == "connection" || level == "factsheet") << message.topic;
    }
    bridge.shut_down(test::clocks());
  }
  EXPECT_TRUE(control.hears("connection", "\"OFFLINE\""));
  test::Worker worker(folder_ / "worker.db", "1", broker_->uri());
  EXPECT_TRUE(control.hears("connection", "\"ONLINE\""));
  worker.kill();
  EXPECT_TRUE(control.hears("connection", "\"CONNECTIONBROKEN\""));
  EXPECT_TRUE(MasterControl(broker_->uri(), "later").hears("connection", "\"CONNECTIONBROKEN\"")) << "not retained";
  worker.start();
  EXPECT_TRUE(control.hears("connection", "\"ONLINE\""));

  std::set<std::string> levels;
  for (std::size_t i = 0; i < control.heard.size(); ++i) {
    const MqttMessage& message = control.heard[i];
    const std::string level = MasterControl::level(message);
    EXPECT_EQ(message.qos, level == "connection" ? 1 : 0) << message.topic;
    levels.insert(level);
    keep("vda5050_" + level + "_" + std::to_string(i), message.payload);
  }
  EXPECT_EQ(levels, (std::set<std::string>{"connection", "factsheet", "state", "visualization"}));
  const int verdict = check("vda5050", LODESTAR_SOURCE_DIR "/test/data/vda5050-2.1.0");
  if (verdict == 77) GTEST_SKIP() << "python3-jsonschema or python3-rfc3987 is not installed";
  EXPECT_EQ(verdict, 0);
}

}  // namespace
}  // namespace lodestar
