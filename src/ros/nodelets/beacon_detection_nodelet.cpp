#include "lodestar/ros/nodelets/beacon_detection_nodelet.hpp"

#include <pluginlib/class_list_macros.hpp>

#include "lodestar/ros/convert/image.hpp"
#include "lodestar/ros/convert/sightings.hpp"
#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {

namespace {
constexpr int kImageQueue = 10;
constexpr std::size_t kEarlyMotion = 1000;
}  // namespace

void BeaconDetectionNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ParamReader reader(getPrivateNodeHandle());
  config_ = BeaconDetectionConfig::__getDefault__();
  const auto lowest = BeaconDetectionConfig::__getMin__();
  const auto highest = BeaconDetectionConfig::__getMax__();
  reader.number("false_alarms_per_hour", config_.false_alarms_per_hour,
                {lowest.false_alarms_per_hour, highest.false_alarms_per_hour});
  reader.number("code_margin_db", config_.code_margin_db, {lowest.code_margin_db, highest.code_margin_db});
  edge_ = std::make_unique<StageEdge>(nh, getPrivateNodeHandle(), reader, "beacon detection", [this] { reset(); });
  rate_ = FrameRateWatch(edge_->vehicle().camera_rate_hz);

  Health& health = edge_->health();
  image_watch_ = &health.watch("image", Need::kRequired);
  sightings_watch_ = &health.watch("sightings", Need::kRequired);
  health.add_report([this](Health::Status& status) { report(status); });
  sightings_ = nh.advertise<BeaconSightingArray>("beacons/sightings", 10);
  tuning_ = std::make_unique<dynamic_reconfigure::Server<BeaconDetectionConfig>>(getPrivateNodeHandle());
  tuning_->setCallback([this](BeaconDetectionConfig& config, std::uint32_t) { tune(config); });
  start_inputs(nh);
}

void BeaconDetectionNodelet::start_inputs(ros::NodeHandle& nh) {
  camera_ = std::make_unique<CameraInput>(nh, edge_->mounts(), edge_->health(), edge_->vehicle().T_base_camera);
  arrivals_ =
      std::make_unique<ArrivalInput>(nh, edge_->vehicle(), edge_->site().link, edge_->mounts(), edge_->health());
  beacons_ = std::make_unique<BeaconInput>(
      nh, edge_->site(), edge_->health(), [](const auto&) {},
      [this](const Announcement& a) { arrivals_->arrivals().add(a); });
  motion_ = std::make_unique<MotionInput>(
      nh, *edge_, [this](const ImuSample& sample, const RigidTransform&) { take_motion(sample); },
      [this](const OdometrySample& sample) { take_motion(sample); });
  estimate_input_ =
      std::make_unique<EstimateInput>(nh, edge_->health(), edge_->map_frame(), [this](const StateEstimate& estimate) {
        if (stage_) stage_->set_estimate(estimate);
      });
  if (rate_.known_hz()) make_stage();
  image_transport::ImageTransport transport(nh);
  images_ = transport.subscribe("camera/image_raw", kImageQueue, &BeaconDetectionNodelet::take_image, this,
                                image_transport::TransportHints("raw", {}, getPrivateNodeHandle()));
}

void BeaconDetectionNodelet::take_motion(const Motion& sample) {
  if (const auto* odometry = std::get_if<OdometrySample>(&sample)) arrivals_->arrivals().add_odometry(*odometry);
  if (stage_) return add_motion(sample);
  early_motion_.push_back(sample);
  if (early_motion_.size() > kEarlyMotion) early_motion_.pop_front();
}

void BeaconDetectionNodelet::add_motion(const Motion& sample) {
  if (const auto* imu = std::get_if<ImuSample>(&sample)) stage_->add_imu(*imu);
  if (const auto* odometry = std::get_if<OdometrySample>(&sample)) stage_->add_odometry(*odometry);
}

void BeaconDetectionNodelet::tune(const BeaconDetectionConfig& config) {
  config_ = config;
  if (stage_) make_stage();
}

