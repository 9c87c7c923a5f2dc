#include "lodestar/sensing/camera/v4l2_source.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <opencv2/core.hpp>
#include <utility>

#include "pixels.hpp"
#include "v4l2_limits.hpp"

namespace lodestar {
namespace {

constexpr std::uint32_t kBuffers = 4;
std::int64_t now_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

/// The kernel's steady clock, which stamps the frames, and the host's, read together.
ClockPair both_clocks() {
  return {static_cast<std::uint64_t>(now_ns(CLOCK_MONOTONIC)), Stamp(Duration(now_ns(CLOCK_REALTIME)))};
}

/// Whether the kernel's pixels are those of a frame as they are.
bool is_plain(const v4l2_pix_format& format) {
  return format.pixelformat == V4L2_PIX_FMT_GREY || format.pixelformat == V4L2_PIX_FMT_Y16;
}

std::size_t row_bytes(const v4l2_pix_format& format) {
  return format.width * (format.pixelformat == V4L2_PIX_FMT_GREY ? 1u : 2u);
}

std::size_t stride_bytes(const v4l2_pix_format& format) {
  return std::max<std::size_t>(format.bytesperline, row_bytes(format));
}

}  // namespace

V4l2Source::V4l2Source(std::string device, std::unique_ptr<V4l2Port> port)
    : name_("v4l2:" + std::move(device)), port_(std::move(port)) {}

V4l2Source::~V4l2Source() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (streaming_) port_->control(VIDIOC_STREAMOFF, &type);
}

void V4l2Source::demand(unsigned long request, void* argument, const std::string& doing) {
  const int fault = port_->control(request, argument);
  if (fault != 0) throw CameraError(name_ + ": " + doing + ": " + std::strerror(fault));
}

void V4l2Source::refuse(const std::string& what) const { throw CameraRefusal({{name_, 0, what}}); }

// A driver may list what it cannot change. That is no fault as long as the control stands as it is wanted.
void V4l2Source::set_if_there(std::uint32_t control, double value) {
  const auto there = v4l2_query(*port_, control);
  if (!there) return;
  const v4l2_control wanted{control, static_cast<std::int32_t>(std::lround(value))};
  v4l2_control setting = wanted, now{control, 0};
  const int fault = port_->control(VIDIOC_S_CTRL, &setting);
  if (fault == 0 || (port_->control(VIDIOC_G_CTRL, &now) == 0 && now.value == wanted.value)) return;
  const std::string what =
      std::string(reinterpret_cast<const char*>(there->name)) + " cannot be set to " + std::to_string(wanted.value);
  const bool for_good = fault == EACCES || fault == EINVAL || fault == ERANGE;
  if (for_good) refuse(what + ", it is " + std::to_string(now.value) + ": " + std::strerror(fault));
  throw CameraError(name_ + ": " + what + ": " + std::strerror(fault));
}

double V4l2Source::exposure_s() {
  v4l2_control exposure{V4L2_CID_EXPOSURE_ABSOLUTE, 0};
  return port_->control(VIDIOC_G_CTRL, &exposure) == 0 ? exposure.value * kV4l2ExposureUnit_s : 0;
}

double V4l2Source::period_s() {
  auto parameters = of_capture<v4l2_streamparm>();
  if (port_->control(VIDIOC_G_PARM, &parameters) != 0) return 0;
  const v4l2_fract& interval = parameters.parm.capture.timeperframe;
  return interval.numerator > 0 && interval.denominator > 0 ? 1 / v4l2_rate(interval) : 0;
}

void V4l2Source::set_format(const CameraSettings& settings) {
  auto format = of_capture<v4l2_format>();
  demand(VIDIOC_G_FMT, &format, "asking for its format");
  format.fmt.pix.pixelformat = v4l2_format_of(settings.pixel_format);
  if (settings.width_px) format.fmt.pix.width = static_cast<std::uint32_t>(*settings.width_px);
  if (settings.height_px) format.fmt.pix.height = static_cast<std::uint32_t>(*settings.height_px);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = 0;  // as few as there can be, not those of the format before
  const v4l2_pix_format asked = format.fmt.pix;
  demand(VIDIOC_S_FMT, &format, "setting its format");
  format_ = format.fmt.pix;
  if (asked.pixelformat != format_.pixelformat || asked.width != format_.width || asked.height != format_.height) {
    refuse(settings.pixel_format + " of " + std::to_string(asked.width) + " x " + std::to_string(asked.height) +
           " px is none of its modes, the nearest has " + std::to_string(format_.width) + " x " +
           std::to_string(format_.height) + " px: v4l2-ctl --list-formats-ext shows all");
  }
}

