// Everything that is recorded reaches the site once and in order, over real brokers that are killed, by a bridge that
// is killed.
#include <gtest/gtest.h>

#include <memory>
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

using test::Broker;
using test::mqtt;
using test::run_until;
using test::Worker;

const BackOff kQuick{from_seconds(0.05), from_seconds(0.2)};

/// A site of its own connection that remembers what it was handed.
struct Site {
  explicit Site(const std::string& broker, const std::string& client = "site") : link(mqtt(client, {broker})) {}

  void poll() { client.poll(test::clocks().monotonic); }
  void expect_all_once(std::uint64_t count) const {
    ASSERT_EQ(sequences.size(), count);
    for (std::uint64_t n = 1; n <= count; ++n) ASSERT_EQ(sequences[n - 1], n);
  }

  std::vector<std::uint64_t> sequences;
  MqttLink link;
  SiteClient client{link, 1, kQuick, "+", "+", [this](const std::string&, const std::string& document) {
                      sequences.push_back(document_key_from(document)->sequence);
                    }};
};

class Delivery : public testing::Test {
 protected:
  void SetUp() override {
    if (!Broker::installed()) GTEST_SKIP() << "mosquitto is not installed: nothing was delivered";
    folder_ = std::make_unique<test::TemporaryFolder>(test::TemporaryFolder::memory());
  }
  std::string store() const { return *folder_ / "wms.db"; }

  std::unique_ptr<test::TemporaryFolder> folder_;
};

TEST_F(Delivery, ThreeThousandEventsThroughTwoKilledBrokersAndAKilledBridge) {
  Broker broker;
  Site site(broker.uri());
  Worker worker(store(), "3000", broker.uri());
  const auto reached = [&](std::size_t count) {
    return run_until([&] { return site.sequences.size() >= count; }, [&] { site.poll(); });
  };
  ASSERT_TRUE(reached(500)) << site.sequences.size();
  broker.kill();
  broker.start();
  ASSERT_TRUE(reached(1200)) << site.sequences.size();
  worker.kill();
  worker.start();
  ASSERT_TRUE(reached(2000)) << site.sequences.size();
  broker.kill();
  broker.start();
  ASSERT_TRUE(reached(3000)) << site.sequences.size();
  // Stragglers would show up now.
  run_until([] { return false; }, [&] { site.poll(); }, 0.3);
  site.expect_all_once(3000);
}

TEST_F(Delivery, TenThousandEventsWaitForTheNetworkThenDrain) {
  Broker broker;
  broker.kill();
  MqttLink link(mqtt("truck7", {broker.uri()}));
  BridgeParams params = test::bridge_params(store());
  params.back_off = kQuick;
  Bridge bridge(params, link, test::clocks());
  for (int n = 1; n <= 10000; ++n) {
    bridge.take(test::change(n), test::clocks());
    if (n % 100 == 0) bridge.poll(test::clocks());
  }
  EXPECT_EQ(bridge.outbox().waiting(), 10000u);
  EXPECT_FALSE(bridge.connected());
  EXPECT_NE(bridge.last_failure(), "");

  broker.start();
  Site site(broker.uri());
  const bool drained = run_until([&] { return bridge.outbox().waiting() == 0; },
                                 [&] {
                                   bridge.poll(test::clocks());
                                   site.poll();
                                 });
  EXPECT_TRUE(drained) << bridge.outbox().waiting() << " " << bridge.last_failure();
  site.expect_all_once(10000);
}

TEST_F(Delivery, OneOfTwoBrokersDies) {
  auto first = std::make_unique<Broker>();
  Broker second;
  MqttLink link(mqtt("truck7", {first->uri(), second.uri()}));
  BridgeParams params = test::bridge_params(store());
  params.brokers = 2;
  params.back_off = kQuick;
  Bridge bridge(params, link, test::clocks());
  // A site listens at both brokers and keeps one list.
  std::set<std::uint64_t> kept;
  const auto keep = [&](const std::string&, const std::string& document) {
    EXPECT_TRUE(kept.insert(document_key_from(document)->sequence).second) << "twice";
  };
  MqttLink link_a(mqtt("site", {first->uri()})), link_b(mqtt("site", {second.uri()}));
  SiteClient site_a(link_a, 1, kQuick, "lodestar", "truck7", keep),
      site_b(link_b, 1, kQuick, "lodestar", "truck7", keep);
  int n = 0, recorded = 300;
  const auto step = [&] {
    if (n < recorded) bridge.take(test::change(++n), test::clocks());
    bridge.poll(test::clocks());
    site_a.poll(test::clocks().monotonic);
    site_b.poll(test::clocks().monotonic);
  };
  // All of it is acknowledged before the broker dies: two clients that share no numbers would else keep it twice.
  ASSERT_TRUE(run_until([&] { return bridge.outbox().acknowledged() == 300; }, step));
  EXPECT_EQ(bridge.broker(), 0u);
  first.reset();
  recorded = 600;
  ASSERT_TRUE(run_until([&] { return bridge.outbox().acknowledged() == 600; }, step)) << bridge.last_failure();
  EXPECT_EQ(bridge.broker(), 1u);
  EXPECT_EQ(kept.size(), 600u);
}

