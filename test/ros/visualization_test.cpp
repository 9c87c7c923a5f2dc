#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/MarkerArray.h>

#include "lodestar/BeaconSightingArray.h"
#include "lodestar/PalletArray.h"
#include "lodestar/ros/convert/message_drop.hpp"
#include "ros/support/bag_player.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

const char* const kNode = "visualization";

/// How many markers of the namespace a message adds.
int added(const visualization_msgs::MarkerArray& array, const std::string& ns) {
  int count = 0;
  for (const auto& marker : array.markers) count += marker.ns == ns && marker.action == 0 ? 1 : 0;
  return count;
}

TEST(Visualization, DrawsSiteTruckBearingsPathAndImage) {
  ros::NodeHandle nh;
  BagPlayer player(nh, ros::param::param<std::string>("/bag", ""));
  Inbox<visualization_msgs::MarkerArray> floor(nh, "/visualization/floor"), beacons(nh, "/visualization/beacons"),
      truck(nh, "/visualization/truck");
  Inbox<nav_msgs::Path> path(nh, "/visualization/path");
  Inbox<sensor_msgs::Image> images(nh, "/beacons/image");
  Inbox<BeaconSightingArray> sightings(nh, "/beacons/sightings");
  Diagnostics diagnostics(nh);
  ros::Publisher pose = nh.advertise<geometry_msgs::PoseWithCovarianceStamped>("/pose", 10);

  // The site is there before anything moves, also for those who come late.
  ASSERT_TRUE(wait_for([&] { return !floor.empty() && !beacons.empty(); }));
  EXPECT_EQ(added(floor.last(), "floor"), 3);
  EXPECT_EQ(added(beacons.last(), "beacons"), 4);
  EXPECT_EQ(added(beacons.last(), "beacon ids"), 4);

  ASSERT_TRUE(player.connected({"/camera/image_raw", "/camera/camera_info", "/imu/data", "/odom"}));
  ASSERT_TRUE(wait_for([&] { return sightings.connected() && images.connected() && truck.connected(); }));
  player.answered_by([&] { return sightings.size(); });
  player.send_mounts();
  ASSERT_TRUE(player.play_until([&] {
    return truck.size() > 5 && images.size() > 5 && !path.empty() && path.last().poses.size() > 3 &&
           added(truck.last(), "truck") > 10 && added(truck.last(), "covariance") == 1 &&
           added(truck.last(), "bearings") == 1 && added(truck.last(), "protection level") == 1;
  }));
  std::size_t most_ends = 0;
  EXPECT_TRUE(player.play_until([&] {
    for (const auto& marker : truck.last().markers)
      if (marker.ns == "bearings") most_ends = std::max(most_ends, marker.points.size());
    return most_ends == 8;
  })) << "four beacons, two ends each, and not "
      << most_ends;
  EXPECT_EQ(images.last().encoding, "bgr8");
  EXPECT_EQ(images.last().width, 320u);
  // A ring is coloured, the camera is not.
  EXPECT_TRUE(player.play_until([&] {
    const auto& pixels = images.last().data;
    int coloured = 0;
    for (std::size_t i = 0; i + 2 < pixels.size(); i += 3) coloured += pixels[i] != pixels[i + 1] ? 1 : 0;
    return coloured > 100;
  }));

  // A pose that is none, and an image cut short.
  geometry_msgs::PoseWithCovarianceStamped bad;
  bad.header.stamp = player.now();
  bad.header.frame_id = "map";
  bad.pose.pose.position.x = std::nan("");
  bad.pose.pose.orientation.w = 1;
  ASSERT_TRUE(wait_for([&] { return pose.getNumSubscribers() > 0; }));
  pose.publish(bad);
  EXPECT_TRUE(wait_for(
      [&] { return diagnostics.count(kNode, std::string("dropped: ") + name(MessageDrop::kNotFinite)) >= 1; }));
  auto truncated = player.sample<sensor_msgs::Image>("/camera/image_raw");
  truncated.data.resize(100);
  player.publish("/camera/image_raw", truncated);
  EXPECT_TRUE(wait_for(
      [&] { return diagnostics.count(kNode, std::string("dropped: ") + name(MessageDrop::kTruncated)) >= 1; }));
  const std::size_t before = truck.size();
  EXPECT_TRUE(player.play_until([&] { return truck.size() > before; }));
}

const visualization_msgs::Marker* named(const visualization_msgs::MarkerArray& array, const std::string& ns,
                                        const std::string& text) {
  for (const auto& marker : array.markers)
    if (marker.ns == ns && marker.text.find(text) != std::string::npos) return &marker;
  return nullptr;
}

TEST(Visualization, DrawsPalletsWithIdsAndAges) {
  ros::NodeHandle nh;
  Inbox<visualization_msgs::MarkerArray> markers(nh, "/visualization/pallets");
  ros::Publisher state = nh.advertise<PalletArray>("/pallets/state", 1, true);
  PalletArray pallets;
  const auto add = [&](const std::string& id, const std::string& sscc, std::uint8_t what, double x) {
    PalletEntry entry;
    entry.id = id;
    entry.sscc = sscc;
    entry.type = "epal";
    entry.state = what;
    entry.changed = ros::Time::now() - ros::Duration(120);
    entry.pose.pose.position.x = x;
    entry.pose.pose.orientation.w = 1;
    pallets.pallets.push_back(entry);
  };
  add("aaaaaaaa-1", "106141412345678908", PalletEntry::STANDING, 3);
  add("bbbbbbbb-2", "", PalletEntry::UNCERTAIN, 5);
  add("cccccccc-3", "", PalletEntry::GONE, 7);
  add("dddddddd-4", "", PalletEntry::UNCERTAIN, 9);
  for (const std::size_t i : {0, 7, 14, 21, 28, 35}) pallets.pallets.back().pose.covariance[i] = 1e6;
  state.publish(pallets);
  ASSERT_TRUE(wait_for([&] { return !markers.empty() && added(markers.last(), "pallets") == 2; }));
  EXPECT_EQ(added(markers.last(), "goods"), 2);
  const auto* read = named(markers.last(), "pallet ids", "...8908\n2 min");
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(read->pose.position.x, 3);
  const auto* unread = named(markers.last(), "pallet ids", "bbbbbb ?\n2 min");
  ASSERT_NE(unread, nullptr);
  EXPECT_EQ(unread->pose.position.x, 5);
  EXPECT_EQ(named(markers.last(), "pallet ids", "dddddd"), nullptr) << "nobody knows where it is";
  for (const auto& marker : markers.last().markers) {
    if (marker.ns != "pallets") continue;
    EXPECT_EQ(marker.scale.x, 1.2);
    EXPECT_EQ(marker.scale.y, 0.8);
    EXPECT_NEAR(marker.pose.position.z, 0.5 * marker.scale.z, 1e-9) << "stands on the floor";
  }
  pallets.pallets.clear();
  state.publish(pallets);
  EXPECT_TRUE(wait_for([&] { return added(markers.last(), "pallets") == 0; }));
}

}  // namespace