void V4l2Source::set_rate(double rate_hz) {
  constexpr std::uint32_t kThousandths = 1000;
  auto parameters = of_capture<v4l2_streamparm>();
  parameters.parm.capture.timeperframe = {kThousandths,
                                          static_cast<std::uint32_t>(std::lround(rate_hz * kThousandths))};
  demand(VIDIOC_S_PARM, &parameters, "setting its frame rate");
  const double got_hz = v4l2_rate(parameters.parm.capture.timeperframe);
  if (std::abs(got_hz - rate_hz) < 0.01 * rate_hz) return;
  refuse("rate_hz is " + std::to_string(rate_hz) + ", the nearest that the camera has is " + std::to_string(got_hz));
}

SourceInfo V4l2Source::start(const CameraSettings& settings, const FrameAllocator& allocate) {
  v4l2_capability capability{};
  demand(VIDIOC_QUERYCAP, &capability, "it is no video device");
  const std::uint32_t can =
      capability.capabilities & V4L2_CAP_DEVICE_CAPS ? capability.device_caps : capability.capabilities;
  if (!(can & V4L2_CAP_VIDEO_CAPTURE) || !(can & V4L2_CAP_STREAMING)) refuse("it is no camera that streams");

  CameraLimits limits = v4l2_limits(*port_);
  if (limits.pixel_formats.empty()) refuse("it has none of mono8, mono16, yuyv, mjpeg");
  CameraSettings chosen = settings;
  chosen.rate_hz.reset();  // its range depends on the format
  Faults faults = check_settings(chosen, limits, name_);
  if (!faults.empty()) throw CameraRefusal(faults);
  if (chosen.pixel_format.empty()) chosen.pixel_format = limits.pixel_formats.front();
  set_format(chosen);
  limits.rate_hz = v4l2_rates(*port_, format_);
  faults = check_settings(settings, limits, name_);
  if (!faults.empty()) throw CameraRefusal(faults);

  set_if_there(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
  set_if_there(V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);  // it would lower the rate in the dark
  for (const std::uint32_t automatic : {V4L2_CID_AUTOGAIN, V4L2_CID_FOCUS_AUTO, V4L2_CID_AUTO_WHITE_BALANCE,
                                        V4L2_CID_AUTOBRIGHTNESS, V4L2_CID_BACKLIGHT_COMPENSATION})
    set_if_there(automatic, 0);
  if (settings.rate_hz) set_rate(*settings.rate_hz);
  if (settings.exposure_s) set_if_there(V4L2_CID_EXPOSURE_ABSOLUTE, *settings.exposure_s / kV4l2ExposureUnit_s);
  if (settings.gain) set_if_there(V4L2_CID_GAIN, *settings.gain);

  SourceInfo info;
  info.name = name_ + " " + reinterpret_cast<const char*>(capability.card);
  info.exposure_s = exposure_s();
  info.period_s = period_s();
  info.clock.frame_id_bits = 32;
  allocate_ = allocate;
  provide_buffers(info.clock);
  info.in_place = memory_ == V4L2_MEMORY_USERPTR;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  demand(VIDIOC_STREAMON, &type, "starting");
  streaming_ = true;
  return info;
}

// A driver may have no use for memory but its own, and some say so only when they are handed ours.
void V4l2Source::provide_buffers(SourceClock& clock) {
  if (is_plain(format_)) {
    try {
      return queue_buffers(V4L2_MEMORY_USERPTR, clock);
    } catch (const CameraError&) {
      auto none = of_capture<v4l2_requestbuffers>();
      none.memory = V4L2_MEMORY_USERPTR;
      port_->control(VIDIOC_REQBUFS, &none);  // the driver lets go of what it had taken
      buffers_.clear();
    }
  }
  queue_buffers(V4L2_MEMORY_MMAP, clock);
}

void V4l2Source::queue_buffers(v4l2_memory memory, SourceClock& clock) {
  memory_ = memory;
  auto request = of_capture<v4l2_requestbuffers>();
  request.count = kBuffers;
  request.memory = memory_;
  demand(VIDIOC_REQBUFS, &request, "asking for buffers");
  for (std::uint32_t index = 0; index < request.count; ++index) {
    v4l2_buffer buffer = kernel_buffer(index);
    demand(VIDIOC_QUERYBUF, &buffer, "asking for a buffer");
    if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC)
      refuse("its driver does not stamp frames by the steady clock");
    const bool at_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    clock.stamped = at_start ? SourceClock::Stamped::kExposureStart : SourceClock::Stamped::kReceived;
    clock.heard_at_arrival = false;
    buffers_.push_back(memory_ == V4L2_MEMORY_USERPTR ? our_buffer() : mapped_buffer(buffer));
    queue(index);
  }
}

