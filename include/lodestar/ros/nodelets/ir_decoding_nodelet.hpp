#pragma once

#include <nodelet/nodelet.h>

#include <memory>

#include "lodestar/GetBeacons.h"
#include "lodestar/IrFrame.h"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/line/time_jump.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// `ir/frames` in, `beacons/announcements` out: the frame decoder and the beacon table as a nodelet
/// (docs/nodes/ir_decoding.md).
class IrDecodingNodelet : public nodelet::Nodelet {
 private:
  void onInit() override;
  void take_frame(const IrFrameConstPtr& message);
  bool get_beacons(GetBeacons::Request& request, GetBeacons::Response& response);
  void report(Health::Status& status);

  std::string map_frame_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<IrFrameDecoder> decoder_;
  std::unique_ptr<BeaconTable> table_;
  TimeJump jump_;
  StreamWatch* frames_watch_ = nullptr;
  StreamWatch* announcements_watch_ = nullptr;
  ros::Publisher announcements_, conflicts_;
  ros::Subscriber frames_;
  ros::ServiceServer get_beacons_;
};

}  // namespace lodestar
