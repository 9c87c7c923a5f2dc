#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/sensing/camera/camera_settings.hpp"

namespace lodestar {

/// The camera is not there, went away or does not do what it is asked. Trying again later may help.
struct CameraError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// No such camera can ever run so: an address that means nothing, settings beyond its limits.
struct CameraRefusal : std::runtime_error {
  explicit CameraRefusal(Faults all) : std::runtime_error(describe(all)), faults(std::move(all)) {}
  Faults faults;
};

/// Memory for one frame, written once and then read for as long as anyone holds the owner.
struct FrameMemory {
  std::uint8_t* data = nullptr;
  std::shared_ptr<void> owner;
};

/// Gives memory of so many bytes. Drivers that can write there directly do, so that nobody copies the frame.
using FrameAllocator = std::function<FrameMemory(std::size_t bytes)>;

/// One instant by the device's counter and by the host's clock.
struct ClockPair {
  std::uint64_t ticks = 0;
  Stamp host;
};

/// A frame as the device delivers it: one channel, host byte order.
struct DeviceFrame {
  int width_px = 0, height_px = 0;
  int bits = 8;                  ///< 8 or 16
  std::size_t stride_bytes = 0;  ///< from one row to the next
  FrameMemory memory;
  std::uint64_t id = 0;     ///< of the device's count of frames
  std::uint64_t ticks = 0;  ///< the device's counter at SourceClock::stamped
  ClockPair heard;  ///< what relates the two clocks: this frame's own ticks and its arrival, or both read at once
};

/// What a source's counters mean.
struct SourceClock {
  enum class Stamped {
    kExposureStart,
    kExposureMiddle,
    kReceived  ///< the last pixel is read out and here: behind the end of the exposure
  };
  Stamped stamped = Stamped::kExposureStart;
  /// `heard` is a frame's arrival, which is the end of its exposure at the earliest. Else both clocks were read at
  /// once.
  bool heard_at_arrival = true;
  double tick_hz = 1e9;
  int counter_bits = 64;
  int frame_id_bits = 64;  ///< ids wrap around
};

/// What runs, once started.
struct SourceInfo {
  std::string name;  ///< URI, maker, model, serial number
  SourceClock clock;
  double exposure_s = 0;                       ///< as the camera says; 0: unknown
  double period_s = 0;                         ///< from frame to frame, as the source says; 0: unknown
  std::optional<CameraIntrinsics> intrinsics;  ///< where the source itself knows its lens
  bool triggered = false;                      ///< frames come when someone else wants them: silence is no fault
  bool in_place = false;  ///< the driver writes into the allocator's memory; else every frame is copied there
};

/// Why there was no frame.
enum class NoFrame {
  kTimeout,     ///< nothing came in time
  kIncomplete,  ///< packets were lost
  kFormat,      ///< not an image, or of a format that was not asked for
  kEnd,         ///< a recording is over
  kCount
};
const char* name(NoFrame reason);

/// A camera, or what plays one. Opened by open_source(). Drivers block and read the host's clock; nothing else in
/// `sensing` does. One thread at a time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Sets the camera up and lets it run. Nothing is automatic afterwards.
  /// @throws CameraRefusal settings beyond the limits; CameraError
  virtual SourceInfo start(const CameraSettings& settings, const FrameAllocator& allocate) = 0;

  /// The next frame. @throws CameraError the device is gone
  virtual Result<DeviceFrame, NoFrame> next(Duration timeout) = 0;
};

}  // namespace lodestar
