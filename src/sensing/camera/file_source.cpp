#include "file_source.hpp"

#include <algorithm>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <thread>

#include "host_clock.hpp"
#include "pixels.hpp"

namespace lodestar {

FileSource::FileSource(const std::string& address) : path_(address.substr(0, address.find('?'))) {
  const std::string option = path_.size() < address.size() ? address.substr(path_.size() + 1) : "";
  if (!option.empty() && option != "loop")
    throw CameraRefusal({{"file:" + address, 0, "'" + option + "' is no option: only ?loop is"}});
  loop_ = !option.empty();
  is_sequence_ = path_.find('%') != std::string::npos;
  if (is_sequence_ && !std::regex_match(path_, std::regex("[^%]*%0?[1-9]?[du][^%]*")))
    throw CameraRefusal({{"file:" + path_, 0, "must have one number, such as %04d, for the pictures of a sequence"}});
  rewind();
}

void FileSource::rewind() {
  const bool is_there = std::filesystem::is_regular_file(path_);  // OpenCV would say much, and try URLs
  try {
    if (is_there || is_sequence_) capture_.open(path_, is_sequence_ ? cv::CAP_IMAGES : cv::CAP_ANY);
  } catch (const cv::Exception&) {
    capture_.release();
  }
  if (capture_.isOpened()) return;
  const std::string name = "file:" + path_;
  if (is_there) throw CameraRefusal({{name, 0, "is no video that can be read"}});
  throw CameraError(name + " is not there, or no image sequence that can be read");
}

SourceInfo FileSource::start(const CameraSettings& settings, const FrameAllocator& allocate) {
  CameraLimits limits;
  limits.rate_hz = SettingRange{0.1, 1000};
  const std::string name = "file:" + path_;
  Faults faults = check_settings(settings, limits, name);
  const double rate_hz = settings.rate_hz ? *settings.rate_hz : is_sequence_ ? 0 : capture_.get(cv::CAP_PROP_FPS);
  if (!(rate_hz > 0)) faults.push_back({name, 0, "rate_hz is missing: the files do not say how fast they were taken"});
  if (!faults.empty()) throw CameraRefusal(faults);

  allocate_ = allocate;
  period_ = from_seconds(1 / rate_hz);
  due_ = host_now();
  SourceInfo info;
  info.name = name;
  info.period_s = 1 / rate_hz;
  info.clock.stamped = SourceClock::Stamped::kExposureMiddle;
  info.clock.heard_at_arrival = false;
  return info;
}

bool FileSource::read() {
  try {
    return capture_.read(image_);
  } catch (const cv::Exception&) {  // a header that claims a giant
    return false;
  }
}

/// OpenCV stays at a picture that it cannot read, as it does at the end.
bool FileSource::leave_out() {
  const double at = capture_.get(cv::CAP_PROP_POS_FRAMES);
  if (!is_sequence_ || at + 1 >= capture_.get(cv::CAP_PROP_FRAME_COUNT)) return false;
  return capture_.set(cv::CAP_PROP_POS_FRAMES, at + 1);
}

std::optional<NoFrame> FileSource::next_picture() {
  if (read()) return std::nullopt;
  if (leave_out()) return NoFrame::kFormat;
  if (!loop_) return NoFrame::kEnd;
  rewind();
  return read() ? std::nullopt : std::optional(NoFrame::kEnd);
}

Result<DeviceFrame, NoFrame> FileSource::next(Duration timeout) {
  const Duration wait = due_ - host_now();
  std::this_thread::sleep_for(std::min(wait, timeout));
  if (wait > timeout) return NoFrame::kTimeout;
  const Stamp shot = due_;
  // A machine that cannot keep up skips no frames but gets them late.
  due_ = std::max(due_ + period_, host_now() - period_);
  if (const auto none = next_picture()) return *none;
  auto frame = frame_of(image_, allocate_);
  if (!frame) return NoFrame::kFormat;
  frame->id = id_++;
  frame->ticks = static_cast<std::uint64_t>(shot.time_since_epoch().count());
  frame->heard = {frame->ticks, shot};
  return *frame;
}

}  // namespace lodestar
