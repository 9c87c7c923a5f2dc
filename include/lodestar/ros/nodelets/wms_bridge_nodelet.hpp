#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nodelet/nodelet.h>
#include <sensor_msgs/BatteryState.h>

#include <memory>
#include <set>
#include <string>

#include "lodestar/PalletArray.h"
#include "lodestar/PalletEvent.h"
#include "lodestar/PoseIntegrity.h"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/mqtt_link.hpp"

namespace lodestar {

/// `pallets/events` to the warehouse's software over MQTT: Bridge as a nodelet (docs/nodes/wms_bridge.md).
class WmsBridgeNodelet : public nodelet::Nodelet {
 public:
  ~WmsBridgeNodelet() override;

 private:
  void onInit() override;
  void take_event(const PalletEventConstPtr& message);
  void record(const PalletEvent& message);
  void catch_up();
  void take_state(const PalletArrayConstPtr& message);
  void take_pose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  void take_integrity(const PoseIntegrityConstPtr& message);
  void take_battery(const sensor_msgs::BatteryStateConstPtr& message);
  void report(Health::Status& status);
  void report_trouble(Health::Status& status);

  std::string map_frame_;
  std::vector<std::string> brokers_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<MqttLink> link_;
  std::unique_ptr<Bridge> bridge_;
  StreamWatch* events_watch_ = nullptr;
  StreamWatch* pose_watch_ = nullptr;
  std::uint64_t told_ = 0;        ///< number of the newest event that pallet tracking has
  bool same_count_ = false;       ///< its count is known to be the one that was heard last
  std::set<std::string> lifted_;  ///< ids of what the fork took, in doubt or not
  ros::Subscriber events_, state_, pose_, integrity_, battery_;
  ros::ServiceClient events_after_;
  ros::WallTimer poll_, watch_;
};

}  // namespace lodestar
