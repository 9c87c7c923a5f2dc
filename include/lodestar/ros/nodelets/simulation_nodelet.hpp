#pragma once

#include <nodelet/nodelet.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <memory>
#include <optional>

#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/sim/simulation.hpp"

namespace lodestar {

/// A simulated truck, in real time: what the sensors of a scenario say, on the topics that a vehicle uses
/// (docs/nodes/simulation.md).
class SimulationNodelet : public nodelet::Nodelet {
 private:
  void onInit() override;
  void advertise();
  void publish_mounts();
  void step();
  void publish(const sim::Event& event);
  void publish(const Image& image);
  void publish(const ImuSample& sample);
  void publish(const OdometrySample& sample);
  void publish(const RawIrFrame& frame);
  void publish(const IrSampleBlock& samples);
  void publish(const Fix& fix);
  void publish(const LoadSample& sample);
  void publish(const sim::TruePallets& truth);
  void publish(const sim::TrueBase& truth);
  void publish(const sim::TrueCamera& truth);
  void report(Health::Status& status);

  double speed_ = 1;
  bool publish_clock_ = false;
  std::string map_frame_;
  sim::Scenario scenario_;
  std::unique_ptr<Health> health_;
  StreamWatch* image_watch_ = nullptr;
  std::unique_ptr<sim::Simulation> simulation_;
  std::optional<sim::Event> next_;
  ros::WallTime stepped_;
  Stamp clock_, told_clock_;  ///< simulated time, and what of it /clock has said
  double behind_s_ = 0;       ///< real time that the machine could not keep up with
  std::unique_ptr<tf2_ros::StaticTransformBroadcaster> mounts_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> broadcaster_;
  ros::Publisher image_, camera_info_, imu_, odometry_, ir_, ir_samples_, fix_, load_, truth_, camera_truth_,
      pallet_truth_, clock_publisher_;
  ros::WallTimer timer_;
};

}  // namespace lodestar
