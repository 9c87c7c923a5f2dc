#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lodestar/BeaconSightingArray.h"
#include "lodestar/DistrustedBeaconArray.h"
#include "lodestar/estimation/pose/pose_solver.hpp"
#include "lodestar/ros/convert/message_drop.hpp"
#include "lodestar/ros/nodelets/edge_drop.hpp"
#include "ros/support/bag_player.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/truth.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

const char* const kNode = "pose_solving";

class PoseSolving : public testing::Test {
 protected:
  void SetUp() override {
    player_.answered_by([this] { return sightings_.size(); });
    ASSERT_TRUE(wait_for([&] { return diagnostics_.heard(kNode); }));
    ASSERT_TRUE(player_.connected({"/camera/image_raw", "/camera/camera_info", "/imu/data", "/odom"}));
    ASSERT_TRUE(wait_for([&] { return sightings_.connected() && fixes_.connected(); }));
    ASSERT_TRUE(wait_for([&] { return sightings_out_.getNumSubscribers() > 1; })) << "the test's own inbox is one";
    ASSERT_TRUE(wait_for([&] { return distrusted_out_.getNumSubscribers() > 0; }));
    player_.send_mounts();
  }

  bool dropped(const char* reason, long at_least) {
    return wait_for([&] { return diagnostics_.count(kNode, std::string("dropped: ") + reason) >= at_least; });
  }

  /// All fixes that the node made were heard.
  bool all_is_heard() {
    return wait_for([&] { return diagnostics_.count(kNode, "fix count") == static_cast<long>(fixes_.size()); });
  }

  static int named(const BeaconSightingArray& array) {
    int count = 0;
    for (const auto& sighting : array.sightings) count += sighting.named ? 1 : 0;
    return count;
  }

  ros::NodeHandle nh_;
  BagPlayer player_{nh_, ros::param::param<std::string>("/bag", "")};
  Inbox<BeaconSightingArray> sightings_{nh_, "/beacons/sightings"};
  Inbox<geometry_msgs::PoseWithCovarianceStamped> fixes_{nh_, "/beacons/fix"};
  Diagnostics diagnostics_{nh_};
  ros::Publisher distrusted_out_ = nh_.advertise<DistrustedBeaconArray>("/beacons/distrusted", 10);
  ros::Publisher left_out_out_ = nh_.advertise<DistrustedBeaconArray>("/beacons/left_out", 10);
  ros::Publisher sightings_out_ = nh_.advertise<BeaconSightingArray>("/beacons/sightings", 10);
};

TEST_F(PoseSolving, FixesLieAtTheTruthAndBadInputIsCounted) {
  ASSERT_TRUE(player_.play_until([&] { return fixes_.size() > 20; })) << fixes_.size();
  for (const auto& fix : fixes_.all()) {
    EXPECT_EQ(fix->header.frame_id, "map");
    const Offset offset = offset_from_truth(player_.truth(), *fix);
    EXPECT_LT(offset.position_m, 0.10) << "at " << fix->header.stamp;
    EXPECT_LT(offset.yaw_rad, 0.02);
    EXPECT_GT(fix->pose.covariance[0], 0);
  }
  EXPECT_TRUE(player_.play_until([&] { return diagnostics_.level(kNode) == 0; })) << diagnostics_.message(kNode);

  // Sightings that are no numbers, and too few of them.
  const BeaconSightingArray good = sightings_.last();
  ASSERT_GE(named(good), 2);
  BeaconSightingArray bad = good;
  bad.sightings[0].u_px = std::numeric_limits<double>::quiet_NaN();
  sightings_out_.publish(bad);
  EXPECT_TRUE(dropped(name(MessageDrop::kNotFinite), 1));
  ASSERT_TRUE(all_is_heard());
  const std::size_t before = fixes_.size();
  BeaconSightingArray one = good;
  one.sightings.resize(1);
  const long lonely = diagnostics_.count(kNode, "no fix: " + std::string(name(NoFix::kTooFewBeacons)));
  sightings_out_.publish(one);
  EXPECT_TRUE(wait_for(
      [&] { return diagnostics_.count(kNode, "no fix: " + std::string(name(NoFix::kTooFewBeacons))) > lonely; }));
  auto imu = player_.sample<sensor_msgs::Imu>("/imu/data");
  imu.header.stamp = player_.now();
  imu.linear_acceleration.z = std::nan("");
  player_.publish("/imu/data", imu);
  EXPECT_TRUE(dropped(name(MessageDrop::kNotFinite), 2));
  imu.header.frame_id = "nowhere";
  player_.publish("/imu/data", imu);
  EXPECT_TRUE(dropped(name(EdgeDrop::kNoMount), 1));
  auto odometry = player_.sample<nav_msgs::Odometry>("/odom");
  odometry.header.stamp = player_.now();
  odometry.child_frame_id = "trailer";
  player_.publish("/odom", odometry);
  EXPECT_TRUE(dropped(name(MessageDrop::kFrame), 1));
  auto info = player_.sample<sensor_msgs::CameraInfo>("/camera/camera_info");
  info.D.assign(4, std::nan(""));
  player_.publish("/camera/camera_info", info);
  EXPECT_TRUE(dropped(name(EdgeDrop::kCameraInfo), 1));
  ASSERT_TRUE(all_is_heard());
  EXPECT_EQ(fixes_.size(), before);

  // Beacons that the filter distrusts make no fix, nor do those that the decoder leaves out.
  DistrustedBeaconArray all;
  for (const std::uint32_t id : {11, 12, 13, 14}) all.beacons.emplace_back().beacon_id = id;
  const auto refused = [&] { return diagnostics_.count(kNode, "no fix: " + std::string(name(NoFix::kTooFewBeacons))); };
  for (const ros::Publisher& out : {distrusted_out_, left_out_out_}) {
    out.publish(all);
    const long refused_before = refused();
    EXPECT_TRUE(wait_for([&] {
      sightings_out_.publish(good);
      return refused() > refused_before;
    })) << out.getTopic();
    const std::size_t without = fixes_.size();
    out.publish(DistrustedBeaconArray());
    EXPECT_TRUE(wait_for([&] {
      sightings_out_.publish(good);
      return fixes_.size() > without;
    })) << out.getTopic();
  }

  // The line goes on, also after the clock jumped back.
  EXPECT_TRUE(player_.play_until([&] { return fixes_.size() > before + 5; }));
  player_.rewind();
  player_.play(2.0);
  const std::size_t before_jump = fixes_.size();
  EXPECT_TRUE(player_.play_until([&] { return fixes_.size() > before_jump + 5; }));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "resets") >= 1; }));
  EXPECT_LT(offset_from_truth(player_.truth(), fixes_.last()).position_m, 0.10);

  // Without images the photodiodes make the fixes.
  EXPECT_EQ(diagnostics_.count(kNode, "coarse fixes without the camera"), 0);
  player_.on<sensor_msgs::Image>("/camera/image_raw", [](const sensor_msgs::Image&) { return false; });
  player_.rewind();
  EXPECT_TRUE(player_.play_until([&] { return diagnostics_.count(kNode, "coarse fixes without the camera") > 0; }));
  EXPECT_LT(offset_from_truth(player_.truth(), fixes_.last()).position_m, 0.5);
}

}  // namespace
