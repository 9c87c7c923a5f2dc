#pragma once

#include <image_transport/image_transport.h>
#include <nodelet/nodelet.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "lodestar/ros/nodelets/calibration.hpp"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/ros/nodelets/host_clock.hpp"
#include "lodestar/ros/nodelets/image_pool.hpp"
#include "lodestar/sensing/camera/capture.hpp"

namespace lodestar {

/// A camera in, `camera/image_raw` and `camera/camera_info` out (docs/nodes/camera_capture.md). Drivers block, so the
/// capture has a thread of its own, which publishes; all else runs on the nodelet's queue.
class CameraCaptureNodelet : public nodelet::Nodelet {
 public:
  ~CameraCaptureNodelet() override;

 private:
  void onInit() override;
  void open_or_refuse();
  void run();
  void publish(const CapturedFrame& frame);
  void watch();
  void report(Health::Status& status);
  CaptureReport shared_report();

  std::string frame_id_;
  ImagePool pool_;
  std::unique_ptr<Capture> capture_;  ///< of the thread, once it runs
  HostClock host_clock_;              ///< likewise
  std::unique_ptr<Calibration> calibration_;
  std::unique_ptr<Health> health_;
  StreamWatch* images_watch_ = nullptr;
  image_transport::CameraPublisher images_;
  ros::WallTimer timer_;
  CaptureState told_ = CaptureState::kRunning;
  std::uint64_t ticked_ = 0;

  std::mutex mutex_;
  CaptureReport report_;  ///< guarded by mutex_
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace lodestar
