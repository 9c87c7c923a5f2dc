#include "lodestar/sensing/camera/camera_settings.hpp"

#include <algorithm>
#include <sstream>

namespace lodestar {
namespace {

struct NumberSetting {
  const char* key;
  const char* unit;
  std::optional<double> value;
  std::optional<SettingRange> range;
};

void check(const NumberSetting& setting, const std::string& camera, Faults& faults) {
  if (!setting.value) return;
  std::ostringstream what;
  what << setting.key << " is " << *setting.value << setting.unit << ", ";
  if (!setting.range) {
    what << "the camera cannot be told: leave " << setting.key << " out";
  } else if (*setting.value >= setting.range->lowest && *setting.value <= setting.range->highest) {
    return;
  } else {
    what << "the camera takes " << setting.range->lowest << " to " << setting.range->highest << setting.unit
         << ": choose one of these";
  }
  faults.push_back({camera, 0, what.str()});
}

void check(const char* key, const std::string& value, const std::vector<std::string>& choices,
           const std::string& camera, Faults& faults) {
  if (value.empty() || std::find(choices.begin(), choices.end(), value) != choices.end()) return;
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
  faults.push_back({camera, 0,
                    std::string(key) + " is '" + value + "', " +
                        (list.empty() ? "the camera has none: leave " + std::string(key) + " out"
                                      : "the camera has " + list + ": choose one of these")});
}

}  // namespace

Faults check_settings(const CameraSettings& settings, const CameraLimits& limits, const std::string& camera) {
  Faults faults;
  check({"exposure_s", " s", settings.exposure_s, limits.exposure_s}, camera, faults);
  check({"gain", "", settings.gain, limits.gain}, camera, faults);
  check({"rate_hz", " Hz", settings.rate_hz, limits.rate_hz}, camera, faults);
  check({"width_px", " px", settings.width_px, limits.width_px}, camera, faults);
  check({"height_px", " px", settings.height_px, limits.height_px}, camera, faults);
  check("pixel_format", settings.pixel_format, limits.pixel_formats, camera, faults);
  check("trigger", settings.trigger, limits.triggers, camera, faults);
  if (faults.empty() && settings.exposure_s && settings.rate_hz && *settings.exposure_s * *settings.rate_hz > 1) {
    std::ostringstream what;
    what << "exposure_s is " << *settings.exposure_s << " s, at " << *settings.rate_hz << " Hz a frame lasts "
         << 1 / *settings.rate_hz << " s: shorten exposure_s or lower rate_hz";
    faults.push_back({camera, 0, what.str()});
  }
  return faults;
}

}  // namespace lodestar
