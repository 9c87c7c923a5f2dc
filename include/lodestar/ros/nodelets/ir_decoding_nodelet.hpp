#pragma once

#include <nodelet/nodelet.h>

#include <memory>
#include <optional>

#include "lodestar/ConfirmBeacon.h"
#include "lodestar/GetBeacons.h"
#include "lodestar/IrFrame.h"
#include "lodestar/IrSamples.h"
#include "lodestar/line/time_jump.hpp"
#include "lodestar/ros/nodelets/arrival_input.hpp"
#include "lodestar/ros/nodelets/confirmations.hpp"
#include "lodestar/ros/nodelets/estimate_input.hpp"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/ros/nodelets/stranger_watch.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"
#include "lodestar/sensing/irlink/ir_demodulator.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// `ir/frames` or `ir/samples` in, `beacons/announcements` out: demodulator, frame decoder and beacon table as a
/// nodelet (docs/nodes/ir_decoding.md).
class IrDecodingNodelet : public nodelet::Nodelet {
 private:
  void onInit() override;
  void start_inputs(ros::NodeHandle& nh);
  void take_frame(const IrFrameConstPtr& message);
  void take_samples(const IrSamplesConstPtr& message);
  void decode(const RawIrFrame& frame);
  bool plausible(const Announcement& announcement);
  void watch_clock();
  bool get_beacons(GetBeacons::Request& request, GetBeacons::Response& response);
  bool confirm_beacon(ConfirmBeacon::Request& request, ConfirmBeacon::Response& response);
  void report(Health::Status& status);

  Site site_;
  Vehicle vehicle_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<IrDemodulator> demodulator_;
  std::unique_ptr<IrFrameDecoder> decoder_;
  std::unique_ptr<BeaconTable> table_;
  std::unique_ptr<MountLookup> mounts_;
  std::unique_ptr<ArrivalInput> arrivals_;
  std::unique_ptr<EstimateInput> estimate_input_;
  std::optional<StateEstimate> estimate_;  ///< of the filter
  StrangerWatch strangers_;
  TimeJump jump_;
  StreamWatch* frames_watch_ = nullptr;
  StreamWatch* announcements_watch_ = nullptr;
  std::unique_ptr<Confirmations> confirmations_;
  ros::Publisher announcements_, conflicts_, doubtful_;
  ros::Subscriber frames_, samples_;
  ros::ServiceServer get_beacons_, confirm_beacon_;
};

}  // namespace lodestar
