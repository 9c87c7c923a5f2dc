#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <rosgraph_msgs/Clock.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "lodestar/CorrectPallet.h"
#include "lodestar/FindPallets.h"
#include "lodestar/FreePlaces.h"
#include "lodestar/GetPallet.h"
#include "lodestar/LoadState.h"
#include "lodestar/PalletArray.h"
#include "lodestar/PalletEvent.h"
#include "lodestar/PoseIntegrity.h"
#include "lodestar/base/measurement/sscc.hpp"
#include "lodestar/estimation/pallet/pallet_tracker.hpp"
#include "lodestar/ros/convert/message_drop.hpp"
#include "lodestar/ros/nodelets/edge_drop.hpp"
#include "ros/support/call_service.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/node_process.hpp"
#include "ros/support/waiting.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

const char* const kNode = "pallet_tracking";

std::string sscc(int number) {
  const std::string digits = std::to_string(10000000000000000 + number);
  return digits + gs1_check_digit(digits);
}

class PalletTracking : public testing::Test {
 protected:
  PalletTracking() {
    std::remove(memory_.c_str());
    clock_ = nh_.advertise<rosgraph_msgs::Clock>("/clock", 100);
    pose_ = nh_.advertise<geometry_msgs::PoseWithCovarianceStamped>("/pose", 500);
    integrity_ = nh_.advertise<PoseIntegrity>("/pose/integrity", 10);
    load_ = nh_.advertise<LoadState>("/load", 500);
    pose_message_.header.frame_id = "map";
    pose_message_.pose.pose.orientation.w = 1;
    for (const int i : {0, 7, 14}) pose_message_.pose.covariance[static_cast<std::size_t>(i)] = 1e-4;
    for (const int i : {21, 28, 35}) pose_message_.pose.covariance[static_cast<std::size_t>(i)] = 1e-6;
    load_message_.header.frame_id = "fork";
    ros::param::del("/pallet_tracking");
    for (const std::string key : {"site", "vehicle", "memory"})
      ros::param::set("/pallet_tracking/" + key, ros::param::param<std::string>("/" + key, ""));
    ros::param::set("/pallet_tracking/diagnostic_period", 0.1);
    start();
  }

  void start() {
    EXPECT_TRUE(wait_for([&] { return pose_.getNumSubscribers() == 0 && load_.getNumSubscribers() == 0; }))
        << "of an earlier life";
    diagnostics_.forget(kNode);
    poses_ = loads_ = 0;
    node_ = std::make_unique<NodeProcess>(kNode);
    EXPECT_TRUE(wait_for([&] {
      tick(0);
      return pose_.getNumSubscribers() > 0 && load_.getNumSubscribers() > 0 && events_.connected() &&
             ros::service::exists("/pallets/free_places", false);
    }));
  }
  void tick(double step_s) {
    now_ += ros::Duration(step_s);
    rosgraph_msgs::Clock clock;
    clock.clock = now_;
    clock_.publish(clock);
    ros::spinOnce();
  }
  void stand(double x, double y) {
    pose_message_.pose.pose.position.x = x - 1.6;
    pose_message_.pose.pose.position.y = y;
  }
  void publish(const geometry_msgs::PoseWithCovarianceStamped& pose) {
    pose_.publish(pose);
    ++poses_;
  }
  void publish(const LoadState& load) {
    load_.publish(load);
    ++loads_;
  }
  /// The node had time for all that it was told.
  bool all_is_taken() {
    return wait_for([&] {
      return diagnostics_.count(kNode, "pose count") == poses_ && diagnostics_.count(kNode, "load count") == loads_;
    });
  }
  /// Three quarters of a second of poses, which may be told late, and then of the load samples in between.
  void work(bool present, const std::string& label = "", double z_m = 0) {
    constexpr int kSamples = 15;
    const ros::Time began = now_;
    EXPECT_TRUE(all_is_taken());
    for (int i = 0; i < kSamples; ++i) {
      tick(0.05);
      pose_message_.header.stamp = now_;
      publish(pose_message_);
    }
    EXPECT_TRUE(all_is_taken());  // the two topics are two connections
    load_message_.load_present = present;
    load_message_.fork_height_m = 0.1 + z_m;
    load_message_.load_id = label;
    for (int i = 1; i <= kSamples; ++i) {
      load_message_.header.stamp = began + ros::Duration(0.05 * i);
      publish(load_message_);
    }
  }
  /// What happened, once so many events came in all.
  const PalletEvent& event(std::size_t count) {
    EXPECT_TRUE(wait_for([&] { return events_.size() >= count; })) << events_.size() << " of " << count;
    static const PalletEvent none;
    return events_.size() >= count ? *events_.all()[count - 1] : none;
  }
  bool counted(const std::string& key, long at_least) {
    return wait_for([&] { return diagnostics_.count(kNode, key) >= at_least; });
  }
  template <class Service>
  typename Service::Response call(const std::string& name, const typename Service::Request& request) {
    Service service;
    service.request = request;
    EXPECT_TRUE(call_service(name, service)) << name;
    return service.response;
  }
  GetPallet::Response get(const std::string& id) {
    GetPallet::Request request;
    request.id = id;
    return call<GetPallet>("/pallets/get", request);
  }