/// What became of a connection.
struct Outcome {
  bool up = false, down = false;
};
Outcome connect(const MqttParams& params) {
  MqttLink link(params);
  link.connect(0, {});
  Outcome outcome;
  run_until([&] { return outcome.up || outcome.down; },
            [&] {
              for (const LinkEvent& event : link.take()) {
                outcome.up |= std::holds_alternative<LinkUp>(event);
                outcome.down |= std::holds_alternative<LinkDown>(event);
              }
            },
            20);
  return outcome;
}

bool run(const std::string& command) { return std::system(("(" + command + ") >/dev/null 2>&1").c_str()) == 0; }

TEST_F(Delivery, CredentialsAreAsked) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(run("mosquitto_passwd -b -c " + folder / "passwords" + " truck7 secret && chmod 755 " + folder / "." +
                  " && chmod 644 " + folder / "passwords"));
  Broker broker("allow_anonymous false\npassword_file " + folder / "passwords");
  MqttParams params = mqtt("truck7", {broker.uri()});
  params.user = "truck7";
  params.password = "wrong";
  EXPECT_TRUE(connect(params).down);
  EXPECT_TRUE(connect(mqtt("truck7", {broker.uri()})).down) << "nobody in particular";
  params.password = "secret";
  EXPECT_TRUE(connect(params).up);
}

/// Brokers that speak TLS alone, each with a certificate that it signed itself.
class Tls : public Delivery {
 protected:
  void SetUp() override {
    Delivery::SetUp();
    if (!run("command -v openssl")) GTEST_SKIP() << "openssl, which makes the certificates, is not installed";
    ASSERT_TRUE(run("chmod 755 " + certificates_ / "."));
  }
  std::unique_ptr<Broker> broker(const std::string& name) {
    EXPECT_TRUE(
        run("openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -addext "
            "subjectAltName=DNS:localhost,IP:127.0.0.1 -keyout " +
            certificates_ / (name + ".key") + " -out " + certificates_ / (name + ".pem") + " && chmod 644 " +
            certificates_ / (name + ".key")));
    return std::make_unique<Broker>("allow_anonymous true\ncertfile " + certificates_ / (name + ".pem") + "\nkeyfile " +
                                    certificates_ / (name + ".key"));
  }
  static std::string uri(const Broker& broker) { return "ssl://localhost:" + std::to_string(broker.port()); }
  MqttParams trusting(const std::string& name, const std::string& client, std::vector<std::string> brokers) const {
    MqttParams params = mqtt(client, std::move(brokers));
    params.ca_file = certificates_ / (name + ".pem");
    return params;
  }

  test::TemporaryFolder certificates_;
};

TEST_F(Tls, ABrokerThatNobodyVouchesForIsRefused) {
  const auto known = broker("known"), stranger = broker("stranger");
  EXPECT_TRUE(connect(trusting("known", "truck7", {uri(*known)})).up);
  EXPECT_TRUE(connect(trusting("known", "truck7", {uri(*stranger)})).down);
  EXPECT_TRUE(connect(mqtt("truck7", {known->uri()})).down) << "no TLS";
}

TEST_F(Tls, AStrangerInTheListIsPassedOver) {
  const auto known = broker("known"), stranger = broker("stranger");
  MqttLink link(trusting("known", "truck7", {uri(*stranger), uri(*known)}));
  MqttLink site_link(trusting("known", "site", {uri(*known)}));
  BridgeParams params = test::bridge_params(store());
  params.brokers = 2;
  params.back_off = kQuick;
  Bridge bridge(params, link, test::clocks());
  std::size_t kept = 0;
  SiteClient site(site_link, 1, kQuick, "+", "+", [&](const std::string&, const std::string&) { ++kept; });
  for (int n = 1; n <= 20; ++n) bridge.take(test::change(n), test::clocks());
  EXPECT_TRUE(run_until([&] { return bridge.outbox().acknowledged() == 20; },
                        [&] {
                          bridge.poll(test::clocks());
                          site.poll(test::clocks().monotonic);
                        },
                        20))
      << bridge.last_failure();
  EXPECT_EQ(bridge.broker(), 1u);
  EXPECT_EQ(kept, 20u);
}

}  // namespace
}  // namespace lodestar
