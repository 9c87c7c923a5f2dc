// What goes wrong on a truck, from the event to a site behind a real broker: all arrives, once and in order.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/iso_time.hpp"
#include "lodestar/wms/mqtt_link.hpp"
#include "support/bridge_params.hpp"
#include "support/broker.hpp"
#include "support/pallet_changes.hpp"
#include "support/real_time.hpp"
#include "support/site.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using test::Broker;
using test::change;
using test::run_until;
using test::Site;

const std::string kAck = site_topics("lodestar", "truck7").ack;

class Trouble : public testing::Test {
 protected:
  void SetUp() override {
    if (!Broker::installed()) GTEST_SKIP() << "mosquitto is not installed: nothing was delivered";
    params_ = test::bridge_params(folder_ / "wms.db");
    params_.back_off = test::kQuick;
    start(1);
  }
  void start(std::size_t brokers) {
    site_.reset();
    bridge_.reset();
    brokers_.clear();
    std::vector<std::string> uris;
    for (std::size_t i = 0; i < brokers; ++i) {
      brokers_.push_back(std::make_unique<Broker>());
      uris.push_back(brokers_.back()->uri());
    }
    params_.brokers = uris.size();
    link_ = std::make_unique<MqttLink>(test::mqtt("truck7", uris));
    bridge_ = std::make_unique<Bridge>(params_, *link_, now());
    site_ = std::make_unique<Site>(uris);
  }

  ClockReading now() const {
    ClockReading now = test::clocks();
    now.wall += wall_ahead_;
    now.monotonic += slept_;
    return now;
  }
  void take(std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t n = first; n <= last; ++n) bridge_->take(change(n), now());
  }
  void poll() {
    bridge_->poll(now());
    site_->poll();
  }
  bool acknowledged(std::uint64_t count, double limit_s = 60) {
    return run_until([&] { return bridge_->outbox().acknowledged() >= count; }, [&] { poll(); }, limit_s);
  }
  /// A client that is connected to the first broker.
  std::unique_ptr<MqttLink> stranger() const {
    auto link = std::make_unique<MqttLink>(test::mqtt("stranger", {brokers_[0]->uri()}));
    link->connect(0, {});
    bool up = false;
    const auto connected = [&] {
      for (const LinkEvent& event : link->take()) up |= std::holds_alternative<LinkUp>(event);
      return up;
    };
    EXPECT_TRUE(run_until(connected, [] {}));
    return link;
  }
  json event(std::size_t document, std::size_t index = 0) const {
    return json::parse(site_->documents.at(document))["epcisBody"]["eventList"][index];
  }

  test::TemporaryFolder folder_{test::TemporaryFolder::memory()};
  BridgeParams params_;
  Duration wall_ahead_{}, slept_{};
  std::vector<std::unique_ptr<Broker>> brokers_;
  std::unique_ptr<MqttLink> link_;
  std::unique_ptr<Bridge> bridge_;
  std::unique_ptr<Site> site_;
};

TEST_F(Trouble, TenThousandEventsOfADayWithoutNetworkDrain) {
  brokers_[0]->kill();
  constexpr int kEvents = 10000;
  const Duration day = std::chrono::hours(24), between = day / (kEvents - 1) + Duration(1);
  std::vector<Stamp> stamps;
  for (int n = 1; n <= kEvents; ++n) {
    PalletChange event = change(n);
    wall_ahead_ += between;
    slept_ += between;
    stamps.push_back(event.stamp = now().wall);
    bridge_->take(event, now());
    if (n % 100 == 0) bridge_->poll(now());
  }
  EXPECT_EQ(bridge_->outbox().waiting(), static_cast<std::uint64_t>(kEvents));
  EXPECT_FALSE(bridge_->connected());
  EXPECT_NE(bridge_->last_failure(), "");

  brokers_[0]->start();
  EXPECT_TRUE(acknowledged(kEvents, 300)) << bridge_->outbox().waiting() << " " << bridge_->last_failure();
  site_->expect_all_once(kEvents);
  EXPECT_GE(stamps.back() - stamps.front(), day);
  for (const std::size_t i : {0, kEvents / 2, kEvents - 1}) EXPECT_EQ(event(i)["eventTime"], iso_time(stamps[i]));
  EXPECT_FALSE(event(0).contains("lodestar:clock")) << "time went on, nobody set it";
}

