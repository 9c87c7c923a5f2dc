// A whole run against its own truth.
#include "lodestar/sim/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar::sim {
namespace {

Scenario small_drive() {
  auto scenario = load_scenario(std::string(LODESTAR_SOURCE_DIR) + "/config/scenarios/drive.yaml");
  if (!scenario) throw std::runtime_error(describe(scenario.error()));
  Scenario s = *scenario;
  s.camera.intrinsics.width_px = 160;
  s.camera.intrinsics.height_px = 120;
  s.camera.intrinsics.fx_px = s.camera.intrinsics.fy_px = 57.3;
  s.camera.intrinsics.cx_px = 79.5;
  s.camera.intrinsics.cy_px = 59.5;
  return s;
}

/// No noise, no bias, no scale error: what remains is the physics.
Scenario exact(Scenario s) {
  s.imu.gyro_noise_rad_s = s.imu.gyro_bias_rad_s = 0;
  s.imu.accelerometer_noise_m_s2 = s.imu.accelerometer_bias_m_s2 = 0;
  s.imu.rate_hz = 500;
  s.odometry = {};
  s.odometry.rate_hz = 100;
  s.odometry.velocity_noise_m_s = s.odometry.yaw_rate_noise_rad_s = 0;
  s.errors = {};
  s.camera.rate_hz = 1;
  return s;
}

double t(const Simulation& simulation, Stamp stamp) { return seconds(stamp - simulation.scenario().start); }

TEST(SimulationConsistency, EventsComeInTheOrderOfReceptionAndAtTheirRates) {
  Scenario scenario = small_drive();
  scenario.duration_s = 4;
  Simulation simulation(scenario);
  std::map<std::size_t, int> count;
  Stamp last = scenario.start;
  while (const auto event = simulation.next()) {
    EXPECT_GE(event->received, last);
    last = event->received;
    ++count[event->data.index()];
    std::visit([&](const auto& sample) { EXPECT_LE(sample.stamp, event->received); }, event->data);
  }
  EXPECT_NEAR(count[0], 240, 5);
  EXPECT_EQ(count[1], 800);
  EXPECT_EQ(count[2], 200);
  EXPECT_GT(count[3], 20);
  EXPECT_EQ(count[4], 400);
  EXPECT_EQ(count[5], count[0]);
}

TEST(SimulationConsistency, ASeedNamesARun) {
  const auto digest = [](std::uint64_t seed) {
    Scenario scenario = small_drive();
    scenario.seed = seed;
    scenario.duration_s = 1;
    Simulation simulation(scenario);
    std::uint64_t h = 14695981039346656037ull;
    const auto add = [&h](const void* data, std::size_t size) {
      for (std::size_t i = 0; i < size; ++i) h = (h ^ static_cast<const unsigned char*>(data)[i]) * 1099511628211ull;
    };
    while (const auto event = simulation.next()) {
      const auto received = event->received.time_since_epoch().count();
      add(&received, sizeof received);
      if (const auto* image = std::get_if<Image>(&event->data)) add(image->data, 160 * 120);
      if (const auto* imu = std::get_if<ImuSample>(&event->data)) add(imu->specific_force_m_s2.data(), 24);
      if (const auto* frame = std::get_if<RawIrFrame>(&event->data)) add(frame->octets.data(), frame->octets.size());
    }
    return h;
  };
  EXPECT_EQ(digest(3), digest(3));
  EXPECT_NE(digest(3), digest(4));
}

TEST(SimulationConsistency, OdometryAddsUpToTheTruth) {
  Simulation simulation(exact(small_drive()));
  std::optional<OdometrySample> last;
  RigidTransform T_map_odom = RigidTransform::Identity();
  while (const auto event = simulation.next())
    if (const auto* sample = std::get_if<OdometrySample>(&event->data)) {
      if (!last) T_map_odom = simulation.truck().T_map_base(0);
      last = *sample;
    }
  ASSERT_TRUE(last);
  const auto truth = simulation.truck().route().at(t(simulation, last->stamp));
  const auto begin = simulation.truck().route().at(0);
  const Eigen::Rotation2Dd R(begin.heading_rad);
  const Eigen::Vector2d end = begin.position_m + R * last->position_odom_m.head<2>();
  EXPECT_NEAR((end - truth.position_m).norm(), 0, 0.005);
  EXPECT_NEAR(wrap_angle(begin.heading_rad + last->yaw_odom_rad - truth.heading_rad), 0, 1e-4);
}

TEST(SimulationConsistency, ImuIntegratesToTheTruth) {
  Scenario scenario = exact(small_drive());
  scenario.imu.T_base_imu.translation() << 0.4, -0.2, 1.5;
  scenario.duration_s = 12;
  Simulation simulation(scenario);
  const auto T_map_imu = [&](double time) { return simulation.truck().T_map_base(time) * scenario.imu.T_base_imu; };
  RigidTransform T = T_map_imu(0);
  Eigen::Vector3d velocity = simulation.truck().motion(0, scenario.imu.T_base_imu).velocity_map_m_s;
  std::optional<ImuSample> last;
  while (const auto event = simulation.next())
    if (const auto* sample = std::get_if<ImuSample>(&event->data)) {
      if (last) {
        const double dt = seconds(sample->stamp - last->stamp);
        const Eigen::Matrix3d R = T.linear();
        T.linear() = R * so3_exp(0.5 * dt * (last->angular_velocity_rad_s + sample->angular_velocity_rad_s));
        const Eigen::Vector3d a = 0.5 * (R * last->specific_force_m_s2 + T.linear() * sample->specific_force_m_s2) -
                                  kGravity_m_s2 * Eigen::Vector3d::UnitZ();
        T.translation() += dt * velocity + 0.5 * dt * dt * a;
        velocity += dt * a;
      }
      last = *sample;
    }
  const RigidTransform truth = T_map_imu(t(simulation, last->stamp));
  EXPECT_NEAR(so3_log(T.linear().transpose() * truth.linear()).norm(), 0, 2e-4);
  EXPECT_NEAR((T.translation() - truth.translation()).norm(), 0, 0.03);
}

TEST(SimulationConsistency, TruthAgreesWithItselfAndWithTheImages) {
  Scenario scenario = small_drive();
  scenario.duration_s = 6;
  Simulation simulation(scenario);
  while (const auto event = simulation.next()) {
    if (const auto* base = std::get_if<TrueBase>(&event->data)) {
      EXPECT_NEAR(
          (base->T_map_base.matrix() - simulation.truck().T_map_base(t(simulation, base->stamp)).matrix()).norm(), 0,
          1e-6);
    }
    if (const auto* camera = std::get_if<TrueCamera>(&event->data)) {
      const RigidTransform expected =
          simulation.truck().T_map_base(t(simulation, camera->stamp)) * simulation.true_T_base_camera();
      EXPECT_NEAR((camera->T_map_camera.matrix() - expected.matrix()).norm(), 0, 1e-6);
    }
  }
}

TEST(SimulationConsistency, IrFramesDecodeAndSayWhatTheSiteSays) {
  Scenario scenario = small_drive();
  scenario.duration_s = 6;
  scenario.ir.bit_error_rate = 0;
  scenario.ir.junk_rate_hz = 0;
  scenario.site.link.key = std::array<std::uint8_t, 16>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
  Simulation simulation(scenario);
  const IrFrameDecoder decoder(scenario.site.link, static_cast<int>(scenario.site.tone_table_hz.size()));
  std::map<BeaconId, int> heard;
  while (const auto event = simulation.next()) {
    const auto* frame = std::get_if<RawIrFrame>(&event->data);
    if (!frame) continue;
    const auto announcement = decoder.decode(*frame);
    ASSERT_TRUE(announcement) << name(announcement.error());
    EXPECT_TRUE(announcement->is_signed);
    EXPECT_EQ(announcement->corrected_octets, 0);
    EXPECT_EQ(frame->levels.size(), 8u);
    for (const Beacon& beacon : scenario.site.beacons)
      if (beacon.id == announcement->beacon) {
        EXPECT_NEAR((beacon.position_map - announcement->position_map).norm(), 0, 0.001);
        EXPECT_EQ(beacon.tones, announcement->tones);
        EXPECT_NEAR(std::fmod(t(simulation, frame->stamp), 0.8), beacon.slot * 0.025, 2e-4);
        EXPECT_EQ(announcement->superframe, 1000u + static_cast<unsigned>(t(simulation, frame->stamp) / 0.8));
      }
    ++heard[announcement->beacon];
  }
  EXPECT_GE(heard.size(), 6u);
}

TEST(SimulationConsistency, BitErrorsAndJunkAreAsManyAsAsked) {
  Scenario scenario = small_drive();
  scenario.duration_s = 40;
  scenario.camera.rate_hz = 1;
  scenario.has_imu = scenario.has_odometry = false;
  scenario.ir.bit_error_rate = 0.003;
  scenario.ir.junk_rate_hz = 5;
  Simulation simulation(scenario);
  const IrFrameDecoder decoder(scenario.site.link, static_cast<int>(scenario.site.tone_table_hz.size()));
  double good = 0, bad = 0, corrected = 0;
  while (const auto event = simulation.next())
    if (const auto* frame = std::get_if<RawIrFrame>(&event->data)) {
      const auto announcement = decoder.decode(*frame);
      ++(announcement ? good : bad);
      if (announcement) corrected += announcement->corrected_octets;
    }
  EXPECT_NEAR(bad, 200, 50);                                               // 40 s of 5 Hz
  EXPECT_NEAR(corrected / good, 46 * (1 - std::pow(1 - 0.003, 8)), 0.15);  // octets hit in each frame
}

TEST(SimulationConsistency, DiodeLevelsPointAtTheirBeacon) {
  const Scenario scenario = small_drive();
  const IrReceiver receiver(scenario.ir, 1);
  RigidTransform T_map_base = RigidTransform::Identity();
  T_map_base.translation() << 10, 10, 0;
  const std::vector<float> overhead = receiver.levels({10.3, 10, 8}, {}, T_map_base);
  EXPECT_NEAR(overhead[0], 6 / std::pow(8 - 2.25, 2), 1e-6);
  for (int i = 1; i < 8; ++i)
    EXPECT_NEAR(overhead[static_cast<std::size_t>(i)], overhead[0] * std::cos(radians(50)), 1e-6);
  const std::vector<float> ahead = receiver.levels({16.3, 10, 8}, {}, T_map_base);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_LE(ahead[i], ahead[1]);  // diode 1 looks forward
}

TEST(SimulationConsistency, ToldAndTrueDifferByTheErrorsAlone) {
  Scenario scenario = small_drive();
  scenario.errors.mount_sigma_rad = 0.01;
  double square = 0, survey = 0;
  int n = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    scenario.seed = seed;
    const Simulation simulation(scenario);
    square +=
        so3_log(scenario.T_base_camera.linear().transpose() * simulation.true_T_base_camera().linear()).squaredNorm();
    for (std::size_t i = 0; i < scenario.site.beacons.size(); ++i, ++n)
      survey += (scenario.site.beacons[i].position_map - simulation.true_beacons()[i].position_map).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(square / 40 / 3), 0.01, 0.002);
  EXPECT_NEAR(std::sqrt(survey / n / 3), scenario.errors.survey_sigma_m, 0.001);
  const Simulation simulation(ideal(scenario));
  EXPECT_EQ(simulation.true_T_base_camera().matrix(), scenario.T_base_camera.matrix());
  EXPECT_EQ(simulation.true_camera().intrinsics().fx_px, scenario.camera.intrinsics.fx_px);
}

}  // namespace
}  // namespace lodestar::sim
