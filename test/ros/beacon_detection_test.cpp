#include <gtest/gtest.h>

#include <cmath>

#include "lodestar/BeaconSightingArray.h"
#include "lodestar/ros/convert/message_drop.hpp"
#include "lodestar/ros/nodelets/edge_drop.hpp"
#include "lodestar/sensing/beacon/beacon_detector.hpp"
#include "ros/support/bag_player.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

const char* const kNode = "beacon_detection";

class BeaconDetection : public testing::Test {
 protected:
  void SetUp() override {
    player_.answered_by([this] { return sightings_.size(); });
    ASSERT_TRUE(wait_for([&] { return diagnostics_.heard(kNode); }));
    ASSERT_TRUE(player_.connected({"/camera/image_raw", "/camera/camera_info", "/imu/data", "/odom"}));
    ASSERT_TRUE(wait_for([&] { return sightings_.connected(); }));
  }

  bool dropped(const char* reason, long at_least) {
    return wait_for([&] { return diagnostics_.count(kNode, std::string("dropped: ") + reason) >= at_least; });
  }
  /// Four named beacons in one window, after now.
  bool sees_all_beacons() {
    std::size_t next = sightings_.size();
    return player_.play_until([&] {
      for (; next < sightings_.size(); ++next)
        if (named(*sightings_.all()[next]) == 4) return true;
      return false;
    });
  }
  /// Whatever the node made of images was heard.
  bool all_is_heard() {
    return wait_for(
        [&] { return diagnostics_.count(kNode, "sightings count") == static_cast<long>(sightings_.size()); });
  }
  static int named(const BeaconSightingArray& array) {
    int count = 0;
    for (const auto& sighting : array.sightings) count += sighting.named ? 1 : 0;
    return count;
  }
  sensor_msgs::Image image_now() const {
    auto image = player_.sample<sensor_msgs::Image>("/camera/image_raw");
    image.header.stamp = player_.now();
    return image;
  }
  void send(const sensor_msgs::Image& image) { player_.publish("/camera/image_raw", image); }

  ros::NodeHandle nh_;
  BagPlayer player_{nh_, ros::param::param<std::string>("/bag", "")};
  Inbox<BeaconSightingArray> sightings_{nh_, "/beacons/sightings"};
  Diagnostics diagnostics_{nh_};
};

TEST_F(BeaconDetection, SeesAndNamesBeaconsAndOutlivesBadInput) {
  // Images alone: no calibration, no mount. Nothing is guessed.
  player_.on<sensor_msgs::CameraInfo>("/camera/camera_info", [](const auto&) { return false; });
  player_.play(1.0);  // the first 21 tell the frame rate
  EXPECT_TRUE(dropped(name(EdgeDrop::kNoCameraInfo), 10));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.level(kNode) >= 1; }));

  // A calibration of NaN is no calibration.
  auto nan_info = player_.sample<sensor_msgs::CameraInfo>("/camera/camera_info");
  nan_info.K[0] = std::nan("");
  player_.publish("/camera/camera_info", nan_info);
  EXPECT_TRUE(dropped(name(EdgeDrop::kCameraInfo), 1));

  // Calibrated, but nobody says where the camera sits.
  player_.on<sensor_msgs::CameraInfo>("/camera/camera_info", [](const auto&) { return true; });
  player_.play(0.3);
  EXPECT_TRUE(dropped(name(EdgeDrop::kNoMount), 1));
  EXPECT_TRUE(sightings_.empty());

  player_.send_mounts();
  ASSERT_TRUE(sees_all_beacons());
  const BeaconSightingArray& last = sightings_.last();
  EXPECT_EQ(last.header.frame_id, "camera_optical_frame");
  for (const auto& sighting : last.sightings) {
    if (!sighting.named) continue;
    EXPECT_GE(sighting.beacon_id, 11u);
    EXPECT_LE(sighting.beacon_id, 14u);
    EXPECT_EQ(sighting.tones.size(), 2u);
    EXPECT_EQ(sighting.tones.size(), sighting.tones_hz.size());
    EXPECT_GT(sighting.snr_db, 6);
    EXPECT_GT(sighting.covariance_px2[0], 0);
  }
  EXPECT_TRUE(player_.play_until([&] { return diagnostics_.level(kNode) == 0; })) << diagnostics_.message(kNode);

  // Bad images, each of its kind.
  auto truncated = image_now();
  truncated.data.resize(truncated.data.size() / 2);
  send(truncated);
  EXPECT_TRUE(dropped(name(MessageDrop::kTruncated), 1));
  ASSERT_TRUE(all_is_heard());  // also of the images before this one
  const std::size_t before = sightings_.size();
  auto coloured = image_now();
  coloured.encoding = "rgb8";
  send(coloured);
  EXPECT_TRUE(dropped(name(MessageDrop::kEncoding), 1));
  auto small = image_now();
  small.header.stamp += ros::Duration(0.001);
  small.width /= 2;
  small.height /= 2;
  small.step = small.width;
  small.data.resize(small.step * small.height);
  send(small);
  EXPECT_TRUE(dropped(name(FrameDrop::kSize), 1));
  auto unstamped = image_now();
  unstamped.header.stamp = ros::Time();
  send(unstamped);
  EXPECT_TRUE(dropped(name(MessageDrop::kStamp), 1));
  auto late = image_now();
  late.header.stamp -= ros::Duration(0.5);
  send(late);
  EXPECT_TRUE(dropped(name(FrameDrop::kBackwards), 1));
  auto future = image_now();
  future.header.stamp += ros::Duration(30);
  send(future);
  EXPECT_TRUE(dropped(name(EdgeDrop::kTimeStep), 1));
  player_.publish("/camera/camera_info", nan_info);
  EXPECT_TRUE(dropped(name(EdgeDrop::kCameraInfo), 2));
  ASSERT_TRUE(all_is_heard());
  EXPECT_EQ(sightings_.size(), before);

  // The line goes on, and images need no camera_info of their own.
  player_.on<sensor_msgs::CameraInfo>("/camera/camera_info", [](const auto&) { return false; });
  EXPECT_TRUE(sees_all_beacons());

  // The clock jumps back.
  player_.rewind();
  EXPECT_TRUE(player_.play_until([&] { return diagnostics_.count(kNode, "resets") >= 1; }));
  EXPECT_TRUE(sees_all_beacons());
  EXPECT_EQ(diagnostics_.hardware_id(kNode), "truck");

  // No more images: stale.
  EXPECT_TRUE(wait_for([&] { return diagnostics_.level(kNode) == 2; })) << diagnostics_.message(kNode);
}

TEST_F(BeaconDetection, TonesThatDoNotSuitTheMeasuredRateStopTheSearch) {
  const char* const alias = "beacon_detection_alias";
  player_.send_mounts();
  EXPECT_TRUE(player_.play_until(  // the first 21 images tell the frame rate
      [&] { return diagnostics_.count(alias, std::string("dropped: ") + name(EdgeDrop::kTones)) >= 5; }));
  EXPECT_EQ(diagnostics_.level(alias), 2);
  EXPECT_NE(diagnostics_.message(alias).find("site_alias.yaml:3"), std::string::npos) << diagnostics_.message(alias);
}

}  // namespace