  ros::NodeHandle nh_;
  std::string memory_ = ros::param::param<std::string>("/memory", "");
  ros::Time now_{1000};
  ros::Publisher clock_, pose_, integrity_, load_;
  long poses_ = 0, loads_ = 0;  ///< that were told to the node
  geometry_msgs::PoseWithCovarianceStamped pose_message_;
  LoadState load_message_;
  Inbox<PalletEvent> events_{nh_, "/pallets/events"};
  Inbox<PalletArray> state_{nh_, "/pallets/state"};
  Diagnostics diagnostics_{nh_};
  std::unique_ptr<NodeProcess> node_;
};

TEST_F(PalletTracking, KeepsPalletsTellsThemAndOutlivesARestart) {
  // Brought to place A/1/1.
  work(false);
  stand(20, 0);
  work(true, sscc(1));
  EXPECT_EQ(event(1).kind, PalletEvent::PICK);
  EXPECT_EQ(event(1).pallet.sscc, sscc(1));
  EXPECT_EQ(event(1).pallet.id.size(), 36u) << "a UUID";
  EXPECT_EQ(event(1).header.frame_id, "map");
  stand(1, 0.5);
  work(false);
  const std::string first = event(2).pallet.id;
  EXPECT_EQ(event(2).kind, PalletEvent::DROP);
  EXPECT_EQ(event(2).pallet.state, PalletEntry::STANDING);
  EXPECT_EQ(event(2).pallet.zone, "A");
  EXPECT_NEAR(event(2).pallet.pose.pose.position.x, 1, 1e-6);
  EXPECT_EQ(event(2).sequence, 2u);

  // Services.
  EXPECT_TRUE(get(first).found);
  EXPECT_EQ(get(sscc(1)).place, "A/1/1");
  EXPECT_EQ(get(sscc(1)).sequence, 2u);
  EXPECT_FALSE(get("nobody").found);
  EXPECT_FALSE(get("").found);
  FreePlaces::Request places;
  places.zone = "A";
  EXPECT_EQ(call<FreePlaces>("/pallets/free_places", places).codes,
            (std::vector<std::string>{"A/1/2", "A/2/1", "A/2/2"}));
  places.zone = "B";
  EXPECT_EQ(call<FreePlaces>("/pallets/free_places", places).codes, (std::vector<std::string>{"B", "B"}));
  places.zone = "OUT";
  EXPECT_FALSE(call<FreePlaces>("/pallets/free_places", places).success);
  FindPallets::Request find;
  EXPECT_EQ(call<FindPallets>("/pallets/find", find).pallets.size(), 1u);
  find.zone = "B";
  EXPECT_TRUE(call<FindPallets>("/pallets/find", find).pallets.empty());
  find.zone = "A";
  find.since = now_ + ros::Duration(1);
  EXPECT_TRUE(call<FindPallets>("/pallets/find", find).pallets.empty());
  find.since = ros::Time();
  find.until = ros::Time(1000);
  EXPECT_TRUE(call<FindPallets>("/pallets/find", find).pallets.empty()) << "it was not there yet";
  find.until = now_ + ros::Duration(1);
  find.id = sscc(2);
  EXPECT_TRUE(call<FindPallets>("/pallets/find", find).pallets.empty()) << "another";
  find.id = sscc(1).substr(0, 5);
  find.area.points.resize(2);
  EXPECT_FALSE(call<FindPallets>("/pallets/find", find).success);
  find.area.points.resize(3);
  find.area.points[1].x = find.area.points[2].y = 1e38F;
  EXPECT_FALSE(call<FindPallets>("/pallets/find", find).success) << "farther than anything is";
  find.area.points[1].x = 1.4;  // beside it
  find.area.points[2].y = 0.1;
  EXPECT_TRUE(call<FindPallets>("/pallets/find", find).pallets.empty());
  find.area.points[1].x = find.area.points[2].y = 3;
  EXPECT_EQ(call<FindPallets>("/pallets/find", find).pallets.size(), 1u);

  // Killed with a pallet on the fork, and started again.
  work(true);
  EXPECT_EQ(event(3).pallet.id, first);
  node_->end(SIGKILL);
  start();
  EXPECT_TRUE(wait_for([&] { return !state_.empty() && state_.last().pallets.size() == 1; }));
  work(true);
  stand(1, 1.4);
  work(false);
  EXPECT_EQ(event(4).pallet.id, first);
  EXPECT_EQ(event(4).sequence, 4u);
  EXPECT_EQ(get(first).place, "A/1/2");

  // Set down while localization coasts.
  work(true);
  event(5);
  const auto told = [&](std::uint8_t mode, bool coasting) {
    return wait_for([&] {
      // No more at once than the node keeps of what it had no time for.
      if (!all_is_taken()) return false;
      tick(0.05);
      PoseIntegrity integrity;
      integrity.header.stamp = pose_message_.header.stamp = now_;
      integrity.mode = mode;
      integrity_.publish(integrity);
      publish(pose_message_);
      return state_.last().pallets.at(0).coasting == coasting;
    });
  };
  EXPECT_TRUE(told(PoseIntegrity::COASTING, true));
  EXPECT_TRUE(told(PoseIntegrity::TRACKING, false));
  EXPECT_TRUE(told(PoseIntegrity::COASTING, true));
  work(true);
  work(false);
  EXPECT_TRUE(event(6).pallet.coasting);

  // A person knows better.
  CorrectPallet::Request correct;
  correct.id = first;
  correct.has_pose = true;
  correct.pose.orientation.w = 1;
  correct.pose.position.x = 11;
  correct.pose.position.y = 0.4;
  correct.reason = "moved by hand";
  EXPECT_FALSE(call<CorrectPallet>("/pallets/correct", correct).success) << "no sigma";
  correct.yaw_sigma_rad = 0.05;
  correct.position_sigma_m = 1e200;
  const auto refused = call<CorrectPallet>("/pallets/correct", correct);
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("1e+200"), std::string::npos) << refused.message;
  EXPECT_NE(refused.message.find("1000"), std::string::npos) << refused.message;
  correct.position_sigma_m = 0.05;
  EXPECT_TRUE(call<CorrectPallet>("/pallets/correct", correct).success);
  EXPECT_EQ(event(7).kind, PalletEvent::CORRECTION);
  EXPECT_EQ(event(7).corrects, 6u);
  EXPECT_EQ(event(7).reason, "moved by hand");
  EXPECT_EQ(event(7).pallet.zone, "B");
  correct.sscc = "123";
  EXPECT_FALSE(call<CorrectPallet>("/pallets/correct", correct).success);
  correct.sscc.clear();
  correct.place = "A/1/2";
  EXPECT_FALSE(call<CorrectPallet>("/pallets/correct", correct).success) << "a pose and a place";
  correct.has_pose = false;
  correct.place = "A/99/1";
  EXPECT_FALSE(call<CorrectPallet>("/pallets/correct", correct).success) << "no such place";
  EXPECT_EQ(events_.size(), 7u);
  correct.place = "A/1/2";
  EXPECT_TRUE(call<CorrectPallet>("/pallets/correct", correct).success);
  EXPECT_EQ(event(8).pallet.zone, "A");
  EXPECT_EQ(get(first).place, "A/1/2");
  find = FindPallets::Request();
  find.zone = "A/1/2";
  EXPECT_EQ(call<FindPallets>("/pallets/find", find).pallets.size(), 1u);
  find.zone = "A/1/1";
  EXPECT_TRUE(call<FindPallets>("/pallets/find", find).pallets.empty());

  // A person says that it left.
  correct.place.clear();
  correct.gone = true;
  EXPECT_TRUE(call<CorrectPallet>("/pallets/correct", correct).success);
  EXPECT_EQ(event(9).pallet.state, PalletEntry::GONE);
  find = FindPallets::Request();
  EXPECT_TRUE(call<FindPallets>("/pallets/find", find).pallets.empty());
  find.gone = true;
  EXPECT_EQ(call<FindPallets>("/pallets/find", find).pallets.size(), 1u);
}

