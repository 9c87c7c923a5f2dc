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
#include "lodestar/wms/event_intake.hpp"
#include "lodestar/wms/mqtt_link.hpp"

namespace lodestar {

/// Which event this is, whether it can be converted or not.
HeardEvent heard_event(const PalletEvent& message);

/// `pallets/events` to the warehouse's software over MQTT: Bridge as a nodelet (docs/nodes/wms_bridge.md).
class WmsBridgeNodelet : public nodelet::Nodelet {
 public:
  ~WmsBridgeNodelet() override;

 private:
  void onInit() override;
  void poll();
  bool follow_store();
  void catch_up();
  void record(const PalletEvent& message);
  void take_event(const PalletEventConstPtr& message);
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
  EventIntake<PalletEvent> intake_;
  std::string stream_;            ///< of the store that the intake goes on from
  std::set<std::string> lifted_;  ///< ids of what the fork took, in doubt or not
  ros::Subscriber events_, state_, pose_, integrity_, battery_;
  ros::ServiceClient events_after_;
  ros::WallTimer poll_;
};

}  // namespace lodestar
