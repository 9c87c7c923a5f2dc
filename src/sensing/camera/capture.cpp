#include "lodestar/sensing/camera/capture.hpp"

#include <algorithm>

namespace lodestar {

Capture::Capture(Open open, const CameraSettings& settings, FrameAllocator allocate, double transfer_s)
    : open_(std::move(open)), settings_(settings), allocate_(std::move(allocate)), transfer_s_(transfer_s) {}

void Capture::open() {
  source_.reset();  // first: most devices serve one at a time
  try {
    source_ = open_();
    info_ = source_->start(settings_, allocate_);
  } catch (const std::exception& error) {
    source_.reset();
    lose(CaptureState::kClosed, error.what());
    throw;
  }
  forget_stream();
  stamper_.emplace(info_, transfer_s_);
  counter_ = FrameCounter(info_.clock.frame_id_bits);
  reconnects_ += was_open_;
  was_open_ = true;
  lost_ = false;
  if (state_ != CaptureState::kSilent || info_.triggered) state_ = CaptureState::kRunning;
  const double asked_s = settings_.rate_hz ? 1 / *settings_.rate_hz : 0;
  const double told_s = std::max(info_.period_s > 0 ? info_.period_s : asked_s, info_.exposure_s);
  if (told_s > 0) period_s_ = told_s;
}

void Capture::forget_stream() {
  frames_before_ += counter_.frames();
  dropped_before_ += counter_.dropped();
  if (stamper_) clock_restarts_before_ += stamper_->fit().restarts();
  silent_for_ = spoilt_for_ = {};
}

std::optional<CapturedFrame> Capture::next() {
  if (state_ == CaptureState::kOver) return std::nullopt;
  if (lost_ && !reopen()) return std::nullopt;
  try {
    return take(source_->next(kPatience));
  } catch (const std::exception& error) {  // whatever a driver's library throws
    lose(CaptureState::kClosed, error.what());
    return std::nullopt;
  }
}

bool Capture::reopen() {
  try {
    open();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

std::optional<CapturedFrame> Capture::take(Result<DeviceFrame, NoFrame> result) {
  if (result) {
    DeviceFrame frame = std::move(result).value();
    hear();
    const Stamp stamp = stamper_->stamp(frame);
    counter_.add(frame.id, stamp);
    if (counter_.period_s() > 0) {
      period_s_ = counter_.period_s();
      may_be_late_ = kSilence;
    }
    return CapturedFrame{stamp, std::move(frame)};
  }
  if (result.error() == NoFrame::kEnd) {
    lose(CaptureState::kOver, "the recording is over");
  } else if (result.error() == NoFrame::kTimeout) {
    wait_longer();
  } else {
    spoil(result.error());
  }
  return std::nullopt;
}

void Capture::hear() {
  silent_for_ = spoilt_for_ = {};
  state_ = CaptureState::kRunning;
  fault_.clear();
}

// To open the camera anew would not mend a cable or a packet size.
void Capture::spoil(NoFrame reason) {
  missed_.add(reason);
  silent_for_ = {};
  spoilt_for_ += period_s_ > 0 ? from_seconds(period_s_) : kPatience;
  if (spoilt_for_ < kSilence) return;
  state_ = CaptureState::kSpoilt;
  fault_ = info_.name + " sends no whole frame: " + lodestar::name(reason);
}

void Capture::wait_longer() {
  silent_for_ += kPatience;
  if (info_.triggered || silent_for_ < from_seconds(period_s_) + may_be_late_) return;
  if (!(counter_.period_s() > 0)) may_be_late_ = std::min(2 * may_be_late_, kMostSilence);
  missed_.add(NoFrame::kTimeout);
  lose(CaptureState::kSilent, info_.name + " is silent");
}

void Capture::lose(CaptureState state, const std::string& why) {
  lost_ = true;
  state_ = state;
  if (state == CaptureState::kClosed) may_be_late_ = kSilence;
  fault_ = why;
}

void Capture::host_clock_set() {
  if (stamper_) stamper_->host_clock_set();
}

CaptureReport Capture::report() const {
  CaptureReport report;
  report.state = state_;
  report.fault = fault_;
  report.camera = info_.name;
  report.in_place = info_.in_place;
  report.frames = frames_before_ + counter_.frames();
  report.dropped = dropped_before_ + counter_.dropped();
  report.reconnects = reconnects_;
  report.missed = missed_;
  report.clock_restarts = clock_restarts_before_;
  if (counter_.period_s() > 0) report.rate_hz = 1 / counter_.period_s();
  report.jitter_s = counter_.jitter_s();
  if (!stamper_) return report;
  report.stamping = stamper_->description();
  report.drift = stamper_->fit().drift();
  report.clock_restarts += stamper_->fit().restarts();
  return report;
}

}  // namespace lodestar
