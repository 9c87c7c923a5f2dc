#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/BeaconConfirmation.h"
#include "lodestar/ConfirmBeacon.h"
#include "lodestar/DistrustedBeaconArray.h"
#include "lodestar/GetBeacons.h"
#include "lodestar/base/site/site.hpp"
#include "lodestar/line/beacon_memory.hpp"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "lodestar/ros/convert/ir_samples.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"
#include "lodestar/sim/ir_sampler.hpp"
#include "ros/support/bag_player.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/keyed_site.hpp"
#include "ros/support/nodelets.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

const char* const kNode = "ir_decoding";
const char* const kType = "lodestar/IrDecodingNodelet";

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

DistrustedBeacon distrusted_since(std::uint32_t id, const ros::Time& since) {
  DistrustedBeacon beacon;
  beacon.beacon_id = id;
  beacon.since = since;
  return beacon;
}

class IrDecoding : public testing::Test {
 protected:
  void SetUp() override { start(ros::param::param<std::string>("/site", "")); }
  void TearDown() override { EXPECT_TRUE(unload_nodelet(kNode)); }

  void start(const std::string& site_path) {
    const auto loaded = load_site(site_path);
    ASSERT_TRUE(loaded.ok()) << describe(loaded.error());
    site_ = *loaded;
    ros::param::set("/ir_decoding/memory", memory_);
    ros::param::set("/ir_decoding/site", site_path);
    load();
    ASSERT_TRUE(wait_for([&] { return diagnostics_.heard(kNode); }));
  }
  void load() {
    heard_before_ = announcements_.size();
    spoilt_ = 0;
    ASSERT_TRUE(load_nodelet(kNode, kType));
    ASSERT_TRUE(player_.connected({"/ir/frames"}));
    ASSERT_TRUE(wait_for(
        [&] { return announcements_.connected() && conflicts_.connected() && samples_.getNumSubscribers() > 0; }));
  }
  void unload() {
    ASSERT_TRUE(unload_nodelet(kNode));
    ASSERT_TRUE(player_.disconnected("/ir/frames"));
    ASSERT_TRUE(wait_for([&] { return !announcements_.connected() && !conflicts_.connected(); }));
    diagnostics_.forget(kNode);
  }

  /// What beacon 11 would say.
  Announcement announcement(std::uint32_t superframe) const {
    const Beacon& beacon = site_.beacons[0];
    Announcement a;
    a.stamp = stamp_from(player_.now());
    a.beacon = beacon.id;
    a.slot = static_cast<std::uint8_t>(beacon.slot);
    a.superframe = superframe;
    a.position_map = beacon.position_map;
    a.tones = beacon.tones;
    a.surveyed = true;
    return a;
  }
  void send(const Announcement& a, const ros::Time& stamp) {
    RawIrFrame frame;
    frame.stamp = stamp_from(stamp);
    frame.octets = encode_ir_frame(a, site_.link);
    frame.levels = {0.5f};
    player_.publish("/ir/frames", ir_frame_message(frame, "ir_array"));
  }
  /// Again, with what it keeps.
  void restart() {
    unload();
    load();
  }
  /// Damaged beyond the parity.
  void send_spoilt() {
    auto damaged = player_.sample<lodestar::IrFrame>("/ir/frames");
    damaged.header.stamp = player_.now();
    for (int i = 5; i < 20; ++i) damaged.octets[i] ^= 0x5a;
    player_.publish("/ir/frames", damaged);
    ++spoilt_;
  }
  /// All frames that were sent are decoded, for a last one is, and what came of them was heard.
  bool all_is_heard() {
    send_spoilt();
    return dropped(name(IrDrop::kUncorrectable), spoilt_) && wait_for([&] {
             return diagnostics_.count(kNode, "accepted") == static_cast<long>(announcements_.size() - heard_before_);
           });
  }
  bool confirm(BeaconId id) {
    ConfirmBeacon confirm;
    confirm.request.beacon_id = id.value;
    return call_service("/ir_decoding/confirm_beacon", confirm) && confirm.response.success;
  }
  BeaconMemory memory() const { return parse_beacon_memory(text_of(memory_)).value_or(BeaconMemory()); }
  bool kept(BeaconId id) const { return memory().confirmed.count(id) > 0; }
  bool told_left_out(const std::vector<BeaconId>& ids) {
    const auto same = [](const DistrustedBeacon& told, BeaconId id) { return told.beacon_id == id.value; };
    return wait_for([&] {
      if (left_out_.empty()) return false;
      const auto& told = left_out_.last().beacons;
      return std::equal(told.begin(), told.end(), ids.begin(), ids.end(), same);
    });
  }
  bool in_conflict(BeaconId id) {
    GetBeacons table;
    EXPECT_TRUE(call_service("/ir_decoding/get_beacons", table));
    for (const auto& entry : table.response.beacons)
      if (entry.beacon_id == id.value) return entry.conflict;
    ADD_FAILURE() << "no beacon " << id;
    return false;
  }
  bool dropped(const std::string& reason, long at_least) {
    return wait_for([&] { return diagnostics_.count(kNode, "dropped: " + reason) >= at_least; });
  }

