#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/common/fault.hpp"

namespace lodestar {

/// How a camera is to run. What is left empty stays as the camera has it, but never automatic: a detector of flashes
/// needs frames that are exposed alike.
struct CameraSettings {
  std::optional<double> exposure_s;
  std::optional<double> gain;  ///< in the camera's own unit (GenICam: mostly dB; v4l2: steps)
  std::optional<double> rate_hz;
  std::optional<int> width_px, height_px;
  std::string pixel_format;  ///< mono8, mono16, yuyv, mjpeg; empty: mono8 where the camera has it
  std::string trigger;       ///< the source of an external trigger, by the camera's name for it; empty: runs freely
};

/// Both ends belong to it.
struct SettingRange {
  double lowest = 0, highest = 0;
};

/// What a camera says it can do. An empty range: the camera has no such setting.
struct CameraLimits {
  std::optional<SettingRange> exposure_s, gain, rate_hz, width_px, height_px;
  std::vector<std::string> pixel_formats;  ///< of ours, those that it offers
  std::vector<std::string> triggers;
};

/// What of the settings the camera cannot do, each with its value, the limit and the way out.
/// @param camera its name, for the faults
Faults check_settings(const CameraSettings& settings, const CameraLimits& limits, const std::string& camera);

}  // namespace lodestar
