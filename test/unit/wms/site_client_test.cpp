// A site at several brokers, over links that are lists.
#include "lodestar/wms/site_client.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/fake_link.hpp"
#include "support/pallet_changes.hpp"

namespace lodestar {
namespace {

using test::FakeLink;
using test::uuid;

const SiteTopics kTopics = site_topics("lodestar", "truck7");

std::string document(std::uint64_t sequence) {
  return nlohmann::json{{"lodestar:stream", "urn:uuid:" + uuid(1)}, {"lodestar:sequence", sequence}}.dump();
}

class SiteClientTest : public testing::Test {
 protected:
  SiteClientTest() { poll(); }

  static std::vector<std::unique_ptr<MessageLink>> two_links(std::vector<FakeLink*>& links) {
    std::vector<std::unique_ptr<MessageLink>> out;
    for (int i = 0; i < 2; ++i) {
      auto link = std::make_unique<FakeLink>();
      links.push_back(link.get());
      out.push_back(std::move(link));
    }
    return out;
  }
  void poll(double seconds = 0) {
    now_ += from_seconds(seconds);
    site_.poll(now_);
    site_.poll(now_);
  }
  void announce(std::size_t broker, std::uint64_t acknowledged) {
    hear(broker, kTopics.stream, message_text(StreamNotice{uuid(1), acknowledged, 100}));
  }
  void hear(std::size_t broker, const std::string& topic, const std::string& payload, bool retained = false) {
    brokers_[broker]->inbox.push_back(MqttMessage{topic, payload, 0, retained});
  }
  /// The last number that was said at a broker; 0: none
  std::uint64_t said(std::size_t broker) const {
    const auto acks = brokers_[broker]->on("/ack");
    if (acks.empty()) return 0;
    EXPECT_TRUE(acks.back().retained && acks.back().qos == 1 && acks.back().topic == kTopics.ack);
    return acknowledgement_from(acks.back().payload)->sequence;
  }

  Instant now_{};
  std::vector<std::string> kept_;
  std::vector<FakeLink*> brokers_;
  SiteClient site_{two_links(brokers_), BackOff(), "lodestar", "truck7",
                   [this](const std::string&, const std::string& text) { kept_.push_back(text); }};
};

TEST_F(SiteClientTest, ListensAtEachBroker) {
  for (const FakeLink* broker : brokers_)
    EXPECT_EQ(broker->subscribed, (std::vector<std::string>{kTopics.ack, kTopics.stream, kTopics.event}));
}

TEST_F(SiteClientTest, OneWatermarkForAllBrokersIsSaidAtEach) {
  announce(0, 0);
  hear(0, kTopics.event, document(1));
  hear(0, kTopics.event, document(2));
  poll();
  // The truck did not hear that, and is at the other broker now.
  announce(1, 0);
  for (const std::uint64_t n : {1, 2, 3}) hear(1, kTopics.event, document(n));
  poll();
  EXPECT_EQ(kept_, (std::vector<std::string>{document(1), document(2), document(3)}));
  EXPECT_EQ(site_.repeated(), 2u);
  for (const std::size_t broker : {0, 1}) EXPECT_EQ(said(broker), 3u) << broker;
  // What was under way at the first comes late.
  hear(0, kTopics.event, document(3));
  hear(0, kTopics.event, document(4));
  poll();
  EXPECT_EQ(kept_.size(), 4u);
  EXPECT_EQ(site_.repeated(), 3u);
}

TEST_F(SiteClientTest, TakesNothingAnewThatAnyBrokerRemembers) {
  hear(0, kTopics.ack, message_text(Acknowledgement{uuid(1), 7}), true);
  hear(1, kTopics.ack, message_text(Acknowledgement{uuid(1), 5}), true);
  hear(1, kTopics.event, document(6));
  hear(1, kTopics.event, document(8));
  poll();
  EXPECT_EQ(kept_, std::vector<std::string>{document(8)});
}

TEST_F(SiteClientTest, ABrokerThatDiesHoldsUpNoOther) {
  announce(1, 0);
  brokers_[0]->working = {false};
  brokers_[0]->inbox.push_back(LinkDown{"lost"});
  hear(1, kTopics.event, document(1));
  poll();
  EXPECT_EQ(site_.failure(0), "refused");
  EXPECT_EQ(site_.failure(1), "");
  EXPECT_EQ(said(1), 1u);
  EXPECT_EQ(said(0), 0u) << "nobody is there";
  brokers_[0]->working = {true};
  poll(1);
  EXPECT_EQ(site_.failure(0), "");
  hear(0, kTopics.event, document(2));
  poll();
  EXPECT_EQ(kept_.size(), 2u);
  EXPECT_EQ(said(0), 2u);
}

}  // namespace
}  // namespace lodestar
