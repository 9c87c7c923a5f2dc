#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>

#include "lodestar/IrFrame.h"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/node_process.hpp"
#include "ros/support/waiting.hpp"

namespace {

using namespace lodestar::test;

TEST(SimulationNodelet, SpeaksAsAVehicleDoesAndStopsWithItsScenario) {
  ros::NodeHandle nh;
  Inbox<sensor_msgs::Image> images(nh, "/camera/image_raw");
  Inbox<sensor_msgs::CameraInfo> infos(nh, "/camera/camera_info");
  Inbox<sensor_msgs::Imu> imu(nh, "/imu/data");
  Inbox<nav_msgs::Odometry> odometry(nh, "/odom");
  Inbox<lodestar::IrFrame> ir(nh, "/ir/frames");
  Inbox<geometry_msgs::PoseStamped> truth(nh, "/ground_truth/pose");
  Inbox<rosgraph_msgs::Clock> clock(nh, "/clock");
  Diagnostics diagnostics(nh);
  tf2_ros::Buffer tf;
  tf2_ros::TransformListener listener(tf, nh, false);

  // A node of its own, as a user may run it, not a nodelet. Where the eight seconds of its scenario are over before a
  // busy machine has connected the two, it begins again.
  const char* const node = "simulation";
  const auto over = [&] { return diagnostics.message(node).find("over") != std::string::npos; };
  const auto spoken = [&] {
    return images.size() > 20 && infos.size() > 20 && imu.size() > 50 && odometry.size() > 20 && ir.size() > 3 &&
           truth.size() > 50;
  };
  std::unique_ptr<NodeProcess> simulation;
  for (int i = 0; i < 5 && !spoken(); ++i) {
    simulation = std::make_unique<NodeProcess>(node);
    diagnostics.forget(node);
    wait_for([&] { return spoken() || over(); });
  }
  ASSERT_TRUE(spoken());
  EXPECT_EQ(images.last().encoding, "mono8");
  EXPECT_EQ(images.last().header.frame_id, "camera_optical_frame");
  EXPECT_EQ(infos.last().distortion_model, "equidistant");
  EXPECT_EQ(infos.last().width, images.last().width);
  EXPECT_EQ(imu.last().orientation_covariance[0], -1) << "this IMU has no orientation";
  EXPECT_EQ(odometry.last().child_frame_id, "base_link");
  EXPECT_EQ(truth.last().header.frame_id, "map");
  EXPECT_FALSE(clock.empty());
  for (const char* frame : {"camera_optical_frame", "imu_link", "ir_array", "fork", "odom"})
    EXPECT_TRUE(wait_for([&] { return tf.canTransform("base_link", frame, ros::Time(0)); })) << frame;
  EXPECT_TRUE(wait_for([&] { return diagnostics.value(node, "scenario") == "rostest"; }));
  // Eight seconds, then it says that it is over.
  EXPECT_TRUE(wait_for(over));
}

}  // namespace
