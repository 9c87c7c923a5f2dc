// Somebody plays tricks on the data channel of a site with a key: no pose moves because of it, and the operator is told
// what he does.
#include "support/stranger.hpp"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/BeaconSightingArray.h"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "ros/support/bag_player.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/keyed_site.hpp"
#include "ros/support/nodelets.hpp"
#include "ros/support/truth.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

class StrangerOnTheChannel : public testing::Test {
 protected:
  void SetUp() override {
    const std::string keyless = ros::param::param<std::string>("/site", "");
    const auto without_key = load_site(keyless);
    ASSERT_TRUE(without_key.ok());
    bag_site_ = *without_key;
    const auto with_key = load_site(keyed_site(keyless, folder_));
    ASSERT_TRUE(with_key.ok()) << describe(with_key.error());
    site_ = *with_key;
    for (const auto& [node, type] : {std::pair("ir_decoding", "lodestar/IrDecodingNodelet"),
                                     std::pair("beacon_detection", "lodestar/BeaconDetectionNodelet"),
                                     std::pair("pose_solving", "lodestar/PoseSolvingNodelet"),
                                     std::pair("pose_fusion", "lodestar/PoseFusionNodelet")}) {
      ros::param::set(std::string("/") + node + "/site", folder_ / "site.yaml");
      ASSERT_TRUE(load_nodelet(node, type)) << node;
    }
    player_.answered_by([this] { return sightings_.size(); });
    player_.on<lodestar::IrFrame>("/ir/frames", [this](const lodestar::IrFrame& frame) { return hear(frame); });
    ASSERT_TRUE(player_.connected({"/camera/image_raw", "/camera/camera_info", "/imu/data", "/odom", "/ir/frames"}));
    ASSERT_TRUE(wait_for([&] { return sightings_.connected() && poses_.connected() && announcements_.connected(); }));
    player_.send_mounts();
  }

  void play(Trick trick, double duration_s) {
    for (const char* node : {"ir_decoding", "beacon_detection"}) diagnostics_.forget(node);
    stranger_ = Stranger(trick, site_);
    player_.play(duration_s);
  }

  /// What the receiver hears of a frame of the bag, which its beacon now signs, and of the stranger. Never as it was.
  bool hear(const lodestar::IrFrame& message) {
    RawIrFrame frame = *ir_frame_from(message);
    const auto said = IrFrameDecoder(bag_site_.link, static_cast<int>(bag_site_.tone_table_hz.size())).decode(frame);
    if (!said) return true;
    frame.octets = encode_ir_frame(*said, site_.link);
    for (const RawIrFrame& heard : stranger_.heard(frame))
      player_.publish("/ir/frames", ir_frame_message(heard, message.header.frame_id));
    return false;
  }

  bool told(const std::string& node, const std::string& text) {
    return wait_for([&] { return diagnostics_.said(node, text); });
  }
  bool refused(IrDrop reason) {
    const std::string node = "ir_decoding";
    return told(node, "frames that no beacon of this site sends: ") && told(node, std::string(" ") + name(reason));
  }

  /// Signed, and where its beacon hangs; every pose within three of its own sigma.
  void expect_the_truth() {
    for (const auto& a : announcements_.all()) {
      EXPECT_TRUE(a->is_signed);
      EXPECT_NEAR(a->position.x, site_.beacons.at(a->beacon_id - 11).position_map.x(), 1e-3);
      EXPECT_NEAR(a->position.y, site_.beacons.at(a->beacon_id - 11).position_map.y(), 1e-3);
    }
    for (const auto& pose : poses_.all()) {
      const Offset offset = offset_from_truth(player_.truth(), *pose);
      const auto& covariance = pose->pose.covariance;
      EXPECT_LT(offset.position_m, 3 * std::sqrt(std::min(covariance[0], covariance[7]))) << pose->header.stamp;
      EXPECT_LT(offset.yaw_rad, 3 * std::sqrt(covariance[35])) << pose->header.stamp;
    }
  }

  ros::NodeHandle nh_;
  TemporaryFolder folder_;
  Site bag_site_, site_;
  Stranger stranger_{Trick::kNone, site_};
  BagPlayer player_{nh_, ros::param::param<std::string>("/bag", "")};
  Inbox<BeaconSightingArray> sightings_{nh_, "/beacons/sightings"};
  Inbox<BeaconAnnouncement> announcements_{nh_, "/beacons/announcements"};
  Inbox<geometry_msgs::PoseWithCovarianceStamped> poses_{nh_, "/pose"};
  Diagnostics diagnostics_{nh_};
};

TEST_F(StrangerOnTheChannel, WhateverHeDoesIsToldAndMovesNoPose) {
  play(Trick::kNone, 1.5);
  ASSERT_TRUE(wait_for([&] { return !poses_.empty(); }));
  ASSERT_TRUE(wait_for([&] { return diagnostics_.level("ir_decoding") == 0; })) << diagnostics_.message("ir_decoding");

  play(Trick::kForge, 1.0);
  EXPECT_TRUE(refused(IrDrop::kUnsigned)) << diagnostics_.message("ir_decoding");
  EXPECT_TRUE(refused(IrDrop::kTag)) << diagnostics_.message("ir_decoding");
  play(Trick::kRelay, 1.0);
  EXPECT_TRUE(refused(IrDrop::kDirection)) << diagnostics_.message("ir_decoding");
  play(Trick::kReplay, 1.0);
  EXPECT_TRUE(refused(IrDrop::kSuperframe)) << diagnostics_.message("ir_decoding");
  // Longer than all that was sound since the channel was judged last, or it may be judged together with that.
  play(Trick::kJam, 2.5);
  EXPECT_TRUE(told("ir_decoding", "most frames are spoilt")) << diagnostics_.message("ir_decoding");
  EXPECT_TRUE(wait_for([&] { return poses_.last().header.stamp > player_.now() - ros::Duration(0.2); }))
      << "he took the pose away";
  expect_the_truth();

  // From the start of the truck, brighter than the beacons: it may not start, but nobody is left in the dark.
  player_.rewind();
  play(Trick::kOutshine, 1.5);
  EXPECT_TRUE(told("beacon_detection", "somebody outshines the beacons")) << diagnostics_.message("beacon_detection");
  expect_the_truth();

  // From the start of the truck, with what he recorded the day before.
  player_.rewind();
  play(Trick::kYesterday, 1.5);
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count("ir_decoding", "corrections") > 0; }));
  EXPECT_TRUE(refused(IrDrop::kSuperframe)) << diagnostics_.message("ir_decoding");
}

}  // namespace