  ros::NodeHandle nh_;
  TemporaryFolder folder_;
  const std::string memory_ = folder_ / "confirmed.yaml";
  Site site_;
  BagPlayer player_{nh_, ros::param::param<std::string>("/bag", "")};
  Inbox<BeaconAnnouncement> announcements_{nh_, "/beacons/announcements"};
  Inbox<BeaconAnnouncement> conflicts_{nh_, "/beacons/conflicts"};
  Inbox<BeaconConfirmation> confirmed_{nh_, "/beacons/confirmed"};
  Inbox<DistrustedBeaconArray> left_out_{nh_, "/beacons/left_out"};
  ros::Publisher distrusted_ = nh_.advertise<DistrustedBeaconArray>("/beacons/distrusted", 10);
  ros::Publisher samples_ = nh_.advertise<IrSamples>("/ir/samples", 100);
  Diagnostics diagnostics_{nh_};
  std::size_t heard_before_ = 0;  ///< announcements, before the node was started
  long spoilt_ = 0;               ///< frames that were sent to it
};

TEST_F(IrDecoding, GoodFramesBecomeAnnouncementsAndBadOnesAreCounted) {
  player_.play(3.0);
  ASSERT_TRUE(player_.play_until([&] { return announcements_.size() >= 20; })) << announcements_.size();
  std::set<std::uint32_t> heard;
  for (const auto& a : announcements_.all()) {
    heard.insert(a->beacon_id);
    const Beacon& beacon = site_.beacons.at(a->beacon_id - 11);
    EXPECT_EQ(a->header.frame_id, "map");
    EXPECT_NEAR(a->position.x, beacon.position_map.x(), 0.001);
    EXPECT_NEAR(a->position.z, beacon.position_map.z(), 0.001);
    EXPECT_EQ(a->slot, beacon.slot);
    EXPECT_EQ(a->tones.size(), 2u);
  }
  EXPECT_EQ(heard, (std::set<std::uint32_t>{11, 12, 13, 14}));

  // The table, as the service tells it.
  GetBeacons table;
  ASSERT_TRUE(call_service("/ir_decoding/get_beacons", table));
  ASSERT_EQ(table.response.beacons.size(), 4u);
  for (const auto& entry : table.response.beacons) {
    EXPECT_EQ(entry.source, BeaconEntry::BOTH);
    EXPECT_FALSE(entry.conflict);
    EXPECT_GT(entry.heard, 4u);
  }
  EXPECT_TRUE(player_.play_until([&] {
    return diagnostics_.count(kNode, "accepted") >= 20 && diagnostics_.level(kNode) == 0;
  })) << diagnostics_.message(kNode);
  EXPECT_EQ(diagnostics_.hardware_id(kNode), "test-hall");

  // Damaged beyond the parity, and a frame of noise that no parity mends.
  const auto good = player_.sample<lodestar::IrFrame>("/ir/frames");
  for (int i = 0; i < 3; ++i) send_spoilt();
  ASSERT_TRUE(all_is_heard());
  const std::size_t before = announcements_.size();

  // Replayed: the first frame of the bag again, as if it were heard now, and as it was heard then.
  auto replayed = good;
  replayed.header.stamp = player_.now();
  for (int i = 0; i < 3; ++i) player_.publish("/ir/frames", replayed);
  EXPECT_TRUE(dropped(name(IrDrop::kSuperframe), 3));
  for (int i = 0; i < 6; ++i) player_.publish("/ir/frames", good);
  EXPECT_TRUE(wait_for([&] {
    return diagnostics_.count(kNode, std::string("dropped: ") + name(IrDrop::kStamp)) +
               diagnostics_.count(kNode, std::string("dropped: ") + name(IrDrop::kSuperframe)) >=
           9;
  }));

  // No stamp, and levels that are no numbers.
  auto unstamped = good;
  unstamped.header.stamp = ros::Time();
  player_.publish("/ir/frames", unstamped);
  EXPECT_TRUE(dropped(name(MessageDrop::kStamp), 1));
  auto unmeasured = replayed;
  unmeasured.levels = {std::nanf("")};
  player_.publish("/ir/frames", unmeasured);
  EXPECT_TRUE(dropped(name(MessageDrop::kNotFinite), 1));
  ASSERT_TRUE(all_is_heard());
  EXPECT_EQ(announcements_.size(), before);

  // The line goes on.
  EXPECT_TRUE(player_.play_until([&] { return announcements_.size() > before + 5; }));
  ASSERT_TRUE(all_is_heard());

  // A beacon that is not where the site file says is told on a topic of its own and is not used.
  const auto last = announcements_.last();
  Announcement moved = announcement(last.superframe + 1);
  moved.position_map.x() += 1.0;
  send(moved, last.header.stamp + ros::Duration(site_.link.slot_s * (site_.link.slot_count + 0 - last.slot)));
  EXPECT_TRUE(wait_for([&] { return conflicts_.size() == 1; }));
  EXPECT_TRUE(dropped(name(IrDrop::kConflict), 1));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "beacons in force") == 3; }));
  EXPECT_GE(diagnostics_.level(kNode), 1);
  EXPECT_NE(diagnostics_.message(kNode).find("left out until confirmed"), std::string::npos)
      << diagnostics_.message(kNode);

  // Somebody looks after it and says so.
  ConfirmBeacon confirm;
  confirm.request.beacon_id = 99;
  ASSERT_TRUE(call_service("/ir_decoding/confirm_beacon", confirm));
  EXPECT_FALSE(confirm.response.success) << "never heard";
  confirm.request.beacon_id = moved.beacon.value;
  ASSERT_TRUE(call_service("/ir_decoding/confirm_beacon", confirm));
  EXPECT_TRUE(confirm.response.success) << confirm.response.message;
  EXPECT_TRUE(wait_for([&] { return confirmed_.size() == 1; }));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "beacons in force") == 4; }));
  const Beacon& other = site_.beacons[1];
  confirm.request.beacon_id = other.id.value;
  ASSERT_TRUE(call_service("/ir_decoding/confirm_beacon", confirm));
  ASSERT_TRUE(wait_for([&] { return confirmed_.size() == 2; }));

  // Its restart forgets nothing of that, and whoever listens anew is told.
  restart();
  ASSERT_TRUE(wait_for([&] { return confirmed_.size() == 4; }));
  const BeaconConfirmation told = *confirmed_.all()[2];
  EXPECT_EQ(told.announcement.beacon_id, moved.beacon.value);
  EXPECT_NEAR(told.announcement.position.x, moved.position_map.x(), 1e-9);
  EXPECT_EQ(told.header.stamp, confirmed_.all()[0]->header.stamp) << "when it was confirmed, not when it is told";
  ASSERT_TRUE(call_service("/ir_decoding/get_beacons", table));
  for (const auto& entry : table.response.beacons) {
    EXPECT_FALSE(entry.conflict);
    if (entry.beacon_id != moved.beacon.value) continue;
    EXPECT_NEAR(entry.position.x, moved.position_map.x(), 1e-9);
  }

  // Whom the filter found out since is no longer confirmed; who was confirmed since stays so, whoever starts when.
  EXPECT_TRUE(kept(moved.beacon) && kept(other.id));
  DistrustedBeaconArray distrusted;
  distrusted.beacons = {distrusted_since(moved.beacon.value, told.header.stamp - ros::Duration(1)),
                        distrusted_since(other.id.value, confirmed_.last().header.stamp)};
  ASSERT_TRUE(wait_for([&] { return distrusted_.getNumSubscribers() > 0; }));
  distrusted_.publish(distrusted);
  EXPECT_TRUE(wait_for([&] { return !kept(other.id); }));
  EXPECT_TRUE(kept(moved.beacon));
  // Also where the clock was set back between the two.
  distrusted.beacons = {distrusted_since(moved.beacon.value, told.header.stamp + ros::Duration(100))};
  distrusted_.publish(distrusted);
  EXPECT_TRUE(wait_for([&] { return !kept(moved.beacon); }));
  confirm.request.beacon_id = moved.beacon.value;
  ASSERT_TRUE(call_service("/ir_decoding/confirm_beacon", confirm));
  ASSERT_TRUE(wait_for([&] { return confirmed_.size() == 5; }));
  EXPECT_GT(confirmed_.last().header.stamp, distrusted.beacons[0].since);
  EXPECT_TRUE(kept(moved.beacon));

  // To hear the time of the site.
  EXPECT_TRUE(player_.play_until([&] { return diagnostics_.count(kNode, "accepted") >= 3; }));
  ASSERT_TRUE(all_is_heard());

  // A frame that begins in another beacon's slot: refused, and the operator is told.
  const auto newest = announcements_.last();
  Announcement relayed = announcement(newest.superframe + 2);
  send(relayed,
       newest.header.stamp + ros::Duration(site_.link.slot_s * (2 * site_.link.slot_count - newest.slot) + 0.1));
  EXPECT_TRUE(dropped(name(IrDrop::kSlot), 1));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.said(kNode, "no beacon of this site sends"); }))
      << diagnostics_.message(kNode);

  // Somebody drowns the channel, and the operator is told.
  for (int i = 0; i < 30; ++i) send_spoilt();
  EXPECT_TRUE(wait_for([&] { return diagnostics_.said(kNode, "most frames are spoilt"); }))
      << diagnostics_.message(kNode);

  // The clock jumps back: the bag begins again and its frames count again.
  const std::size_t before_jump = announcements_.size();
  player_.rewind();
  EXPECT_TRUE(player_.play_until([&] { return announcements_.size() > before_jump + 5; }));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "resets") >= 1; }));
  ASSERT_TRUE(all_is_heard());

  // The other form: samples of the diodes, with the next frame of a beacon in them.
  const auto latest = announcements_.last();
  Announcement sampled = announcement(latest.superframe + 1);
  const Beacon& beacon = site_.beacons[2];
  sampled.beacon = beacon.id;
  sampled.slot = static_cast<std::uint8_t>(beacon.slot);
  sampled.position_map = beacon.position_map;
  sampled.tones = beacon.tones;
  constexpr double kLead_s = 0.005;
  sim::IrSampler sampler({}, 1);
  sampler.send({kLead_s, site_.link.bit_rate_bps, encode_ir_frame(sampled, site_.link), std::vector<float>(8, 0.1f)});
  const ros::Time begin =
      latest.header.stamp +
      ros::Duration(site_.link.slot_s * (site_.link.slot_count + beacon.slot - latest.slot) - kLead_s);
  const std::size_t before_samples = announcements_.size();
  for (int block = 0; block < 5; ++block) {
    const Stamp stamp = stamp_from(begin + ros::Duration(sampler.time_s()));
    samples_.publish(ir_samples_message(sampler.next(1536, stamp), "ir_array"));
  }
  ASSERT_TRUE(wait_for([&] { return announcements_.size() > before_samples; }));
  EXPECT_EQ(announcements_.last().beacon_id, beacon.id.value);
  EXPECT_EQ(announcements_.last().superframe, sampled.superframe);
  EXPECT_NEAR((announcements_.last().header.stamp - begin).toSec(), kLead_s, 1e-5);
  EXPECT_EQ(announcements_.last().levels.size(), 8u);
}

