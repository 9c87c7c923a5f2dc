#include "lodestar/sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestar::sim {
namespace {

constexpr double kImuLatency_s = 0.001;
constexpr double kOdometryLatency_s = 0.002;
constexpr double kLoadLatency_s = 0.02;
constexpr double kIrLatency_s = 0.001;  // after the frame's last bit

Eigen::Vector3d draw(Random& random, double sigma) {
  const double x = random.normal(sigma), y = random.normal(sigma), z = random.normal(sigma);
  return {x, y, z};
}

CameraIntrinsics true_intrinsics(CameraIntrinsics told, const CalibrationErrors& errors, Random& random) {
  const double focal = 1 + random.normal(errors.focal_sigma);
  told.fx_px *= focal;
  told.fy_px *= focal;
  told.cx_px += random.normal(errors.centre_sigma_px);
  told.cy_px += random.normal(errors.centre_sigma_px);
  told.coefficients[0] += random.normal(errors.k1_sigma);
  return told;
}

RigidTransform true_mount(RigidTransform told, double sigma_rad, double sigma_m, Random& random) {
  told.linear() = told.linear() * so3_exp(draw(random, sigma_rad));
  told.translation() += draw(random, sigma_m);
  return told;
}

/// From imu_link's axes into base_link's, as the stack is told that they lie.
ImuSample turned(ImuSample sample, const RigidTransform& T_base_imu) {
  sample.angular_velocity_rad_s = T_base_imu.linear() * sample.angular_velocity_rad_s;
  sample.specific_force_m_s2 = T_base_imu.linear() * sample.specific_force_m_s2;
  return sample;
}

double due(std::uint64_t count, double rate_hz) { return static_cast<double>(count) / rate_hz; }

}  // namespace

bool Simulation::Later::operator()(const std::pair<Event, std::uint64_t>& a,
                                   const std::pair<Event, std::uint64_t>& b) const {
  return a.first.received != b.first.received ? a.first.received > b.first.received : a.second > b.second;
}

Simulation::Simulation(const Scenario& scenario) : scenario_(scenario) {
  truck_ = std::make_unique<Truck>(scenario.route, scenario.floor, scenario.sway, scenario.seed);

  Random survey(scenario.seed, "survey");
  Random phases(scenario.seed, "beacons");
  for (const Beacon& told : scenario.site.beacons) {
    Beacon beacon = told;
    beacon.position_map += draw(survey, scenario.errors.survey_sigma_m);
    scene_.lights.push_back(std::make_shared<BeaconLight>(beacon, scenario.site.tone_table_hz, scenario.site.link,
                                                          scenario.beacons, phases));
    senders_.push_back({beacon.position_map, told});
    true_beacons_.push_back(std::move(beacon));
  }
  Random lamps(scenario.seed, "lamps");
  for (const LampParams& lamp : scenario.lamps) scene_.lights.push_back(std::make_shared<Lamp>(lamp, lamps));
  scene_.walls = scenario.walls;
  scene_.boxes = scenario.boxes;
  make_sensors();
}

void Simulation::make_sensors() {
  Random calibration(scenario_.seed, "calibration");
  const CalibrationErrors& errors = scenario_.errors;
  CameraParams camera = scenario_.camera;
  camera.intrinsics = true_intrinsics(camera.intrinsics, errors, calibration);
  true_T_base_camera_ = true_mount(scenario_.T_base_camera, errors.mount_sigma_rad, errors.mount_sigma_m, calibration);
  if (scenario_.has_camera) camera_ = std::make_unique<Camera>(camera, scenario_.seed);
  if (scenario_.fixes) fixes_ = std::make_unique<FixSensor>(*scenario_.fixes, scenario_.seed);

  if (scenario_.has_imu) {
    ImuParams imu = scenario_.imu;
    imu.T_base_imu = true_mount(imu.T_base_imu, errors.imu_mount_sigma_rad, 0, calibration);
    imu_ = std::make_unique<Imu>(imu, scenario_.seed);
  }
  if (scenario_.has_odometry) odometry_ = std::make_unique<WheelOdometry>(scenario_.odometry, scenario_.seed);
  if (scenario_.loads)
    loads_ = std::make_unique<LoadHandling>(*scenario_.loads, truck_->route(), scenario_.T_base_fork,
                                            scenario_.site.zones, scenario_.seed);
  if (scenario_.has_ir) ir_ = std::make_unique<IrReceiver>(scenario_.ir, scenario_.seed);
  if (scenario_.ir_samples) {
    IrSamplerParams sampler;
    sampler.channels = scenario_.ir.diodes;
    sampler.noise = scenario_.ir.sample_noise;
    sampler.mains_hz = scenario_.mains_hz;
    ir_sampler_ = std::make_unique<IrSampler>(sampler, scenario_.seed);
  }
}

void Simulation::push(double received_s, decltype(Event::data) data) {
  pending_.push({Event{stamp(received_s), std::move(data)}, sequence_++});
}

