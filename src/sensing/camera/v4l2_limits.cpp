#include "v4l2_limits.hpp"

#include <algorithm>
#include <iterator>

namespace lodestar {
namespace {

struct PixelFormat {
  const char* name;
  std::uint32_t code;
};
/// The first that a camera has is taken unless another is asked for.
constexpr PixelFormat kFormats[] = {{"mono8", V4L2_PIX_FMT_GREY},
                                    {"mono16", V4L2_PIX_FMT_Y16},
                                    {"yuyv", V4L2_PIX_FMT_YUYV},
                                    {"mjpeg", V4L2_PIX_FMT_MJPEG}};

void widen(std::optional<SettingRange>& range, double lowest, double highest) {
  if (!range) range = SettingRange{lowest, highest};
  range->lowest = std::min(range->lowest, lowest);
  range->highest = std::max(range->highest, highest);
}

bool offers(V4l2Port& port, std::uint32_t format) {
  auto offered = of_capture<v4l2_fmtdesc>();
  for (; port.control(VIDIOC_ENUM_FMT, &offered) == 0; ++offered.index)
    if (offered.pixelformat == format) return true;
  return false;
}

std::optional<SettingRange> range(V4l2Port& port, std::uint32_t control, double unit) {
  const auto answer = v4l2_query(port, control);
  if (!answer || (answer->flags & V4L2_CTRL_FLAG_READ_ONLY)) return std::nullopt;
  return SettingRange{answer->minimum * unit, answer->maximum * unit};
}

void widen_sizes(V4l2Port& port, std::uint32_t format, CameraLimits& limits) {
  v4l2_frmsizeenum size{};
  size.pixel_format = format;
  for (; port.control(VIDIOC_ENUM_FRAMESIZES, &size) == 0; ++size.index) {
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      widen(limits.width_px, size.discrete.width, size.discrete.width);
      widen(limits.height_px, size.discrete.height, size.discrete.height);
      continue;
    }
    widen(limits.width_px, size.stepwise.min_width, size.stepwise.max_width);
    widen(limits.height_px, size.stepwise.min_height, size.stepwise.max_height);
    return;
  }
}

}  // namespace

std::uint32_t v4l2_format_of(const std::string& name) {
  return std::find_if(std::begin(kFormats), std::end(kFormats), [&](const PixelFormat& f) { return f.name == name; })
      ->code;
}

std::optional<v4l2_queryctrl> v4l2_query(V4l2Port& port, std::uint32_t control) {
  v4l2_queryctrl answer{};
  answer.id = control;
  if (port.control(VIDIOC_QUERYCTRL, &answer) != 0 || (answer.flags & V4L2_CTRL_FLAG_DISABLED)) return std::nullopt;
  return answer;
}

CameraLimits v4l2_limits(V4l2Port& port) {
  CameraLimits limits;
  limits.exposure_s = range(port, V4L2_CID_EXPOSURE_ABSOLUTE, kV4l2ExposureUnit_s);
  limits.gain = range(port, V4L2_CID_GAIN, 1);
  for (const PixelFormat& format : kFormats) {
    if (!offers(port, format.code)) continue;
    limits.pixel_formats.emplace_back(format.name);
    widen_sizes(port, format.code, limits);
  }
  return limits;
}

double v4l2_rate(const v4l2_fract& interval) {
  return static_cast<double>(interval.denominator) / static_cast<double>(interval.numerator);
}

std::optional<SettingRange> v4l2_rates(V4l2Port& port, const v4l2_pix_format& format) {
  std::optional<SettingRange> rates_hz;
  v4l2_frmivalenum interval{};
  interval.pixel_format = format.pixelformat;
  interval.width = format.width;
  interval.height = format.height;
  for (; port.control(VIDIOC_ENUM_FRAMEINTERVALS, &interval) == 0; ++interval.index) {
    if (interval.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      widen(rates_hz, v4l2_rate(interval.discrete), v4l2_rate(interval.discrete));
      continue;
    }
    widen(rates_hz, v4l2_rate(interval.stepwise.max), v4l2_rate(interval.stepwise.min));
    break;
  }
  return rates_hz;
}

}  // namespace lodestar