TEST_F(IrDecoding, WhoDrownsTheSamplesIsToldOf) {
  ASSERT_TRUE(wait_for([&] { return samples_.getNumSubscribers() > 0; }));
  sim::IrSampler sampler({}, 1);
  sim::Random random(1, "jammer");
  const auto drown = [&] {
    std::array<std::uint8_t, RawIrFrame::kOctets> noise;
    for (auto& octet : noise) octet = static_cast<std::uint8_t>(random.uniform(0, 255.9));
    sampler.send({sampler.time_s() + 0.002, site_.link.bit_rate_bps, noise, std::vector<float>(8, 0.3f)});
    for (int block = 0; block < 4; ++block) {
      const Stamp stamp = Stamp(std::chrono::seconds(1000)) + from_seconds(sampler.time_s());
      samples_.publish(ir_samples_message(sampler.next(1536, stamp), "ir_array"));
    }
  };
  bool told = false;
  for (int trial = 0; trial < 20 && !told; ++trial) {
    for (int frame = 0; frame < 15; ++frame) drown();
    told = wait_for([&] { return diagnostics_.message(kNode).find("most frames are spoilt") != std::string::npos; }, 2);
  }
  EXPECT_TRUE(told) << diagnostics_.message(kNode);
  EXPECT_TRUE(announcements_.empty());
}