TEST_F(Trouble, AFullDiskIsFreed) {
  const std::string disk = folder_ / "disk";
  std::filesystem::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=12m") != 0)
    GTEST_SKIP() << "no right to mount a small disk: " << std::strerror(errno);
  params_.store.path = disk + "/wms.db";
  params_.store.ballast_bytes = 1 << 20;
  params_.store.history = 1;
  start(1);
  take(1, 100);
  std::ofstream filler(disk + "/filler");
  while (filler << std::string(4096, 'f') << std::flush) {
  }
  std::uint64_t n = 100;
  while (n < 5000 && bridge_->in_memory() < 50) take(n + 1, n + 1), ++n;
  ASSERT_EQ(bridge_->in_memory(), 50u);
  EXPECT_TRUE(acknowledged(n - 50)) << "what was recorded is worked off";
  EXPECT_EQ(bridge_->in_memory(), 50u) << "the ballast is for emptying the queue alone";
  std::filesystem::remove(disk + "/filler");
  filler.close();
  EXPECT_TRUE(acknowledged(n));
  site_->expect_all_once(n);
  EXPECT_EQ(bridge_->drops()[BridgeDrop::kLost], 0u);
  bridge_.reset();
  umount(disk.c_str());
}

TEST_F(Trouble, AClockThatJumpsMarksWhatCameBefore) {
  take(1, 10);
  wall_ahead_ += from_seconds(3600);
  poll();
  take(11, 20);
  ASSERT_TRUE(acknowledged(20));
  site_->expect_all_once(20);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(event(i).contains("lodestar:clock"), i < 10) << i;
  EXPECT_NEAR(event(0)["lodestar:clockStep_s"].get<double>(), 3600, 1);
}

TEST_F(Trouble, OddLabelsArriveAsNone) {
  const std::vector<std::string> labels = {"106141412345678907", "'; DROP TABLE event; --", "<script>alert(1)</script>",
                                           std::string(10240, '1'), "\xff\xfe"};
  std::uint64_t n = 0;
  for (const std::string& label : labels) {
    PalletChange odd = change(++n);
    odd.pallet.sscc = odd.pallet.zone = odd.pallet.type = odd.reason = label;
    bridge_->take(odd, now());
    odd = change(n + 100);
    odd.pallet.id = label;
    bridge_->take(odd, now());
  }
  ASSERT_TRUE(acknowledged(n));
  site_->expect_all_once(n);
  EXPECT_EQ(bridge_->drops()[BridgeDrop::kLabel], n);
  EXPECT_EQ(bridge_->drops()[BridgeDrop::kPalletId], n);
  for (std::size_t i = 0; i < n; ++i)
    EXPECT_EQ(event(i)["childEPCs"], json({"urn:uuid:" + change(i + 1).pallet.id})) << labels[i].substr(0, 30);
  EXPECT_EQ(event(2)["lodestar:palletType"], labels[2]);
}

