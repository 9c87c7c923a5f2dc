// The filter's processor time at full load: 200 Hz inertial, 50 Hz wheels, 60 images/s with 12 bearings each.
// One iteration is 30 s of a truck that drives; `core_percent` is what they cost of one core.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <variant>
#include <vector>

#include "support/fusion_run.hpp"

namespace lodestar::test {
namespace {

struct Delivery {
  std::size_t tick;  ///< of reception
  std::variant<ImuSample, OdometrySample, BeaconBearings> data;
};

/// The samples of a whole drive in the order of reception.
std::vector<Delivery> deliveries(const TruckDrive& drive, TruckSensors& sensors, double latency_s) {
  constexpr std::size_t kRate = TruckDrive::kRate_hz;
  const auto late = static_cast<std::size_t>(latency_s * kRate);
  std::vector<Delivery> out;
  for (std::size_t i = kRate / 200; i + 1 < drive.size(); ++i) {
    if (i % (kRate / 200) == 0) out.push_back({i, sensors.imu(i)});
    if (i % (kRate / 50) == 0) out.push_back({i, sensors.wheels(i, 0.02)});
    if (i % (kRate / 60) == 0) {
      BeaconBearings bearings = sensors.bearings(i, 1.0 / 60);
      bearings.bearings.resize(std::min<std::size_t>(bearings.bearings.size(), 12));
      out.push_back({i + late, bearings});
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Delivery& a, const Delivery& b) { return a.tick < b.tick; });
  return out;
}

void FilterDrive(benchmark::State& state) {
  const double latency_s = 1e-3 * static_cast<double>(state.range(0));
  const TruckDrive drive({{0, 0, 0}, {2, 0, 0}, {4, 2, 0}, {30, 2, 0.1}}, 1);
  TruckSensors sensors(drive, SensorErrors{}, 1, 3.5);
  const std::vector<Delivery> all = deliveries(drive, sensors, latency_s);
  double bearings = 0, images = 0;
  for (const Delivery& delivery : all)
    if (const auto* image = std::get_if<BeaconBearings>(&delivery.data)) {
      bearings += static_cast<double>(image->bearings.size());
      ++images;
    }
  const double seconds_of_drive = static_cast<double>(drive.size()) / TruckDrive::kRate_hz;
  const std::clock_t begin = std::clock();
  for (auto _ : state) {
    PoseFilter filter{PoseFilterParams{}};
    filter.set_camera(sensors.T_base_camera());
    for (const Delivery& delivery : all) {
      if (const auto* imu = std::get_if<ImuSample>(&delivery.data)) filter.add_imu(*imu);
      if (const auto* wheels = std::get_if<OdometrySample>(&delivery.data)) filter.add_odometry(*wheels);
      const auto* image = std::get_if<BeaconBearings>(&delivery.data);
      if (image == nullptr) continue;
      if (filter.mode() != FilterMode::kTracking && filter.mode() != FilterMode::kCoasting)
        filter.add_fix(sensors.fix(drive.index(image->stamp), 0.1));
      filter.add_bearings(*image);
    }
    benchmark::DoNotOptimize(filter.estimate());
  }
  state.counters["bearings"] = bearings / images;
  const double spent_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  state.counters["core_percent"] = 100 * spent_s / (seconds_of_drive * static_cast<double>(state.iterations()));
}
BENCHMARK(FilterDrive)->Name("Filter/ms_late")->Arg(0)->Arg(20)->Arg(250)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lodestar::test

BENCHMARK_MAIN();