class IrDecodingWithKey : public IrDecoding {
 protected:
  void SetUp() override { start(keyed_site(ros::param::param<std::string>("/site", ""), folder_)); }

  /// Beacon 11 says so, `late_s` after it should.
  void hear(std::uint32_t superframe, double late_s = 0, double moved_m = 0) {
    Announcement a = announcement(superframe);
    a.position_map.x() += moved_m;
    send(a, ros::Time(1000 + late_s + superframe * site_.link.slot_s * site_.link.slot_count));
  }
};

TEST_F(IrDecodingWithKey, ARecordingThatIsHeardFirstTakesNoConfirmationAway) {
  const BeaconId id = site_.beacons[0].id;
  hear(100, 0, 1.0);
  ASSERT_TRUE(wait_for([&] { return conflicts_.size() == 1; }));
  ASSERT_TRUE(confirm(id));
  EXPECT_TRUE(kept(id));

  restart();
  hear(77, 3600);
  ASSERT_TRUE(wait_for([&] { return conflicts_.size() == 2; })) << "where it hung before it was moved";
  EXPECT_TRUE(in_conflict(id));
  const std::size_t told = confirmed_.size();
  hear(20000, 0, 1.0);
  ASSERT_TRUE(wait_for([&] { return announcements_.size() == 1; }));
  EXPECT_FALSE(in_conflict(id));
  EXPECT_TRUE(kept(id));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "corrections") == 1; })) << "the operator is told";
  EXPECT_TRUE(wait_for([&] { return confirmed_.size() == told + 1; })) << "whoever started meanwhile has to know";
}

