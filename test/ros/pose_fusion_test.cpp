#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "lodestar/BeaconConfirmation.h"
#include "lodestar/BeaconSightingArray.h"
#include "lodestar/DistrustedBeaconArray.h"
#include "lodestar/PoseIntegrity.h"
#include "lodestar/estimation/fusion/pose_filter.hpp"
#include "lodestar/ros/convert/message_drop.hpp"
#include "lodestar/ros/nodelets/edge_drop.hpp"
#include "ros/support/bag_player.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/nodelets.hpp"
#include "ros/support/truth.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

const char* const kNode = "pose_fusion";
const char* const kType = "lodestar/PoseFusionNodelet";

class PoseFusion : public testing::Test {
 protected:
  void SetUp() override {
    ros::param::set("/pose_fusion/memory", memory_);
    std::ofstream(memory_) << "[13]";
    ASSERT_TRUE(load_nodelet(kNode, kType));
    player_.answered_by([this] { return sightings_.size(); });
    ASSERT_TRUE(wait_for([&] { return diagnostics_.heard(kNode); }));
    ASSERT_TRUE(player_.connected({"/camera/image_raw", "/camera/camera_info", "/imu/data", "/odom"}));
    ASSERT_TRUE(wait_for([&] { return sightings_.connected() && poses_.connected() && odometry_.connected(); }));
    ASSERT_TRUE(wait_for([&] { return fix_out_.getNumSubscribers() > 0; }));
    ASSERT_TRUE(wait_for([&] { return sightings_out_.getNumSubscribers() > 1; })) << "the test's own inbox is one";
    player_.send_mounts();
  }

  bool dropped(const char* reason, long at_least) {
    return wait_for([&] { return diagnostics_.count(kNode, std::string("dropped: ") + reason) >= at_least; });
  }

  bool left_out(const std::string& ids) {
    return wait_for([&] {
      return diagnostics_.heard(kNode) && diagnostics_.value(kNode, "left out until confirmed") == ids &&
             (diagnostics_.message(kNode).find("left out until confirmed: beacons " + ids) != std::string::npos) !=
                 ids.empty();
    });
  }

  void confirm(std::uint32_t id, std::uint32_t at_s) {
    BeaconConfirmation confirmation;
    confirmation.header.stamp = ros::Time(at_s);
    confirmation.announcement.beacon_id = id;
    confirmed_out_.publish(confirmation);
  }

  ros::NodeHandle nh_;
  TemporaryFolder folder_;
  const std::string memory_ = folder_ / "distrusted.yaml";
  BagPlayer player_{nh_, ros::param::param<std::string>("/bag", "")};
  Inbox<BeaconSightingArray> sightings_{nh_, "/beacons/sightings"};
  Inbox<geometry_msgs::PoseWithCovarianceStamped> poses_{nh_, "/pose"};
  Inbox<nav_msgs::Odometry> odometry_{nh_, "/odometry/filtered"};
  Inbox<PoseIntegrity> integrity_{nh_, "/pose/integrity"};
  Diagnostics diagnostics_{nh_};
  Inbox<DistrustedBeaconArray> distrusted_{nh_, "/beacons/distrusted"};
  ros::Publisher confirmed_out_ = nh_.advertise<BeaconConfirmation>("/beacons/confirmed", 200);
  ros::Publisher sightings_out_ = nh_.advertise<BeaconSightingArray>("/beacons/sightings", 10);
  ros::Publisher fix_out_ = nh_.advertise<geometry_msgs::PoseWithCovarianceStamped>("/beacons/fix", 10);
  tf2_ros::Buffer tf_;
  tf2_ros::TransformListener tf_listener_{tf_, nh_, false};
};

