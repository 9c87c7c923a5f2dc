#include "lodestar/ros/nodelets/camera_capture_nodelet.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <pluginlib/class_list_macros.hpp>

#include "lodestar/ros/nodelets/sim_frame_source.hpp"

namespace lodestar {
namespace {

constexpr std::chrono::milliseconds kRetry(200);
constexpr double kWatch_s = 0.1;

std::optional<double> number_if_given(ParamReader& reader, const std::string& key, const Range& range = {0}) {
  const double value = reader.number(key, std::numeric_limits<double>::quiet_NaN(), range);
  return std::isnan(value) ? std::nullopt : std::optional<double>(value);
}

std::optional<int> size_if_given(ParamReader& reader, const std::string& key) {
  const int value = reader.integer(key, 0, {1, 65535});
  return value == 0 ? std::nullopt : std::optional<int>(value);
}

CameraSettings read_settings(ParamReader& reader) {
  CameraSettings settings;
  settings.exposure_s = number_if_given(reader, "exposure_s");
  settings.gain = number_if_given(reader, "gain", {});  // dB may be negative
  settings.rate_hz = number_if_given(reader, "rate_hz");
  settings.width_px = size_if_given(reader, "width_px");
  settings.height_px = size_if_given(reader, "height_px");
  settings.pixel_format = reader.text("pixel_format", "");
  settings.trigger = reader.text("trigger", "");
  return settings;
}

}  // namespace

void CameraCaptureNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ParamReader reader(getPrivateNodeHandle());
  const std::string uri = reader.text("uri", "");
  if (uri.empty()) reader.add({{"uri", 0, "is missing: gige:, usb3:, v4l2:/dev/video0, file:PATH or sim:SCENARIO"}});
  const CameraSettings settings = read_settings(reader);
  const double transfer_s = reader.number("transfer_s", 0, {0, 1});
  frame_id_ = reader.text("frame_id", "camera_optical_frame");
  const std::string name = reader.text("camera_name", "camera");
  const std::string url = reader.text("camera_info_url", "");
  const StaleLimits limits = read_stale_limits(reader);
  if (ros::Time::isSimTime()) reader.add({{"/use_sim_time", 0, "is set: a camera lives in the host's time"}});
  refuse_faults(reader.faults());

  capture_ = std::make_unique<Capture>([uri] { return open_camera(uri); }, settings,
                                       [this](std::size_t bytes) { return pool_.take(bytes); }, transfer_s);
  open_or_refuse();
  health_ = std::make_unique<Health>(nh, getPrivateNodeHandle(), "camera capture", uri, limits);
  images_watch_ = &health_->watch("images", settings.trigger.empty() ? Need::kRequired : Need::kOptional);
  health_->add_report([this](Health::Status& status) { report(status); });
  const ros::NodeHandle camera_nh(nh, "camera");
  calibration_ = std::make_unique<Calibration>(camera_nh, name, url);
  images_ = image_transport::ImageTransport(camera_nh).advertiseCamera("image_raw", 10);
  timer_ = nh.createWallTimer(ros::WallDuration(kWatch_s), [this](const ros::WallTimerEvent&) { watch(); });
  thread_ = std::thread([this] { run(); });
}

CameraCaptureNodelet::~CameraCaptureNodelet() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

// Settings beyond the camera's limits are for a person to mend; a camera that is not there yet may come.
void CameraCaptureNodelet::open_or_refuse() {
  try {
    capture_->open();
  } catch (const CameraRefusal& refusal) {
    refuse_faults(refusal.faults);
  } catch (const CameraError& error) {
    ROS_WARN_STREAM(error.what() << "; trying again until it is there");
  }
  report_ = capture_->report();
}

void CameraCaptureNodelet::run() {
  while (!stop_) {
    if (host_clock_.was_set()) capture_->host_clock_set();
    const auto frame = capture_->next();
    CaptureReport report = capture_->report();
    const bool lost = report.state == CaptureState::kClosed || report.state == CaptureState::kOver;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      report_ = std::move(report);
    }
    if (frame) publish(*frame);
    if (lost) std::this_thread::sleep_for(kRetry);
  }
}

void CameraCaptureNodelet::publish(const CapturedFrame& frame) {
  const sensor_msgs::ImagePtr image = ImagePool::message(frame, frame_id_);
  images_.publish(image, calibration_->info(*image, capture_->intrinsics()));
}

CaptureReport CameraCaptureNodelet::shared_report() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return report_;
}

// A camera that is lost is told at once, not with the next second's diagnostics.
void CameraCaptureNodelet::watch() {
  const CaptureReport now = shared_report();
  for (; ticked_ < now.frames; ++ticked_) images_watch_->tick();
  const bool lost = now.state != CaptureState::kRunning;
  const bool was_lost = told_ != CaptureState::kRunning;
  told_ = now.state;
  if (lost == was_lost) return;
  if (lost) ROS_ERROR_STREAM("camera lost: " << now.fault);
  if (!lost) ROS_INFO_STREAM("camera back: " << now.camera);
  health_->report_now();
}

void CameraCaptureNodelet::report(Health::Status& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const CaptureReport now = shared_report();
  status.add("camera", now.camera);
  status.add("stamps", now.stamping);
  status.add("pixels", now.in_place ? "written into the message by the driver" : "copied into the message");
  status.addf("frame rate_hz", "%.3f", now.rate_hz);
  status.addf("frame jitter_ms", "%.3f", now.jitter_s * 1e3);
  status.addf("clock drift_ppm", "%.1f", now.drift * 1e6);
  status.add("clock restarts", now.clock_restarts);
  status.add("frames dropped by id", now.dropped);
  status.add("reconnects", now.reconnects);
  status.add("last fault", now.fault);
  report_drops(now.missed, status);
  if (now.state == CaptureState::kOver) status.mergeSummary(DiagnosticStatus::WARN, now.fault);
  if (now.state != CaptureState::kOver && now.state != CaptureState::kRunning)
    status.mergeSummary(DiagnosticStatus::ERROR, "camera lost: " + now.fault);
  const auto uncalibrated = calibration_ ? calibration_->fault() : std::nullopt;
  status.add("calibration", !uncalibrated ? "no image yet" : uncalibrated->empty() ? "in force" : *uncalibrated);
  if (uncalibrated && !uncalibrated->empty()) status.mergeSummary(DiagnosticStatus::WARN, *uncalibrated);
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::CameraCaptureNodelet, nodelet::Nodelet)