TEST_F(IrDecodingWithKey, ABeaconThatIsLeftOutStaysSoOverARestartUntilItIsConfirmed) {
  const BeaconId id = site_.beacons[0].id;
  EXPECT_TRUE(told_left_out({}));
  hear(100, 0, 1.0);
  ASSERT_TRUE(wait_for([&] { return conflicts_.size() == 1; }));
  EXPECT_TRUE(told_left_out({id}));

  left_out_.clear();
  restart();
  EXPECT_TRUE(told_left_out({id})) << "before anything is heard";
  EXPECT_TRUE(in_conflict(id));
  EXPECT_TRUE(wait_for([&] {
    return diagnostics_.message(kNode).find("left out until confirmed") != std::string::npos;
  })) << diagnostics_.message(kNode);
  EXPECT_FALSE(confirm(id)) << "not heard since";
  hear(101);
  ASSERT_TRUE(wait_for([&] { return conflicts_.size() == 2; })) << "also where it agrees again";

  ASSERT_TRUE(confirm(id));
  EXPECT_TRUE(told_left_out({}));
  restart();
  EXPECT_FALSE(in_conflict(id));
}

TEST_F(IrDecodingWithKey, AConfirmationOutlivesARestartWhileARecordingContradictsIt) {
  const BeaconId id = site_.beacons[0].id;
  hear(100, 0, 1.0);
  ASSERT_TRUE(wait_for([&] { return conflicts_.size() == 1; }));
  ASSERT_TRUE(confirm(id));
  restart();
  hear(77, 3600);
  ASSERT_TRUE(wait_for([&] { return conflicts_.size() == 2; }));

  restart();
  EXPECT_TRUE(in_conflict(id));
  hear(20000, 0, 1.0);
  ASSERT_TRUE(wait_for([&] { return announcements_.size() == 1; })) << "a true frame, where it was confirmed";
  EXPECT_FALSE(in_conflict(id));
  EXPECT_TRUE(told_left_out({}));
  EXPECT_TRUE(memory().left_out.empty());
}

TEST_F(IrDecodingWithKey, AMemoryThatIsNoListIsSetAsideAndTold) {
  std::ofstream(memory_) << "hello, I am no list\n";
  restart();
  EXPECT_TRUE(wait_for([&] { return diagnostics_.message(kNode).find("set aside") != std::string::npos; }));
  EXPECT_EQ(text_of(memory_ + ".broken"), "hello, I am no list\n");

  // One that was emptied by the node itself is a list.
  hear(100, 0, 1.0);
  ASSERT_TRUE(wait_for([&] { return conflicts_.size() == 1; }));
  ASSERT_TRUE(confirm(site_.beacons[0].id));
  EXPECT_TRUE(kept(site_.beacons[0].id));
  ASSERT_TRUE(wait_for([&] { return !confirmed_.empty(); }));
  DistrustedBeaconArray distrusted;
  distrusted.beacons = {distrusted_since(site_.beacons[0].id.value, confirmed_.last().header.stamp)};
  ASSERT_TRUE(wait_for([&] { return distrusted_.getNumSubscribers() > 0; }));
  distrusted_.publish(distrusted);
  EXPECT_TRUE(wait_for([&] { return !kept(site_.beacons[0].id); }));
  EXPECT_NE(text_of(memory_), "");
  std::remove((memory_ + ".broken").c_str());
  restart();
  EXPECT_FALSE(std::ifstream(memory_ + ".broken").good());
}

}  // namespace
