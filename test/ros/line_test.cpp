// The whole line on a bag that rosbag itself plays, again and again: replay.launch as a user starts it.
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/BeaconSightingArray.h"
#include "lodestar/IrFrame.h"
#include "lodestar/estimation/fusion/pose_filter.hpp"
#include "lodestar/ros/convert/message_drop.hpp"
#include "lodestar/ros/nodelets/edge_drop.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/nodelets.hpp"
#include "ros/support/truth.hpp"
#include "ros/support/waiting.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

class Line : public testing::Test {
 protected:
  bool localized(std::size_t more) {
    const std::size_t before = poses_.size();
    return wait_for([&] { return poses_.size() >= before + more; });
  }
  bool dropped(const std::string& node, const std::string& reason) {
    return wait_for([&] { return diagnostics_.count(node, "dropped: " + reason) >= 1; });
  }
  std::vector<geometry_msgs::PoseStamped> truth() const {
    std::vector<geometry_msgs::PoseStamped> out;
    for (const auto& pose : truth_.all()) out.push_back(*pose);
    return out;
  }

  ros::NodeHandle nh_;
  Inbox<BeaconAnnouncement> announcements_{nh_, "/beacons/announcements"};
  Inbox<BeaconSightingArray> sightings_{nh_, "/beacons/sightings"};
  Inbox<geometry_msgs::PoseWithCovarianceStamped> fixes_{nh_, "/beacons/fix"}, poses_{nh_, "/pose"};
  Inbox<geometry_msgs::PoseStamped> truth_{nh_, "/ground_truth/pose"};
  Inbox<tf2_msgs::TFMessage> tf_{nh_, "/tf"};
  Inbox<sensor_msgs::Image> images_{nh_, "/camera/image_raw"};
  Inbox<lodestar::IrFrame> frames_{nh_, "/ir/frames"};
  Diagnostics diagnostics_{nh_};
  ros::Publisher image_out_ = nh_.advertise<sensor_msgs::Image>("/camera/image_raw", 10);
  ros::Publisher info_out_ = nh_.advertise<sensor_msgs::CameraInfo>("/camera/camera_info", 10);
  ros::Publisher frame_out_ = nh_.advertise<lodestar::IrFrame>("/ir/frames", 10);
};

TEST_F(Line, LocalizesOnABagAndOutlivesBadInputRestartsAndTheBagsEnd) {
  ASSERT_TRUE(localized(30));
  ASSERT_TRUE(wait_for([&] { return announcements_.size() > 5 && sightings_.size() > 20 && fixes_.size() > 5; }));
  EXPECT_TRUE(wait_for([&] { return !tf_.empty(); }));
  EXPECT_EQ(tf_.last().transforms.at(0).header.frame_id, "map");
  EXPECT_EQ(tf_.last().transforms.at(0).child_frame_id, "odom");
  ASSERT_TRUE(wait_for([&] { return !truth_.empty() && truth_.last().header.stamp >= poses_.last().header.stamp; }));
  for (const auto& pose : poses_.all()) EXPECT_LT(offset_from_truth(truth(), *pose).position_m, 0.15);
  for (const char* node : {"ir_decoding", "beacon_detection", "pose_solving", "pose_fusion"})
    EXPECT_TRUE(wait_for([&] { return diagnostics_.level(node) == 0; })) << node << ": " << diagnostics_.message(node);

  // Bad input while the bag plays, to the nodes and not to the test's own inboxes alone.
  ASSERT_TRUE(wait_for([&] {
    return image_out_.getNumSubscribers() > 1 && info_out_.getNumSubscribers() > 0 &&
           frame_out_.getNumSubscribers() > 1;
  }));
  auto image = images_.last();
  image.data.resize(10);
  image_out_.publish(image);
  EXPECT_TRUE(dropped("beacon_detection", name(MessageDrop::kTruncated)));
  image = images_.last();
  image.encoding = "bgr8";
  image_out_.publish(image);
  EXPECT_TRUE(dropped("beacon_detection", name(MessageDrop::kEncoding)));
  sensor_msgs::CameraInfo info;
  info.header = images_.last().header;
  info.distortion_model = "equidistant";
  info.width = 320;
  info.height = 240;
  info.K.fill(std::nan(""));
  info.D.assign(4, 0);
  info_out_.publish(info);
  for (const char* node : {"beacon_detection", "pose_solving", "pose_fusion"})
    EXPECT_TRUE(dropped(node, name(EdgeDrop::kCameraInfo))) << node;
  ASSERT_FALSE(frames_.empty());
  auto damaged = frames_.last();
  for (int i = 8; i < 20; ++i) damaged.octets[i] ^= 0xa5;
  frame_out_.publish(damaged);
  EXPECT_TRUE(dropped("ir_decoding", name(IrDrop::kUncorrectable)));
  EXPECT_TRUE(localized(20));

  // Any one node may be restarted.
  const std::string manager = "lodestar_manager";
  for (const auto& [node, type] : {std::pair("pose_fusion", "lodestar/PoseFusionNodelet"),
                                   std::pair("beacon_detection", "lodestar/BeaconDetectionNodelet")}) {
    ASSERT_TRUE(unload_nodelet(node, manager)) << node;
    // Not with a parameter that it does not know ...
    const std::string unknown = std::string("/") + node + "/no_such_thing";
    ros::param::set(unknown, 1);
    EXPECT_FALSE(load_nodelet(node, type, manager)) << node;
    ros::param::del(unknown);
    ASSERT_TRUE(load_nodelet(node, type, manager)) << node;
    EXPECT_TRUE(localized(20)) << node;
  }

  // The bag begins again by itself: its clock jumps back, and the truck is where the bag says.
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count("pose_solving", "resets") >= 1; }));
  poses_.clear();
  ASSERT_TRUE(localized(20));
  ASSERT_TRUE(wait_for([&] { return truth_.last().header.stamp >= poses_.last().header.stamp; }));
  EXPECT_LT(offset_from_truth(truth(), poses_.last()).position_m, 0.15);
}

}  // namespace