TEST_F(PalletTracking, CountsBadInputAndGoesOn) {
  const auto dropped = [&](const char* reason, long at_least) {
    return counted(std::string("dropped: ") + reason, at_least);
  };
  work(false);
  auto bad_pose = pose_message_;
  bad_pose.pose.pose.position.x = std::nan("");
  publish(bad_pose);
  bad_pose = pose_message_;
  bad_pose.pose.covariance[0] = std::nan("");
  publish(bad_pose);
  EXPECT_TRUE(dropped(name(MessageDrop::kNotFinite), 2));
  bad_pose = pose_message_;
  bad_pose.header.frame_id = "odom";
  publish(bad_pose);
  EXPECT_TRUE(dropped(name(MessageDrop::kFrame), 1));
  auto bad_load = load_message_;
  bad_load.fork_height_m = INFINITY;
  publish(bad_load);
  EXPECT_TRUE(dropped(name(MessageDrop::kNotFinite), 3));
  bad_load.fork_height_m = 1e200;
  publish(bad_load);
  bad_pose = pose_message_;
  bad_pose.pose.pose.position.x = 1e305;
  publish(bad_pose);
  EXPECT_TRUE(dropped(name(MessageDrop::kRange), 2));
  bad_load = load_message_;
  bad_load.header.stamp = ros::Time();
  publish(bad_load);
  EXPECT_TRUE(dropped(name(MessageDrop::kStamp), 1));

  // Late, twice, out of order.
  auto late = load_message_;
  late.load_present = true;
  late.header.stamp -= ros::Duration(0.3);
  publish(late);
  publish(late);
  EXPECT_TRUE(dropped(name(PalletDrop::kLateLoad), 2));
  auto late_pose = pose_message_;
  late_pose.header.stamp -= ros::Duration(0.3);
  publish(late_pose);
  EXPECT_TRUE(dropped(name(PalletDrop::kLatePose), 1));

  // Labels that are none.
  stand(30, 0);
  std::string wrong_digit = sscc(5);
  wrong_digit.back() = wrong_digit.back() == '0' ? '1' : '0';
  work(true, wrong_digit);
  EXPECT_EQ(event(1).pallet.sscc, "");
  EXPECT_TRUE(dropped(name(PalletDrop::kLabel), 1));
  load_message_.load_id = std::string(10000, '7');
  tick(0.05);
  load_message_.header.stamp = now_;
  publish(load_message_);
  work(true, "'; DROP TABLE pallets; --");
  stand(1, 0.5);
  work(false);
  EXPECT_EQ(event(2).pallet.state, PalletEntry::STANDING);

  // No pose for a pick and its drop: told, in doubt.
  tick(0.5);
  for (int i = 0; i < 30; ++i) {
    tick(0.05);
    load_message_.header.stamp = now_;
    load_message_.load_present = i < 15;
    load_message_.load_id.clear();
    publish(load_message_);
  }
  EXPECT_EQ(event(4).pallet.state, PalletEntry::UNCERTAIN);
  EXPECT_TRUE(dropped(name(PalletDrop::kNoPose), 2));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.level(kNode) >= 1; }));
  EXPECT_TRUE(counted("pallets without a place", 1));
  FindPallets::Request find;
  find.id = event(4).pallet.id;
  EXPECT_EQ(call<FindPallets>("/pallets/find", find).pallets.size(), 1u);
  find.area.points.resize(3);
  find.area.points[0].x = find.area.points[0].y = find.area.points[1].y = find.area.points[2].x = -100;
  find.area.points[1].x = find.area.points[2].y = 200;
  EXPECT_TRUE(call<FindPallets>("/pallets/find", find).pallets.empty()) << "nobody knows where it is";

  // The clock goes back: pallets stay.
  now_ -= ros::Duration(500);
  work(false);
  work(false);
  EXPECT_TRUE(counted("resets", 1));
  work(true);
  EXPECT_EQ(event(5).pallet.id, event(2).pallet.id);

  // A file that is none is set aside.
  node_->end(SIGTERM);
  std::ofstream(memory_) << "no pallets";
  start();
  EXPECT_TRUE(wait_for([&] { return diagnostics_.message(kNode).find("set aside") != std::string::npos; }));
  EXPECT_TRUE(std::ifstream(memory_ + ".broken").good());
}

}  // namespace
