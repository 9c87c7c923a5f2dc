// Everything that is recorded reaches the site once and in order, over real brokers that are killed, by a bridge that
// is killed.
#include <gtest/gtest.h>

#include <memory>

#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/mqtt_link.hpp"
#include "lodestar/wms/site_client.hpp"
#include "support/bridge_params.hpp"
#include "support/bridge_process.hpp"
#include "support/broker.hpp"
#include "support/pallet_changes.hpp"
#include "support/real_time.hpp"
#include "support/site.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using test::Broker;
using test::kQuick;
using test::mqtt;
using test::run_until;
using test::Site;
using test::Worker;

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
  Site site({broker.uri()});
  Worker worker(store(), "3000", broker.uri());
  const auto reached = [&](std::size_t count) {
    return run_until([&] { return site.documents.size() >= count; }, [&] { site.poll(); });
  };
  ASSERT_TRUE(reached(500)) << site.documents.size();
  broker.kill();
  broker.start();
  ASSERT_TRUE(reached(1200)) << site.documents.size();
  worker.kill();
  worker.start();
  ASSERT_TRUE(reached(2000)) << site.documents.size();
  broker.kill();
  broker.start();
  ASSERT_TRUE(reached(3000)) << site.documents.size();
  // Stragglers would show up now.
  run_until([] { return false; }, [&] { site.poll(); }, 0.3);
  site.expect_all_once(3000);
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
            });
  return outcome;
}

TEST_F(Delivery, ALostConnectionSaysWhichOne) {
  Broker broker;
  MqttLink link(mqtt("truck7", {broker.uri()}));
  link.connect(0, {});
  std::string reason;
  run_until([&] { return !reason.empty(); },
            [&] {
              for (const LinkEvent& event : link.take()) {
                if (std::holds_alternative<LinkUp>(event)) broker.kill();
                if (const auto* down = std::get_if<LinkDown>(&event)) reason = down->reason;
              }
            });
  EXPECT_EQ(reason, "lost: " + broker.uri());
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

/// Brokers that speak TLS alone, each with a certificate that it signed itself, and clients whose certificates others
/// signed.
class Tls : public Delivery {
 protected:
  void SetUp() override {
    Delivery::SetUp();
    if (!run("command -v openssl")) GTEST_SKIP() << "openssl, which makes the certificates, is not installed";
    ASSERT_TRUE(run("chmod 755 " + certificates_ / "."));
  }
  std::string key(const std::string& name) const { return certificates_ / (name + ".key"); }
  std::string certificate(const std::string& name) const { return certificates_ / (name + ".pem"); }
  std::string new_key(const std::string& name) const {
    return "openssl req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN=" + name + " -keyout " +
           key(name);
  }
  void sign_itself(const std::string& name) const {
    EXPECT_TRUE(run(new_key(name) + " -x509 -days 2 -addext subjectAltName=DNS:localhost,IP:127.0.0.1 -out " +
                    certificate(name) + " && chmod 644 " + key(name)));
  }
  void sign(const std::string& name, const std::string& issuer, int days) const {
    const std::string request = certificates_ / (name + ".csr");
    EXPECT_TRUE(run(new_key(name) + " -out " + request + " && openssl x509 -req -in " + request + " -CA " +
                    certificate(issuer) + " -CAkey " + key(issuer) + " -CAcreateserial -days " + std::to_string(days) +
                    " -out " + certificate(name)));
  }
  std::unique_ptr<Broker> broker(const std::string& name, const std::string& extra = "") {
    sign_itself(name);
    return std::make_unique<Broker>("allow_anonymous true\ncertfile " + certificate(name) + "\nkeyfile " + key(name) +
                                    "\n" + extra);
  }
  static std::string uri(const Broker& broker) { return "ssl://localhost:" + std::to_string(broker.port()); }
  MqttParams trusting(const std::string& name, const std::string& client, std::vector<std::string> brokers) const {
    MqttParams params = mqtt(client, std::move(brokers));
    params.ca_file = certificate(name);
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

TEST_F(Tls, AClientThatNobodyVouchesForIsRefused) {
  sign_itself("fleet");
  sign_itself("other_fleet");
  sign("right", "fleet", 2);
  sign("wrong", "other_fleet", 2);
  sign("expired", "fleet", -1);
  const auto known = broker("known", "cafile " + certificate("fleet") + "\nrequire_certificate true");
  const auto bearing = [&](const std::string& name) {
    MqttParams params = trusting("known", "truck7", {uri(*known)});
    params.certificate_file = certificate(name);
    params.key_file = key(name);
    return connect(params);
  };
  EXPECT_TRUE(bearing("right").up);
  for (const std::string name : {"wrong", "expired"}) {
    const Outcome outcome = bearing(name);
    EXPECT_TRUE(outcome.down && !outcome.up) << name;
  }
  EXPECT_TRUE(connect(trusting("known", "truck7", {uri(*known)})).down) << "none at all";
}

TEST_F(Tls, AStrangerInTheListIsPassedOver) {
  const auto known = broker("known"), stranger = broker("stranger");
  MqttLink link(trusting("known", "truck7", {uri(*stranger), uri(*known)}));
  BridgeParams params = test::bridge_params(store());
  params.brokers = 2;
  params.back_off = kQuick;
  Bridge bridge(params, link, test::clocks());
  std::size_t kept = 0;
  SiteClient site(link_to_each(trusting("known", "site", {uri(*known)})), kQuick, "+", "+",
                  [&](const std::string&, const std::string&) { ++kept; });
  for (int n = 1; n <= 20; ++n) bridge.take(test::change(n), test::clocks());
  EXPECT_TRUE(run_until([&] { return bridge.outbox().acknowledged() == 20; },
                        [&] {
                          bridge.poll(test::clocks());
                          site.poll(test::clocks().monotonic);
                        }))
      << bridge.last_failure();
  EXPECT_EQ(bridge.broker(), 1u);
  EXPECT_EQ(kept, 20u);
}

}  // namespace
}  // namespace lodestar