TEST_F(Trouble, AcknowledgementsThatRepeatOrComeOutOfOrderMoveNothing) {
  const auto other = stranger();
  take(1, 500);
  std::uint64_t step = 0;
  const auto disturb = [&] {
    poll();
    const std::uint64_t reached = bridge_->store().acknowledged();
    const std::uint64_t said[] = {reached, reached / 2, 0, 501};
    const std::string stream = step % 5 == 4 ? test::uuid(901) : bridge_->store().stream();
    other->publish({kAck, message_text(Acknowledgement{stream, said[step % 4]}), 1, false});
    if (step++ % 7 == 0) other->publish({kAck, "{\"sequence\":", 1, false});
  };
  const auto done = [&] { return bridge_->outbox().acknowledged() == 500 && step > 100; };
  EXPECT_TRUE(run_until(done, disturb));
  site_->expect_all_once(500);
  for (std::size_t i = 0; i < static_cast<std::size_t>(AckDrop::kCount); ++i) {
    const auto drop = static_cast<AckDrop>(i);
    EXPECT_TRUE(run_until([&] { return bridge_->outbox().drops()[drop] > 0; }, disturb)) << name(drop);
  }
  EXPECT_EQ(bridge_->store().acknowledged(), 500u);
}

TEST_F(Trouble, OneOfTwoBrokersDiesWithEventsUnderWay) {
  start(2);
  take(1, 300);
  ASSERT_TRUE(acknowledged(300));
  EXPECT_EQ(bridge_->broker(), 0u);
  // A window of them is with the broker, which dies after the site kept the first and before it can say so.
  take(301, 600);
  run_until([&] { return bridge_->outbox().on_their_way() == 50; }, [&] { bridge_->poll(now()); });
  site_->kept = [&] { brokers_[0]->kill(); };
  run_until([&] { return site_->documents.size() > 300; }, [&] { site_->poll(); });
  site_->kept = nullptr;
  EXPECT_GT(site_->documents.size(), 300u);
  EXPECT_EQ(bridge_->outbox().acknowledged(), 300u);
  ASSERT_TRUE(acknowledged(600)) << bridge_->last_failure();
  EXPECT_EQ(bridge_->broker(), 1u);
  run_until([] { return false; }, [&] { poll(); }, 0.2);  // stragglers would show up now
  site_->expect_all_once(600);
  EXPECT_GT(site_->client.repeated(), 0u) << "nothing was under way";
}

TEST_F(Trouble, ATruckThatReachesTheSitesSecondBrokerAloneIsHeard) {
  start(2);
  const std::string nowhere = "tcp://127.0.0.1:1";
  bridge_.reset();
  link_ = std::make_unique<MqttLink>(test::mqtt("truck7", {nowhere, brokers_[1]->uri()}));
  bridge_ = std::make_unique<Bridge>(params_, *link_, now());
  take(1, 100);
  ASSERT_TRUE(acknowledged(100)) << bridge_->last_failure();
  EXPECT_EQ(bridge_->broker(), 1u);
  site_->expect_all_once(100);
}

TEST_F(Trouble, ASiteThatListensAtTheSecondBrokerAloneIsFound) {
  params_.silence = {from_seconds(0.3), from_seconds(2)};
  start(2);
  site_ = std::make_unique<Site>(std::vector<std::string>{brokers_[1]->uri()});
  take(1, 100);
  ASSERT_TRUE(acknowledged(100)) << bridge_->last_failure();
  EXPECT_EQ(bridge_->broker(), 1u);
  site_->expect_all_once(100);
}

TEST_F(Trouble, ASiteThatWasRestoredFromABackupGoesOn) {
  take(1, 12);
  ASSERT_TRUE(acknowledged(12));
  const auto other = stranger();
  other->publish({kAck, message_text(Acknowledgement{bridge_->store().stream(), 3}), 1, true});
  ASSERT_TRUE(run_until([&] { return bridge_->outbox().drops()[AckDrop::kLate] > 0; }, [&] { poll(); }));
  site_ = std::make_unique<Site>(std::vector<std::string>{brokers_[0]->uri()});
  take(13, 14);
  ASSERT_TRUE(acknowledged(14));
  ASSERT_EQ(site_->documents.size(), 2u);
  EXPECT_EQ(document_key_from(site_->documents[0])->sequence, 13u);
}

}  // namespace
}  // namespace lodestar
