#include "lodestar/ros/params/line_setup.hpp"

namespace lodestar {

Site read_site(ParamReader& params) {
  const std::string path = params.path("site");
  if (path.empty()) return {};
  auto site = load_site(path);
  if (site) return std::move(site).value();
  params.add(site.error());
  return {};
}

LineSetup read_line_setup(ParamReader& params) {
  LineSetup setup;
  setup.site = read_site(params);
  setup.site_path = params.text("site", "");
  const std::string path = params.text("vehicle", "");
  if (!path.empty()) {
    auto vehicle = load_vehicle(path);
    if (vehicle) {
      setup.vehicle = std::move(vehicle).value();
    } else {
      params.add(vehicle.error());
    }
  }
  if (setup.vehicle.camera_rate_hz && !setup.site.tone_table_hz.empty()) {
    params.add(check_tones(setup.site,
                           {*setup.vehicle.camera_rate_hz, setup.vehicle.mains_hz, setup.vehicle.window_frames},
                           setup.site_path));
  }
  return setup;
}

}  // namespace lodestar
