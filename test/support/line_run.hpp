#pragma once

#include <functional>

#include "lodestar/line/localization_line.hpp"
#include "lodestar/sim/simulation.hpp"

namespace lodestar::test {

/// What the line said of one image, and where the truck was.
struct LineStep {
  double time_s;  ///< since the start
  LocalizationLine::Outcome outcome;
  RigidTransform T_map_base_true;
  bool standing;
};

/// Runs the optical line over a scenario, in the order of reception, and shows each image's outcome.
inline void run_line(const sim::Scenario& scenario, const std::function<void(const LineStep&)>& visit) {
  sim::Simulation simulation(scenario);
  LocalizationLine line(scenario.site, line_params(scenario.site, Vehicle(), scenario.camera.rate_hz));
  line.set_camera({CameraModel::create(scenario.camera.intrinsics).value(), scenario.T_base_camera});
  line.set_imu(scenario.imu.T_base_imu.translation());
  while (const auto event = simulation.next()) {
    if (const auto* imu = std::get_if<ImuSample>(&event->data)) line.add_imu(*imu);
    if (const auto* odometry = std::get_if<OdometrySample>(&event->data)) line.add_odometry(*odometry);
    if (const auto* frame = std::get_if<RawIrFrame>(&event->data)) line.add_ir_frame(*frame);
    const auto* image = std::get_if<Image>(&event->data);
    if (image == nullptr) continue;
    const auto outcome = line.process(*image);
    if (!outcome) continue;
    const double time_s = seconds(image->stamp - scenario.start);
    const auto truth = simulation.truck().motion(time_s);
    visit({time_s, *outcome, truth.T_map_base, truth.velocity_map_m_s.head<2>().norm() < 0.05});
  }
}

}  // namespace lodestar::test