v4l2_buffer V4l2Source::kernel_buffer(std::uint32_t index) const {
  auto buffer = of_capture<v4l2_buffer>();
  buffer.memory = memory_;
  buffer.index = index;
  return buffer;
}

V4l2Source::Buffer V4l2Source::our_buffer() const {
  const std::size_t bytes = std::max<std::size_t>(format_.sizeimage, stride_bytes(format_) * format_.height);
  return {allocate_(bytes), bytes};
}

V4l2Source::Buffer V4l2Source::mapped_buffer(const v4l2_buffer& buffer) {
  std::uint8_t* const data = port_->map(buffer.length, buffer.m.offset);
  if (data == nullptr) throw CameraError(name_ + ": its buffers cannot be mapped");
  return {{data, nullptr}, buffer.length};
}

void V4l2Source::queue(std::uint32_t index) {
  v4l2_buffer buffer = kernel_buffer(index);
  if (memory_ == V4L2_MEMORY_USERPTR) {
    buffer.m.userptr = reinterpret_cast<std::uintptr_t>(buffers_[index].memory.data);
    buffer.length = static_cast<std::uint32_t>(buffers_[index].bytes);
  }
  demand(VIDIOC_QBUF, &buffer, "handing it a buffer");
}

Result<DeviceFrame, NoFrame> V4l2Source::next(Duration timeout) {
  if (!port_->wait(timeout)) {
    v4l2_capability capability{};
    demand(VIDIOC_QUERYCAP, &capability, "it is gone");
    return NoFrame::kTimeout;
  }
  v4l2_buffer buffer = kernel_buffer(0);
  const int fault = port_->control(VIDIOC_DQBUF, &buffer);
  if (fault == EAGAIN) return NoFrame::kTimeout;
  if (fault != 0) throw CameraError(name_ + " is gone: " + std::strerror(fault));

  if (buffer.index >= buffers_.size()) throw CameraError(name_ + ": it filled a buffer that it was never handed");

  const bool damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  auto frame = damaged ? std::nullopt : frame_in(buffers_[buffer.index], buffer.bytesused);
  queue(buffer.index);
  if (!frame) return NoFrame::kIncomplete;
  frame->id = buffer.sequence;
  frame->ticks =
      static_cast<std::uint64_t>(buffer.timestamp.tv_sec * 1'000'000'000LL + buffer.timestamp.tv_usec * 1000LL);
  frame->heard = both_clocks();
  return *frame;
}

std::optional<DeviceFrame> V4l2Source::frame_in(Buffer& buffer, std::size_t bytes_used) const {
  std::uint8_t* const data = buffer.memory.data;
  const std::size_t bytes = std::min(bytes_used, buffer.bytes), stride = stride_bytes(format_);
  const int width = static_cast<int>(format_.width), height = static_cast<int>(format_.height);
  if (format_.pixelformat == V4L2_PIX_FMT_MJPEG) return frame_of_jpeg(data, bytes, width, height, allocate_);

  if (bytes < stride * (format_.height - 1) + row_bytes(format_)) return std::nullopt;
  if (format_.pixelformat == V4L2_PIX_FMT_YUYV) return frame_of_yuyv(data, width, height, stride, allocate_);
  const bool is_8_bit = format_.pixelformat == V4L2_PIX_FMT_GREY;
  if (memory_ == V4L2_MEMORY_MMAP)
    return frame_of(cv::Mat(height, width, is_8_bit ? CV_8UC1 : CV_16UC1, data, stride), allocate_);

  DeviceFrame frame;
  frame.width_px = width;
  frame.height_px = height;
  frame.bits = is_8_bit ? 8 : 16;
  frame.stride_bytes = stride;
  frame.memory = std::exchange(buffer, our_buffer()).memory;
  return frame;
}

}  // namespace lodestar
