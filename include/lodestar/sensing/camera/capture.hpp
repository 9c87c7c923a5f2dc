#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/sensing/camera/frame_counter.hpp"
#include "lodestar/sensing/camera/frame_source.hpp"
#include "lodestar/sensing/camera/frame_stamper.hpp"

namespace lodestar {

/// A frame with the middle of its exposure.
struct CapturedFrame {
  Stamp stamp;
  DeviceFrame frame;
};

enum class CaptureState {
  kClosed,   ///< the camera is not there, or refused the settings; tried again
  kRunning,  ///< frames come, or their time has not passed yet
  kSilent,   ///< no frame came when it was due; opened anew until one comes
  kSpoilt,   ///< frames come, but none for kSilence that can be used
  kOver,     ///< a recording came to its end
};

/// How a capture goes; counts are those since its beginning.
struct CaptureReport {
  CaptureState state = CaptureState::kClosed;
  std::string fault;      ///< why no frame comes; empty while frames come
  std::string camera;     ///< that is or was open
  std::string stamping;   ///< how its frames are stamped
  bool in_place = false;  ///< as SourceInfo says
  std::uint64_t frames = 0, dropped = 0, reconnects = 0, clock_restarts = 0;
  double rate_hz = 0, jitter_s = 0, drift = 0;  ///< of the last second or so
  DropCounts<NoFrame> missed;
};

/// A camera that is taken up again whenever it is lost. No thread and no clock of its own: next() blocks for kPatience
/// at most while the camera is healthy, and as long as its driver takes to open or close it.
class Capture {
 public:
  static constexpr Duration kPatience = std::chrono::milliseconds(100);
  static constexpr Duration kSilence = std::chrono::milliseconds(500);  ///< past the time that a frame was due
  static constexpr Duration kMostSilence = std::chrono::seconds(8);     ///< where nobody says when it is due

  using Open = std::function<std::unique_ptr<FrameSource>()>;
  Capture(Open open, const CameraSettings& settings, FrameAllocator allocate, double transfer_s);

  /// Opens the camera. @throws CameraRefusal, CameraError
  void open();

  /// The next frame. None: report() says why. A closed camera is tried again.
  std::optional<CapturedFrame> next();

  /// Somebody set the host's clock: the camera's is learnt again.
  void host_clock_set();

  CaptureReport report() const;
  /// What the camera that is or was open knows of its lens.
  const std::optional<CameraIntrinsics>& intrinsics() const { return info_.intrinsics; }

 private:
  bool reopen();
  std::optional<CapturedFrame> take(Result<DeviceFrame, NoFrame> result);
  void hear();
  void spoil(NoFrame reason);
  void wait_longer();
  void forget_stream();
  void lose(CaptureState state, const std::string& why);

  Open open_;
  CameraSettings settings_;
  FrameAllocator allocate_;
  double transfer_s_;
  std::unique_ptr<FrameSource> source_;
  SourceInfo info_;
  std::optional<FrameStamper> stamper_;
  FrameCounter counter_{64};
  CaptureState state_ = CaptureState::kClosed;
  std::string fault_;
  Duration silent_for_{}, spoilt_for_{};
  Duration may_be_late_ = kSilence;  ///< doubled with each opening that brought too few frames to learn the period
  double period_s_ = 0;              ///< from frame to frame, as learnt or told; 0: unknown
  bool lost_ = true, was_open_ = false;
  std::uint64_t reconnects_ = 0, frames_before_ = 0, dropped_before_ = 0, clock_restarts_before_ = 0;
  DropCounts<NoFrame> missed_;
};

}  // namespace lodestar
