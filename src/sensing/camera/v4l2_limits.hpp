#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <optional>
#include <string>

#include "lodestar/sensing/camera/camera_settings.hpp"
#include "lodestar/sensing/camera/v4l2_port.hpp"

namespace lodestar {

constexpr double kV4l2ExposureUnit_s = 100e-6;  ///< of V4L2_CID_EXPOSURE_ABSOLUTE

/// A structure of the kernel's for the stream of images.
template <class Structure>
Structure of_capture() {
  Structure structure{};
  structure.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  return structure;
}

/// The kernel's code of one of our pixel formats.
std::uint32_t v4l2_format_of(const std::string& name);

/// None: the device has no such control.
std::optional<v4l2_queryctrl> v4l2_query(V4l2Port& port, std::uint32_t control);

/// What the device says it can do, but for its rates. Pixel formats come in the order of preference.
CameraLimits v4l2_limits(V4l2Port& port);

/// Rates in this format and size; none: the device does not say.
std::optional<SettingRange> v4l2_rates(V4l2Port& port, const v4l2_pix_format& format);

/// The rate of an interval between two frames, Hz.
double v4l2_rate(const v4l2_fract& interval);

}  // namespace lodestar
