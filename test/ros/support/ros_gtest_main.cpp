#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_client");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
