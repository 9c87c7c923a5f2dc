#include "lodestar/wms/outbox.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "lodestar/wms/site_inbox.hpp"
#include "support/pallet_changes.hpp"

namespace lodestar {
namespace {

const std::string kStream = test::uuid(900);

Instant second(double time_s) { return Instant(from_seconds(1000 + time_s)); }

std::string ack(std::uint64_t sequence, const std::string& stream = kStream) {
  return message_text(Acknowledgement{stream, sequence});
}

/// Everything that is due counts as sent.
Batch send(Outbox& outbox, double time_s) {
  const Batch batch = outbox.due(second(time_s));
  outbox.sent(batch, second(time_s));
  return batch;
}

TEST(Outbox, NothingGoesWithoutAConnection) {
  Outbox outbox({}, kStream, {0, 0, 10});
  EXPECT_EQ(outbox.due(second(0)).count, 0u);
  outbox.connected(second(1));
  EXPECT_EQ(outbox.due(second(1)).first, 1u);
  EXPECT_EQ(outbox.due(second(1)).count, 10u);
  outbox.disconnected();
  EXPECT_EQ(outbox.due(second(2)).count, 0u);
}

TEST(Outbox, OnlyTheSiteMovesTheWindow) {
  Outbox outbox({}, kStream, {0, 0, 200});
  outbox.connected(second(0));
  EXPECT_EQ(send(outbox, 0).count, 50u);
  EXPECT_EQ(send(outbox, 0.1).count, 0u);
  EXPECT_TRUE(outbox.take(ack(20), false, second(0.2)));
  const Batch more = send(outbox, 0.2);
  EXPECT_EQ(more.first, 51u);
  EXPECT_EQ(more.count, 20u);
  EXPECT_EQ(outbox.waiting(), 180u);
  EXPECT_EQ(outbox.on_their_way(), 50u);
}

TEST(Outbox, AcknowledgementsThatSayNothingNew) {
  Outbox outbox({}, kStream, {0, 0, 30});
  outbox.connected(second(0));
  send(outbox, 0);
  EXPECT_TRUE(outbox.take(ack(10), false, second(0.1)));
  EXPECT_FALSE(outbox.take(ack(10), false, second(0.1)));
  EXPECT_FALSE(outbox.take(ack(7), false, second(0.1)));
  EXPECT_FALSE(outbox.take(ack(31), false, second(0.1)));
  EXPECT_FALSE(outbox.take(ack(20, test::uuid(901)), false, second(0.1)));
  for (const char* text : {"", "20", "{}", "[1]", R"({"stream":"x","sequence":20})", "{\"sequence\":20}",
                           R"({"stream":"urn:uuid:00000000-0000-4000-8000-000000000900","sequence":-20})",
                           R"({"stream":"urn:uuid:00000000-0000-4000-8000-000000000900","sequence":"20"})"})
    EXPECT_FALSE(outbox.take(text, false, second(0.1))) << text;
  EXPECT_EQ(outbox.acknowledged(), 10u);
  EXPECT_EQ(outbox.drops()[AckDrop::kRepeated], 1u);
  EXPECT_EQ(outbox.drops()[AckDrop::kLate], 1u);
  EXPECT_EQ(outbox.drops()[AckDrop::kAhead], 1u);
  EXPECT_EQ(outbox.drops()[AckDrop::kOtherStream], 1u);
  EXPECT_EQ(outbox.drops()[AckDrop::kMalformed], 8u);
}

TEST(Outbox, WhatWasNeverSentCannotBeAcknowledged) {
  Outbox outbox({}, kStream, {0, 0, 200});
  EXPECT_FALSE(outbox.take(ack(1), true, second(0)));
  outbox.connected(second(0));
  send(outbox, 0);
  EXPECT_FALSE(outbox.take(ack(51), false, second(0.1)));
  EXPECT_EQ(outbox.drops()[AckDrop::kAhead], 2u);
  EXPECT_TRUE(outbox.take(ack(50), false, second(0.1)));
}

TEST(Outbox, WhatABridgeBeforeSentMayBeAcknowledged) {
  Outbox outbox({}, kStream, {10, 60, 200});
  EXPECT_FALSE(outbox.take(ack(61), true, second(0)));
  EXPECT_TRUE(outbox.take(ack(60), true, second(0)));
  outbox.connected(second(1));
  EXPECT_EQ(send(outbox, 1).first, 61u);
}

TEST(Outbox, AReconnectSendsAgainFromTheFirstThatIsNotAcknowledged) {
  Outbox outbox({}, kStream, {4, 4, 30});
  outbox.connected(second(0));
  send(outbox, 0);
  outbox.take(ack(9), false, second(0.1));
  outbox.disconnected();
  EXPECT_TRUE(outbox.take(ack(12), true, second(3)));  // kept by the broker
  outbox.connected(second(3));
  EXPECT_EQ(send(outbox, 3).first, 13u);
}

TEST(Outbox, ASilentSiteIsAskedAgainEverMoreSeldom) {
  Outbox outbox({}, kStream, {0, 0, 3});
  outbox.connected(second(0));
  std::vector<double> times_s;
  for (double time_s = 0; time_s < 200; time_s += 0.5)
    if (send(outbox, time_s).count > 0) times_s.push_back(time_s);
  EXPECT_EQ(times_s, (std::vector<double>{0, 5, 15, 35, 75, 135, 195}));
  outbox.take(ack(1), false, second(200));
  EXPECT_EQ(outbox.due(second(204)).count, 0u);
  EXPECT_EQ(outbox.due(second(205)).first, 2u);
}

TEST(Outbox, ASiteThatMissesOneIsHeardOnceASecond) {
  Outbox outbox({}, kStream, {0, 0, 10});
  outbox.connected(second(0));
  send(outbox, 0);
  outbox.take(ack(2), false, second(0.1));
  outbox.take(ack(2), false, second(0.2));
  EXPECT_EQ(outbox.due(second(0.2)).count, 0u);
  outbox.take(ack(2), true, second(2));  // old, kept by the broker
  EXPECT_EQ(outbox.due(second(2)).count, 0u);
  outbox.take(ack(2), false, second(2));
  EXPECT_EQ(send(outbox, 2).first, 3u);
  EXPECT_EQ(outbox.resends(), 1u);
  outbox.take(ack(2), false, second(2.1));
  EXPECT_EQ(outbox.due(second(2.1)).count, 0u);
}

// A network that loses, doubles and disorders messages both ways, and breaks: each document arrives once, in order.
TEST(Outbox, ReachesTheSiteOverABadNetwork) {
  for (unsigned trial = 1; trial <= 50; ++trial) {
    std::mt19937 random(trial);
    const auto chance = [&](double probability) { return std::bernoulli_distribution(probability)(random); };
    constexpr std::uint64_t kAll = 300;
    Outbox outbox({}, kStream, {0, 0, 0});
    SiteInbox site;
    site.learn(kStream, 0);
    std::vector<std::uint64_t> arrived;
    std::vector<std::string> acks;
    bool up = false;
    for (double time_s = 0; time_s < 5000 && outbox.acknowledged() < kAll; time_s += 0.1) {
      outbox.recorded(std::min(kAll, outbox.acknowledged() + outbox.waiting() + 3));
      if (!up && chance(0.2)) outbox.connected(second(time_s)), up = true;
      if (up && chance(0.02)) outbox.disconnected(), up = false;
      std::vector<std::uint64_t> wire;
      const Batch batch = outbox.due(second(time_s));
      for (std::uint64_t i = 0; i < batch.count; ++i)
        for (int copies = chance(0.1) ? 0 : chance(0.1) ? 2 : 1; copies > 0; --copies) wire.push_back(batch.first + i);
      outbox.sent(batch, second(time_s));
      if (chance(0.1)) std::shuffle(wire.begin(), wire.end(), random);
      for (const std::uint64_t sequence : wire) {
        if (site.take({kStream, sequence}) == Arrival::kNew) arrived.push_back(sequence);
        acks.push_back(message_text(site.acknowledgement(kStream)));
      }
      if (chance(0.2)) std::shuffle(acks.begin(), acks.end(), random);
      while (!acks.empty() && up) {
        if (!chance(0.2)) outbox.take(acks.back(), false, second(time_s));
        acks.pop_back();
      }
    }
    ASSERT_EQ(arrived.size(), kAll) << "trial " << trial;
    for (std::uint64_t n = 1; n <= kAll; ++n) ASSERT_EQ(arrived[n - 1], n) << "trial " << trial;
    ASSERT_EQ(outbox.acknowledged(), kAll) << "trial " << trial;
  }
}

}  // namespace
}  // namespace lodestar