TEST_F(PoseFusion, FollowsTheTruthAndOutlivesBadInput) {
  // A memory file without the times is none of this version.
  EXPECT_NE(diagnostics_.message(kNode).find(memory_ + " cannot be understood"), std::string::npos)
      << diagnostics_.message(kNode);
  ASSERT_TRUE(unload_nodelet(kNode));
  diagnostics_.forget(kNode);

  // Beacons that were left out before the node began are named, each until it is confirmed after it was found out.
  const auto entry = [](std::uint32_t id) { return "{id: " + std::to_string(id) + ", since_ns: 5000000000}"; };
  std::ofstream known(memory_);
  known << '[' << entry(13) << ',' << entry(14);
  constexpr std::uint32_t kFirst = 100, kBurst = 100;
  for (std::uint32_t id = kFirst; id < kFirst + kBurst; ++id) known << ',' << entry(id);
  known << ']' << std::flush;
  ASSERT_TRUE(load_nodelet(kNode, kType));
  const auto told_left_out = [&](std::size_t count) {
    return wait_for([&] { return !distrusted_.empty() && distrusted_.last().beacons.size() == count; });
  };
  ASSERT_TRUE(told_left_out(2 + kBurst));
  EXPECT_EQ(distrusted_.last().beacons[0].beacon_id, 13u);
  EXPECT_EQ(distrusted_.last().beacons[0].since, ros::Time(5));
  // A node that starts is told all of a site at once: none is lost.
  EXPECT_TRUE(wait_for([&] { return confirmed_out_.getNumSubscribers() > 0; }));
  for (std::uint32_t id = kFirst; id < kFirst + kBurst; ++id) confirm(id, 6);
  ASSERT_TRUE(told_left_out(2)) << distrusted_.last();
  EXPECT_TRUE(left_out("13 14")) << diagnostics_.message(kNode);
  // Told and written only when something changed: neither by an old word nor by one on a beacon in use.
  const std::size_t told = distrusted_.size();
  confirm(13, 5);
  confirm(11, 6);
  confirm(14, 6);
  ASSERT_TRUE(told_left_out(1));
  EXPECT_EQ(distrusted_.size(), told + 1);
  EXPECT_TRUE(left_out("13")) << diagnostics_.message(kNode);
  std::ifstream file(memory_);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(text.find("\n[" + entry(13) + "]"), std::string::npos) << text;
  confirm(13, 6);
  EXPECT_TRUE(left_out("")) << diagnostics_.message(kNode);
  ASSERT_TRUE(player_.connected({"/camera/image_raw", "/camera/camera_info", "/imu/data", "/odom"}));
  ASSERT_TRUE(wait_for([&] { return poses_.connected() && odometry_.connected(); }));

  EXPECT_TRUE(wait_for([&] {
    return diagnostics_.value(kNode, "mode") == name(FilterMode::kStarting) && diagnostics_.level(kNode) >= 1;
  }));
  player_.play(4.0);
  ASSERT_TRUE(player_.play_until([&] { return poses_.size() > 50; })) << poses_.size();
  for (const auto& pose : poses_.all()) {
    EXPECT_EQ(pose->header.frame_id, "map");
    const Offset offset = offset_from_truth(player_.truth(), *pose);
    EXPECT_LT(offset.position_m, 0.15) << "at " << pose->header.stamp;
    EXPECT_LT(offset.yaw_rad, 0.03);
    EXPECT_GT(pose->pose.covariance[0], 0);
  }
  EXPECT_TRUE(wait_for([&] { return diagnostics_.value(kNode, "mode") == name(FilterMode::kTracking); }));
  EXPECT_EQ(diagnostics_.hardware_id(kNode), "truck");

  // The truth lies within the protection level, and no beacon lies.
  ASSERT_TRUE(wait_for([&] { return !integrity_.empty() && integrity_.last().mode == PoseIntegrity::TRACKING; }));
  EXPECT_EQ(integrity_.last().header.frame_id, "map");
  EXPECT_GT(integrity_.last().protection_level_m, 3 * integrity_.last().sigma_major_m);
  EXPECT_LT(offset_from_truth(player_.truth(), poses_.last()).position_m, integrity_.last().protection_level_m);
  EXPECT_GE(integrity_.last().beacons_used, 2u);
  EXPECT_EQ(diagnostics_.value(kNode, "beacons that lie"), "none");

  // The odometry of the filter is the pose with a velocity: here the truck drives.
  ASSERT_FALSE(odometry_.empty());
  EXPECT_EQ(odometry_.last().header.frame_id, "map");
  EXPECT_EQ(odometry_.last().child_frame_id, "base_link");
  EXPECT_NEAR(odometry_.last().twist.twist.linear.x, 0.5, 0.1);

  // map -> odom and the wheels' own pose make the pose.
  const auto wheels = player_.last_odometry();
  ASSERT_TRUE(wait_for([&] { return tf_.canTransform("map", "odom", ros::Time(0)); }));
  const auto T = tf_.lookupTransform("map", "odom", ros::Time(0)).transform;
  const double yaw = yaw_of(T.rotation);
  geometry_msgs::PoseWithCovarianceStamped joined;
  joined.header.stamp = wheels.header.stamp;
  const auto& p = wheels.pose.pose.position;
  joined.pose.pose.position.x = T.translation.x + std::cos(yaw) * p.x - std::sin(yaw) * p.y;
  joined.pose.pose.position.y = T.translation.y + std::sin(yaw) * p.x + std::cos(yaw) * p.y;
  joined.pose.pose.orientation = T.rotation;
  EXPECT_LT(offset_from_truth(player_.truth(), joined).position_m, 0.15);

  // Bad input of each kind.
  auto imu = player_.sample<sensor_msgs::Imu>("/imu/data");
  imu.header.stamp = player_.now();
  imu.angular_velocity.z = std::nan("");
  player_.publish("/imu/data", imu);
  EXPECT_TRUE(dropped(name(MessageDrop::kNotFinite), 1));
  geometry_msgs::PoseWithCovarianceStamped fix = poses_.last();
  fix.header.frame_id = "odom";
  fix_out_.publish(fix);
  EXPECT_TRUE(dropped(name(MessageDrop::kFrame), 1));
  BeaconSightingArray sightings = sightings_.last();
  sightings.header.stamp += ros::Duration(60);
  sightings_out_.publish(sightings);
  EXPECT_TRUE(dropped(name(EdgeDrop::kTimeStep), 1));
  player_.publish("/odom", player_.last_odometry());
  EXPECT_TRUE(wait_for(
      [&] { return diagnostics_.count(kNode, std::string("not used: ") + name(FilterDrop::kDuplicate)) >= 1; }));

  // The line goes on.
  const std::size_t before = poses_.size();
  ASSERT_TRUE(player_.play_until([&] { return poses_.size() > before + 10; }));
  EXPECT_LT(offset_from_truth(player_.truth(), poses_.last()).position_m, 0.15);

  // The clock jumps back: the filter starts anew at once.
  player_.rewind();
  player_.play(2.0);
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "resets") >= 1; }));
  const std::size_t before_jump = poses_.size();
  ASSERT_TRUE(player_.play_until([&] { return poses_.size() > before_jump + 10; }));
  EXPECT_LT(offset_from_truth(player_.truth(), poses_.last()).position_m, 0.15);

  // Wheels without light: coasting, and it says so.
  player_.on<sensor_msgs::Image>("/camera/image_raw", [](const auto&) { return false; });
  const double sigma = std::sqrt(poses_.last().pose.covariance[0]);
  EXPECT_TRUE(player_.play_until([&] { return diagnostics_.value(kNode, "mode") == name(FilterMode::kCoasting); }));
  EXPECT_TRUE(player_.play_until([&] { return std::sqrt(poses_.last().pose.covariance[0]) > sigma; }));
}

}  // namespace