double Simulation::next_due_s() const {
  double next = due(truth_count_, scenario_.truth_rate_hz);
  if (camera_) next = std::min(next, camera_->next_due_s());
  if (fixes_) next = std::min(next, due(fix_count_, scenario_.fixes->rate_hz));
  if (imu_) next = std::min(next, due(imu_count_, scenario_.imu.rate_hz));
  if (odometry_) next = std::min(next, due(odometry_count_, scenario_.odometry.rate_hz));
  if (loads_) next = std::min(next, due(load_count_, scenario_.loads->rate_hz));
  if (ir_) next = std::min(next, static_cast<double>(slot_count_) * scenario_.site.link.slot_s);
  return next;
}

void Simulation::sample_next() {
  const double t = next_due_s();
  if (t == due(truth_count_, scenario_.truth_rate_hz)) {
    push(t, TrueBase{stamp(t), truck_->T_map_base(t)});
    ++truth_count_;
  }
  if (imu_ && t == due(imu_count_, scenario_.imu.rate_hz)) {
    push(t + kImuLatency_s, turned(imu_->sample(*truck_, t, stamp(t)), scenario_.imu.T_base_imu));
    ++imu_count_;
  }
  if (odometry_ && t == due(odometry_count_, scenario_.odometry.rate_hz)) {
    push(t + kOdometryLatency_s, odometry_->sample(*truck_, t, stamp(t)));
    ++odometry_count_;
  }
  if (ir_ && t == static_cast<double>(slot_count_) * scenario_.site.link.slot_s) hear_slot();
  if (fixes_ && t == due(fix_count_, scenario_.fixes->rate_hz)) take_fix();
  if (loads_ && t == due(load_count_, scenario_.loads->rate_hz)) take_load();
  if (camera_ && t == camera_->next_due_s()) take_image();
}

void Simulation::take_image() {
  const double due_s = camera_->next_due_s();
  const Camera::Shot shot = camera_->next_shot();
  if (shot.dropped) return;
  const auto T_map_camera = [this](double time_s) -> RigidTransform {
    return truck_->T_map_base(time_s) * true_T_base_camera_;
  };
  Image image = camera_->expose(scene_, T_map_camera, shot.middle_s);
  image.stamp = stamp(shot.stamp_s);
  push(std::max(due_s, shot.middle_s), TrueCamera{stamp(shot.middle_s), T_map_camera(shot.middle_s)});
  push(std::max(due_s, shot.middle_s + 0.5 * scenario_.camera.exposure_s + scenario_.camera.latency_s),
       std::move(image));
}

void Simulation::take_fix() {
  const double t = due(fix_count_++, scenario_.fixes->rate_hz);
  if (auto reading = fixes_->sample(*truck_, t, stamp(t))) push(t + reading->latency_s, std::move(reading->fix));
}

void Simulation::take_load() {
  const double t = due(load_count_++, scenario_.loads->rate_hz);
  const LoadSample sample = loads_->sample(*truck_, t, stamp(t));
  if (loads_->moved()) push(t, TruePallets{stamp(t), loads_->pallets()});
  push(t + kLoadLatency_s, sample);
}

void Simulation::hear_slot() {
  const Link& link = scenario_.site.link;
  const double begin_s = static_cast<double>(slot_count_) * link.slot_s;
  const auto slots = static_cast<std::uint64_t>(link.slot_count);
  const auto superframe = static_cast<std::uint32_t>(scenario_.first_superframe + slot_count_ / slots);
  const int slot = static_cast<int>(slot_count_ % slots);
  ++slot_count_;
  const double duration_s = ir_frame_duration_s(link);
  const RigidTransform T_map_base = truck_->T_map_base(begin_s + 0.5 * duration_s);
  if (ir_sampler_) return sample_slot(slot, superframe, begin_s, T_map_base);
  for (auto& heard : ir_->listen(senders_, link, scenario_.beacons, scene_, T_map_base, slot, superframe)) {
    heard.frame.stamp = stamp(begin_s + heard.offset_s);
    push(begin_s + heard.offset_s + duration_s + kIrLatency_s, std::move(heard.frame));
  }
}

void Simulation::sample_slot(int slot, std::uint32_t superframe, double begin_s, const RigidTransform& T_map_base) {
  const Link& link = scenario_.site.link;
  for (auto& sent : ir_->on_air(senders_, link, scenario_.beacons, scene_, T_map_base, slot, superframe))
    ir_sampler_->send({begin_s, link.bit_rate_bps, sent.octets, sent.levels});
  const double until_s = begin_s + link.slot_s;
  const double first_s = ir_sampler_->time_s();
  const int count = static_cast<int>(std::lround((until_s - first_s) * ir_sampler_->sample_rate_hz()));
  push(until_s + kIrLatency_s, ir_sampler_->next(count, stamp(first_s)));
}

std::optional<Event> Simulation::next() {
  while (true) {
    const double due_s = next_due_s();
    const bool over = scenario_.duration_s && due_s >= *scenario_.duration_s;
    if (!pending_.empty() && (over || pending_.top().first.received <= stamp(due_s))) {
      Event event = pending_.top().first;
      pending_.pop();
      return event;
    }
    if (over) return std::nullopt;
    sample_next();
  }
}

}  // namespace lodestar::sim
