#include "lodestar/ros/nodelets/simulation_nodelet.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

#include "lodestar/IrFrame.h"
#include "lodestar/ros/convert/camera_info.hpp"
#include "lodestar/ros/convert/image.hpp"
#include "lodestar/ros/convert/imu.hpp"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "lodestar/ros/convert/ir_samples.hpp"
#include "lodestar/ros/convert/odometry.hpp"
#include "lodestar/ros/convert/pallet.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"

namespace lodestar {

namespace {
constexpr double kStep_s = 0.002;
constexpr Duration kClockStep = std::chrono::milliseconds(5);
constexpr double kLongestStep_s = 0.05;  // beyond it simulated time slows down rather than bursts
const char* const kBase = "base_link";
const char* const kOdom = "odom";
const char* const kCamera = "camera_optical_frame";
const char* const kImu = "imu_link";
const char* const kIr = "ir_array";
const char* const kFork = "fork";
}  // namespace

void SimulationNodelet::onInit() {
  ParamReader reader(getPrivateNodeHandle());
  const std::string path = reader.path("scenario");
  speed_ = reader.number("speed", 1.0, {0.01, 100});
  publish_clock_ = reader.flag("publish_clock", ros::Time::isSimTime());
  const StaleLimits limits = read_stale_limits(reader);
  if (!path.empty()) {
    auto scenario = sim::load_scenario(path);
    if (scenario) scenario_ = std::move(scenario).value();
    if (!scenario) reader.add(scenario.error());
  }
  refuse_faults(reader.faults());

  if (!publish_clock_) scenario_.start = stamp_from(ros::Time::now());
  map_frame_ = scenario_.site.frame_id;
  simulation_ = std::make_unique<sim::Simulation>(scenario_);
  health_ = std::make_unique<Health>(getNodeHandle(), getPrivateNodeHandle(), "simulation", scenario_.name, limits);
  image_watch_ = &health_->watch("image", scenario_.has_camera ? Need::kRequired : Need::kOptional);
  health_->add_report([this](Health::Status& status) { report(status); });
  advertise();
  publish_mounts();
  clock_ = scenario_.start;
  next_ = simulation_->next();
  stepped_ = ros::WallTime::now();
  timer_ = getNodeHandle().createWallTimer(ros::WallDuration(kStep_s), [this](const ros::WallTimerEvent&) { step(); });
}

void SimulationNodelet::advertise() {
  ros::NodeHandle& nh = getNodeHandle();
  image_ = nh.advertise<sensor_msgs::Image>("camera/image_raw", 10);
  camera_info_ = nh.advertise<sensor_msgs::CameraInfo>("camera/camera_info", 10);
  imu_ = nh.advertise<sensor_msgs::Imu>("imu/data", 200);
  odometry_ = nh.advertise<nav_msgs::Odometry>("odom", 50);
  ir_ = nh.advertise<IrFrame>("ir/frames", 50);
  if (scenario_.ir_samples) ir_samples_ = nh.advertise<IrSamples>("ir/samples", 50);
  if (scenario_.fixes) fix_ = nh.advertise<geometry_msgs::PoseWithCovarianceStamped>("beacons/fix", 50);
  if (scenario_.loads) {
    load_ = nh.advertise<LoadState>("load", 50);
    pallet_truth_ = nh.advertise<PalletArray>("ground_truth/pallets", 2, true);
  }
  truth_ = nh.advertise<geometry_msgs::PoseStamped>("ground_truth/pose", 100);
  camera_truth_ = nh.advertise<geometry_msgs::PoseStamped>("ground_truth/camera_pose", 100);
  if (publish_clock_) clock_publisher_ = nh.advertise<rosgraph_msgs::Clock>("/clock", 1);
  broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>();
}

void SimulationNodelet::publish_mounts() {
  mounts_ = std::make_unique<tf2_ros::StaticTransformBroadcaster>();
  const Stamp stamp = scenario_.start;
  mounts_->sendTransform(
      std::vector<geometry_msgs::TransformStamped>{transform_message(scenario_.T_base_camera, stamp, kBase, kCamera),
                                                   transform_message(scenario_.imu.T_base_imu, stamp, kBase, kImu),
                                                   transform_message(scenario_.ir.T_base_ir, stamp, kBase, kIr),
                                                   transform_message(scenario_.T_base_fork, stamp, kBase, kFork)});
}

void SimulationNodelet::step() {
  const ros::WallTime now = ros::WallTime::now();
  const double elapsed_s = (now - stepped_).toSec();
  const double step_s = std::min(elapsed_s, kLongestStep_s);
  behind_s_ += elapsed_s - step_s;
  stepped_ = now;
  clock_ += from_seconds(step_s * speed_);
  if (publish_clock_ && (clock_ - told_clock_) >= kClockStep) {
    told_clock_ = clock_;
    rosgraph_msgs::Clock clock;
    clock.clock = ros_time(clock_);
    clock_publisher_.publish(clock);
  }
  for (; next_ && next_->received <= clock_; next_ = simulation_->next()) publish(*next_);
}

void SimulationNodelet::publish(const sim::Event& event) {
  std::visit([this](const auto& sample) { publish(sample); }, event.data);
}

void SimulationNodelet::publish(const Image& image) {
  camera_info_.publish(camera_info_message(scenario_.camera.intrinsics, image.stamp, kCamera));
  image_.publish(boost::make_shared<const sensor_msgs::Image>(image_message(image, kCamera)));
  image_watch_->tick();
}

// The samples are in the sensor's own axes already.
void SimulationNodelet::publish(const ImuSample& sample) {
  imu_.publish(imu_message(sample, Eigen::Matrix3d::Identity(), kImu));
}

void SimulationNodelet::publish(const OdometrySample& sample) {
  odometry_.publish(odometry_message(sample, kOdom, kBase));
  const RigidTransform T_odom_base =
      Eigen::Translation3d(sample.position_odom_m) * Eigen::AngleAxisd(sample.yaw_odom_rad, Eigen::Vector3d::UnitZ());
  broadcaster_->sendTransform(transform_message(T_odom_base, sample.stamp, kOdom, kBase));
}

void SimulationNodelet::publish(const RawIrFrame& frame) { ir_.publish(ir_frame_message(frame, kIr)); }

void SimulationNodelet::publish(const IrSampleBlock& samples) { ir_samples_.publish(ir_samples_message(samples, kIr)); }

void SimulationNodelet::publish(const Fix& fix) { fix_.publish(pose_estimate_message(fix, map_frame_)); }

void SimulationNodelet::publish(const LoadSample& sample) { load_.publish(load_message(sample, kFork)); }

void SimulationNodelet::publish(const sim::TruePallets& truth) {
  pallet_truth_.publish(pallet_array_message(truth.pallets, truth.stamp, map_frame_));
}

void SimulationNodelet::publish(const sim::TrueBase& truth) {
  truth_.publish(pose_message(StampedPose{truth.stamp, truth.T_map_base}, map_frame_));
}

void SimulationNodelet::publish(const sim::TrueCamera& truth) {
  camera_truth_.publish(pose_message(StampedPose{truth.stamp, truth.T_map_camera}, map_frame_));
}

void SimulationNodelet::report(Health::Status& status) {
  status.add("scenario", scenario_.name);
  status.addf("simulated_s", "%.1f", seconds(clock_ - scenario_.start));
  status.addf("fallen behind real time_s", "%.2f", behind_s_);
  if (!next_) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "the scenario is over");
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::SimulationNodelet, nodelet::Nodelet)
