#pragma once

#include <memory>
#include <optional>
#include <queue>
#include <variant>
#include <vector>

#include "lodestar/base/measurement/image.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/sim/camera.hpp"
#include "lodestar/sim/fix_sensor.hpp"
#include "lodestar/sim/imu.hpp"
#include "lodestar/sim/ir_receiver.hpp"
#include "lodestar/sim/ir_sampler.hpp"
#include "lodestar/sim/load_handling.hpp"
#include "lodestar/sim/scenario.hpp"
#include "lodestar/sim/truck.hpp"
#include "lodestar/sim/wheel_odometry.hpp"

namespace lodestar::sim {

/// base_link in map (/ground_truth/pose).
struct TrueBase {
  Stamp stamp;
  RigidTransform T_map_base = RigidTransform::Identity();
};

/// The camera in map at the middle of an exposure (/ground_truth/camera_pose).
struct TrueCamera {
  Stamp stamp;
  RigidTransform T_map_camera = RigidTransform::Identity();
};

/// All pallets on the site, told when one was taken or left (/ground_truth/pallets).
struct TruePallets {
  Stamp stamp;
  std::vector<Pallet> pallets;
};

/// One sample and when it reaches the computer.
struct Event {
  Stamp received;
  std::variant<Image, ImuSample, OdometrySample, RawIrFrame, TrueBase, TrueCamera, Fix, LoadSample, TruePallets,
               IrSampleBlock>
      data;
};

/// A whole run of a scenario: what the sensors say, in the order of reception. The same seed gives the same run, bit by
/// bit. The stack is told scenario().site, scenario().camera.intrinsics, scenario().T_base_camera,
/// scenario().imu.T_base_imu and scenario().ir.T_base_ir; the samples come from the true ones.
class Simulation {
 public:
  /// Throws std::invalid_argument when the scenario cannot be run (it did not come from load_scenario).
  explicit Simulation(const Scenario& scenario);

  /// The next sample; none when the duration is over.
  std::optional<Event> next();

  const Scenario& scenario() const { return scenario_; }

  /// @name What is true, for tests and evaluation. Times in s since the start.
  /// @{
  const std::vector<Beacon>& true_beacons() const { return true_beacons_; }
  /// Only where the scenario has a camera.
  const CameraModel& true_camera() const { return camera_->model(); }
  const RigidTransform& true_T_base_camera() const { return true_T_base_camera_; }
  const Truck& truck() const { return *truck_; }
  const Scene& scene() const { return scene_; }
  /// @}

 private:
  struct Later {
    bool operator()(const std::pair<Event, std::uint64_t>& a, const std::pair<Event, std::uint64_t>& b) const;
  };

  Stamp stamp(double time_s) const { return scenario_.start + from_seconds(time_s); }
  void push(double received_s, decltype(Event::data) data);
  void make_sensors();
  double next_due_s() const;
  void sample_next();
  void take_image();
  void take_fix();
  void hear_slot();
  void take_load();
  void sample_slot(int slot, std::uint32_t superframe, double begin_s, const RigidTransform& T_map_base);

  Scenario scenario_;
  std::vector<Beacon> true_beacons_;
  RigidTransform true_T_base_camera_;
  Scene scene_;
  std::vector<IrReceiver::Sender> senders_;
  std::unique_ptr<Truck> truck_;
  std::unique_ptr<Camera> camera_;
  std::unique_ptr<Imu> imu_;
  std::unique_ptr<WheelOdometry> odometry_;
  std::unique_ptr<IrReceiver> ir_;
  std::unique_ptr<IrSampler> ir_sampler_;  ///< where the receiver hands over samples
  std::unique_ptr<FixSensor> fixes_;
  std::unique_ptr<LoadHandling> loads_;
  std::uint64_t imu_count_ = 0, odometry_count_ = 0, slot_count_ = 0, fix_count_ = 0, load_count_ = 0, truth_count_ = 0;
  std::uint64_t sequence_ = 0;
  std::priority_queue<std::pair<Event, std::uint64_t>, std::vector<std::pair<Event, std::uint64_t>>, Later> pending_;
};

}  // namespace lodestar::sim
