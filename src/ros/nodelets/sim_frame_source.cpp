#include "lodestar/ros/nodelets/sim_frame_source.hpp"

#include <cstring>
#include <optional>
#include <thread>

#include "lodestar/sensing/camera/open_source.hpp"
#include "lodestar/sim/simulation.hpp"

namespace lodestar {
namespace {

Stamp host_now() {
  return Stamp(std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()));
}

sim::Scenario load(const std::string& path) {
  auto scenario = sim::load_scenario(path);
  if (!scenario) throw CameraRefusal(scenario.error());
  if (!scenario->has_camera) throw CameraRefusal({{path, 0, "the scenario has no camera"}});
  return std::move(scenario).value();
}

class SimFrameSource : public FrameSource {
 public:
  explicit SimFrameSource(const std::string& path) : path_(path), scenario_(load(path)) {}

  SourceInfo start(const CameraSettings& settings, const FrameAllocator& allocate) override {
    const Faults faults = check_settings(settings, {}, "sim:" + path_);
    if (!faults.empty()) throw CameraRefusal(faults);
    allocate_ = allocate;
    scenario_.start = host_now();
    simulation_ = std::make_unique<sim::Simulation>(scenario_);
    SourceInfo info;
    info.name = "sim:" + path_;
    info.clock.stamped = SourceClock::Stamped::kExposureMiddle;
    info.clock.heard_at_arrival = false;
    info.exposure_s = scenario_.camera.exposure_s;
    info.period_s = 1 / scenario_.camera.rate_hz;
    info.intrinsics = scenario_.camera.intrinsics;
    return info;
  }

  Result<DeviceFrame, NoFrame> next(Duration timeout) override {
    while (!due_) {
      due_ = simulation_->next();
      if (!due_) return NoFrame::kEnd;
      if (!std::holds_alternative<Image>(due_->data)) due_.reset();
    }
    const Duration wait = due_->received - host_now();
    std::this_thread::sleep_for(std::min(wait, timeout));
    if (wait > timeout) return NoFrame::kTimeout;
    const DeviceFrame frame = frame_of(std::get<Image>(due_->data));
    due_.reset();
    return frame;
  }

 private:
  DeviceFrame frame_of(const Image& image) {
    DeviceFrame frame;
    frame.width_px = image.width_px;
    frame.height_px = image.height_px;
    frame.bits = image.bits;
    frame.stride_bytes = image.stride_bytes;
    const std::size_t bytes = image.stride_bytes * static_cast<std::size_t>(image.height_px);
    frame.memory = allocate_(bytes);
    std::memcpy(frame.memory.data, image.data, bytes);
    frame.id = id_++;
    frame.ticks = static_cast<std::uint64_t>(image.stamp.time_since_epoch().count());
    frame.heard = {frame.ticks, image.stamp};
    return frame;
  }

  std::string path_;
  sim::Scenario scenario_;
  FrameAllocator allocate_;
  std::unique_ptr<sim::Simulation> simulation_;
  std::optional<sim::Event> due_;
  std::uint64_t id_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_camera(const std::string& uri) {
  const std::string scheme = "sim:";
  if (uri.compare(0, scheme.size(), scheme) != 0) return open_source(uri);
  return std::make_unique<SimFrameSource>(uri.substr(scheme.size()));
}

}  // namespace lodestar
