#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nodelet/nodelet.h>

#include <memory>

#include "lodestar/LoadState.h"
#include "lodestar/PoseIntegrity.h"
#include "lodestar/estimation/pallet/pallet_tracker.hpp"
#include "lodestar/ros/nodelets/pallet_file.hpp"
#include "lodestar/ros/nodelets/pallet_services.hpp"
#include "lodestar/ros/nodelets/stage_edge.hpp"

namespace lodestar {

/// `pose` and `load` in, `pallets/events` and `pallets/state` out: the pallet tracker as a nodelet
/// (docs/nodes/pallet_tracking.md).
class PalletTrackingNodelet : public nodelet::Nodelet {
 private:
  void onInit() override;
  void make_tracker();
  void take_pose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  void take_integrity(const PoseIntegrityConstPtr& message);
  void take_load(const LoadStateConstPtr& message);
  void tell(const PalletTracker::Changes& changes);
  void tell_state();
  void report(Health::Status& status);

  std::string fork_frame_;
  double state_rate_hz_ = 2;
  std::unique_ptr<StageEdge> edge_;
  std::unique_ptr<PalletTracker> tracker_;
  std::unique_ptr<PalletFile> file_;
  std::unique_ptr<PalletServices> services_;
  StreamWatch* pose_watch_ = nullptr;
  StreamWatch* load_watch_ = nullptr;
  bool fork_known_ = false;
  Stamp newest_, told_;  ///< of pose and load samples; of the last state that was told
  ros::Publisher events_, state_;
  ros::Subscriber pose_, integrity_, load_;
};

}  // namespace lodestar
