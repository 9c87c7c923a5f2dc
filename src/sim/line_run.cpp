#include "lodestar/sim/line_run.hpp"

#include <stdexcept>
#include <variant>

namespace lodestar::sim {

LocalizationLine make_line(const Scenario& scenario, const Vehicle& vehicle) {
  LocalizationLine line(scenario.site, line_params(scenario.site, vehicle, scenario.camera.rate_hz));
  line.set_camera({CameraModel::create(scenario.camera.intrinsics).value(), scenario.T_base_camera});
  line.set_ir_array(scenario.ir.T_base_ir);
  line.set_imu(scenario.imu.T_base_imu.translation());
  return line;
}

std::optional<LocalizationLine::Outcome> feed(LocalizationLine& line, const Event& event) {
  if (const auto* imu = std::get_if<ImuSample>(&event.data)) line.add_imu(*imu);
  if (const auto* odometry = std::get_if<OdometrySample>(&event.data)) line.add_odometry(*odometry);
  if (const auto* frame = std::get_if<RawIrFrame>(&event.data)) line.add_ir_frame(*frame);
  if (const auto* samples = std::get_if<IrSampleBlock>(&event.data)) line.add_ir_samples(*samples);
  const auto* image = std::get_if<Image>(&event.data);
  if (image == nullptr) return std::nullopt;
  auto outcome = line.process(*image);
  if (!outcome) return std::nullopt;
  return std::move(outcome).value();
}

void run_line(const Scenario& scenario, const std::function<void(const LineStep&)>& visit, const Vehicle& vehicle) {
  constexpr double kStanding_m_s = 0.05;
  if (!scenario.has_camera) throw std::invalid_argument(scenario.name + ": the scenario has no camera; give it one");
  Simulation simulation(scenario);
  LocalizationLine line = make_line(scenario, vehicle);
  while (const auto event = simulation.next()) {
    auto outcome = feed(line, *event);
    if (!outcome) continue;
    const double time_s = seconds(outcome->sightings.stamp - scenario.start);
    const auto truth = simulation.truck().motion(time_s);
    visit({time_s, std::move(*outcome), truth.T_map_base, truth.velocity_map_m_s.head<2>().norm() <= kStanding_m_s});
  }
}

}  // namespace lodestar::sim
