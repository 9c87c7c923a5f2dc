#pragma once

#include <dynamic_reconfigure/server.h>
#include <image_transport/image_transport.h>
#include <nodelet/nodelet.h>

#include <deque>
#include <memory>
#include <optional>
#include <variant>

#include "lodestar/BeaconDetectionConfig.h"
#include "lodestar/line/frame_rate.hpp"
#include "lodestar/line/localization_line.hpp"
#include "lodestar/ros/nodelets/arrival_input.hpp"
#include "lodestar/ros/nodelets/beacon_input.hpp"
#include "lodestar/ros/nodelets/camera_input.hpp"
#include "lodestar/ros/nodelets/estimate_input.hpp"
#include "lodestar/ros/nodelets/motion_input.hpp"
#include "lodestar/ros/nodelets/stage_edge.hpp"

namespace lodestar {

/// `camera/image_raw` in, `beacons/sightings` out: DetectionStage as a nodelet (docs/nodes/beacon_detection.md).
class BeaconDetectionNodelet : public nodelet::Nodelet {
 private:
  using Motion = std::variant<ImuSample, OdometrySample>;

  void onInit() override;
  void start_inputs(ros::NodeHandle& nh);
  void take_motion(const Motion& sample);
  void add_motion(const Motion& sample);
  void tune(const BeaconDetectionConfig& config);
  void make_stage();
  void take_image(const sensor_msgs::ImageConstPtr& message);
  void take_rate(double rate_hz);
  void process(const Image& image);
  void report(Health::Status& status);
  void reset();

  std::unique_ptr<StageEdge> edge_;
  std::unique_ptr<DetectionStage> stage_;  ///< none until the frame rate is known
  std::unique_ptr<CameraInput> camera_;
  std::unique_ptr<ArrivalInput> arrivals_;
  std::unique_ptr<BeaconInput> beacons_;
  std::unique_ptr<MotionInput> motion_;
  std::unique_ptr<EstimateInput> estimate_input_;
  std::unique_ptr<dynamic_reconfigure::Server<BeaconDetectionConfig>> tuning_;
  BeaconDetectionConfig config_;
  StreamWatch* image_watch_ = nullptr;
  StreamWatch* sightings_watch_ = nullptr;
  int camera_revision_ = 0;
  FrameRateWatch rate_;
  Faults tone_faults_;  ///< of the measured rate: then there is no stage
  std::deque<Image> early_images_;   ///< wait for the frame rate
  std::deque<Motion> early_motion_;  ///< likewise
  Duration heard_for_{};
  std::size_t last_sightings_ = 0, last_named_ = 0;
  std::uint64_t contradicted_ = 0;  ///< names, at the last report
  ros::Publisher sightings_;
  image_transport::Subscriber images_;
};

}  // namespace lodestar