void BeaconDetectionNodelet::make_stage() {
  LineParams params = line_params(edge_->site(), edge_->vehicle(), *rate_.known_hz());
  params.detector.false_alarms_per_hour = config_.false_alarms_per_hour;
  params.detector.reader.code.margin_db = config_.code_margin_db;
  heard_for_ = params.heard_for;
  stage_ = std::make_unique<DetectionStage>(params.detector, params.namer, params.solver.floor_z_m);
  camera_revision_ = 0;
  contradicted_ = 0;
}

void BeaconDetectionNodelet::take_image(const sensor_msgs::ImageConstPtr& message) {
  image_watch_->tick();
  const auto image = image_from(message, edge_->vehicle().camera_time_offset_s);
  if (!image) return edge_->health().drop(image.error());
  if (!edge_->admit(message->header.stamp)) return;
  if (const auto rate_hz = rate_.add(image->stamp)) take_rate(*rate_hz);
  if (stage_) return process(*image);
  if (!tone_faults_.empty()) return edge_->health().drop(EdgeDrop::kTones);
  early_images_.push_back(*image);
  if (early_images_.size() > FrameRateEstimate::kFrames) early_images_.pop_front();
}

/// The first rate that is known, or another one under a running detector.
void BeaconDetectionNodelet::take_rate(double rate_hz) {
  NODELET_INFO("the camera sends %.2f frames a second", rate_hz);
  const Vehicle& vehicle = edge_->vehicle();
  tone_faults_ = check_tones(edge_->site(), {rate_hz, vehicle.mains_hz, vehicle.window_frames}, edge_->site_path());
  if (!tone_faults_.empty()) {
    NODELET_ERROR_STREAM("no beacon is looked for:\n" << describe(tone_faults_));
    stage_.reset();
  } else {
    make_stage();
    for (const Motion& early : early_motion_) add_motion(early);
    for (const Image& early : early_images_) process(early);
    early_motion_.clear();
  }
  early_images_.clear();
}

void BeaconDetectionNodelet::process(const Image& image) {
  const CameraMount* camera = camera_->get();
  if (camera == nullptr) return;
  if (camera_->revision() != camera_revision_) stage_->set_camera(*camera);
  camera_revision_ = camera_->revision();
  const BeaconTable& table = beacons_->table();
  stage_->set_beacons(table.beacons(), table.heard(image.stamp, heard_for_), arrivals_->arrivals().recent(image.stamp));

  const auto sightings = stage_->process(image);
  if (!sightings) return;
  sightings_.publish(sightings_message(*sightings, edge_->site().tone_table_hz, camera_->frame()));
  sightings_watch_->tick();
  last_sightings_ = sightings->sightings.size();
  last_named_ = 0;
  for (const Sighting& sighting : sightings->sightings) last_named_ += sighting.beacon ? 1 : 0;
}

void BeaconDetectionNodelet::report(Health::Status& status) {
  status.addf("frame_rate_hz", "%.2f", rate_.known_hz().value_or(0));
  status.add("sightings in the last window", last_sightings_);
  status.add("named in the last window", last_named_);
  if (!tone_faults_.empty()) status.mergeSummary(Health::Status::ERROR, describe(tone_faults_));
  if (!stage_) return;
  report_drops(stage_->drops(), status);
  status.add("names contradicted by their direction", stage_->contradicted());
  if (stage_->contradicted() > contradicted_)
    status.mergeSummary(Health::Status::WARN,
                        "names withheld: announcements come from elsewhere than their beacons are seen; mirror images, "
                        "or somebody outshines the beacons");
  contradicted_ = stage_->contradicted();
}

void BeaconDetectionNodelet::reset() {
  if (stage_) stage_->reset();
  beacons_->reset_time();
  arrivals_->arrivals().reset();
  early_images_.clear();
  early_motion_.clear();
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::BeaconDetectionNodelet, nodelet::Nodelet)
