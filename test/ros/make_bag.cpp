// Writes the bag that the rostests play: make_bag SCENARIO.yaml OUT.bag
#include <iostream>

#include "lodestar/ros/bag/recording.hpp"
#include "lodestar/sim/simulation.hpp"

namespace {

using namespace lodestar;

struct Write {
  RecordingWriter& writer;
  const sim::Scenario& scenario;
  Stamp received;

  void operator()(const Image& image) const {
    writer.write(received, scenario.camera.intrinsics, image.stamp);
    writer.write(received, image);
  }
  void operator()(const sim::TrueBase& truth) const {
    writer.write(received, TruthPose{truth.stamp, truth.T_map_base});
  }
  void operator()(const sim::TrueCamera& truth) const {
    writer.write(received, TruthCameraPose{truth.stamp, truth.T_map_camera});
  }
  void operator()(const sim::TruePallets& truth) const { writer.write(received, truth.pallets, truth.stamp); }
  template <class Sample>
  void operator()(const Sample& sample) const {
    writer.write(received, sample);
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "usage: make_bag SCENARIO.yaml OUT.bag\n", 2;
  const auto scenario = sim::load_scenario(argv[1]);
  if (!scenario) return std::cerr << describe(scenario.error()), 1;
  RecordingWriterParams params;
  params.compression = BagCompression::kBz2;
  params.tone_table_hz = scenario->site.tone_table_hz;
  params.mounts = {{"base_link", "camera_optical_frame", scenario->T_base_camera},
                   {"base_link", "imu_link", scenario->imu.T_base_imu},
                   {"base_link", "ir_array", scenario->ir.T_base_ir}};
  RecordingWriter writer(argv[2], params);
  sim::Simulation simulation(*scenario);
  while (const auto event = simulation.next()) std::visit(Write{writer, *scenario, event->received}, event->data);
  return 0;
}
