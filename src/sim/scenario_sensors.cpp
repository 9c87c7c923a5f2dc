#include "lodestar/base/common/angle.hpp"
#include "scenario_sections.hpp"

namespace lodestar::sim {
namespace {

const std::vector<YamlKey> kCameraKeys = {{"width_px", true},
                                          {"height_px", true},
                                          {"distortion", false},
                                          {"fx_px", true},
                                          {"fy_px", true},
                                          {"cx_px", true},
                                          {"cy_px", true},
                                          {"coefficients", false},
                                          {"mount", true},
                                          {"rate_hz", true},
                                          {"exposure_s", false},
                                          {"bits", false},
                                          {"psf_sigma_px", false},
                                          {"ambient_e", false},
                                          {"read_noise_e", false},
                                          {"full_well_e", false},
                                          {"gain_dn_per_e", false},
                                          {"black_level_dn", false},
                                          {"falloff_exponent", false},
                                          {"half_field_deg", false},
                                          {"jitter_s", false},
                                          {"stamp_noise_s", false},
                                          {"clock_drift_ppm", false},
                                          {"drop_probability", false},
                                          {"latency_s", false},
                                          {"masts", false}};
const std::vector<YamlKey> kMastKeys = {{"azimuth_deg", true}, {"off_axis_from_deg", false}};
const std::vector<YamlKey> kIrKeys = {
    {"enabled", false},        {"mount", false},          {"diodes", false},
    {"tilt_deg", false},       {"half_angle_deg", false}, {"response_exponent", false},
    {"level_1m", false},       {"min_level", false},      {"level_noise", false},
    {"bit_error_rate", false}, {"junk_rate_hz", false},   {"stamp_noise_s", false},
    {"samples", false},        {"sample_noise", false}};
const std::vector<YamlKey> kImuKeys = {{"enabled", false},
                                       {"mount", false},
                                       {"rate_hz", false},
                                       {"gyro_noise_deg_s", false},
                                       {"gyro_bias_deg_s", false},
                                       {"gyro_bias_walk_deg_s_sqrt_s", false},
                                       {"accelerometer_noise_m_s2", false},
                                       {"accelerometer_bias_m_s2", false},
                                       {"accelerometer_bias_walk_m_s2_sqrt_s", false}};
const std::vector<YamlKey> kOdometryKeys = {{"enabled", false},
                                            {"rate_hz", false},
                                            {"scale_error", false},
                                            {"yaw_scale_error", false},
                                            {"slip_per_m_s2", false},
                                            {"slip_every_s", false},
                                            {"slip_for_s", false},
                                            {"slip_sigma", false},
                                            {"velocity_noise_m_s", false},
                                            {"yaw_rate_noise_deg_s", false}};

const std::vector<YamlKey> kLoadKeys = {{"mount", false},          {"rate_hz", false},
                                        {"height_sigma_m", false}, {"seat_sigma_m", false},
                                        {"seat_sigma_deg", false}, {"label_probability", false}};
const std::vector<YamlKey> kFixKeys = {{"rate_hz", false},   {"position_sigma_m", false},    {"yaw_sigma_deg", false},
                                       {"latency_s", false}, {"outlier_probability", false}, {"outlier_m", false},
                                       {"blackouts", false}};
const std::vector<YamlKey> kBlackoutKeys = {{"from_s", true}, {"to_s", true}};

struct Lens {
  const char* name;
  CameraIntrinsics::Distortion distortion;
  std::size_t coefficients;
};
constexpr Lens kLenses[] = {{"equidistant", CameraIntrinsics::Distortion::kEquidistant, 4},
                            {"plumb_bob", CameraIntrinsics::Distortion::kPlumbBob, 5},
                            {"rational_polynomial", CameraIntrinsics::Distortion::kRationalPolynomial, 8}};

void read_lens(const Section& section, CameraIntrinsics& intrinsics) {
  section.integer("width_px", within(16, 10000), intrinsics.width_px);
  section.integer("height_px", within(16, 10000), intrinsics.height_px);
  section.number("fx_px", above(0, 1e5), intrinsics.fx_px);
  section.number("fy_px", above(0, 1e5), intrinsics.fy_px);
  section.number("cx_px", within(-1e4, 1e4), intrinsics.cx_px);
  section.number("cy_px", within(-1e4, 1e4), intrinsics.cy_px);

  const std::string name = section.map().text("distortion").value_or(kLenses[0].name);
  const Lens* lens = nullptr;
  for (const Lens& candidate : kLenses)
    if (name == candidate.name) lens = &candidate;
  if (!lens) {
    section.map().fault("distortion", "is " + quote(name) + ": give equidistant, plumb_bob or rational_polynomial");
    return;
  }
  intrinsics.distortion = lens->distortion;
  if (const auto k = section.map().numbers("coefficients", lens->coefficients, lens->coefficients, within(-1e3, 1e3)))
    for (std::size_t i = 0; i < k->size(); ++i) intrinsics.coefficients[i] = (*k)[i].value;
}

void read_masts(const Section& section, CameraParams& camera) {
  section.each("masts", kMastKeys, [&](const Section& item) {
    Mast mast;
    Eigen::Vector2d azimuth_deg = Eigen::Vector2d::Zero();
    if (item.vector("azimuth_deg", azimuth_deg) && azimuth_deg.y() <= azimuth_deg.x())
      item.map().fault("azimuth_deg", "ends before it begins: give [from, to], as [170, 190]");
    mast.azimuth_from_rad = radians(azimuth_deg.x());
    mast.azimuth_to_rad = radians(azimuth_deg.y());
    item.degrees("off_axis_from_deg", within(0, 180), mast.off_axis_from_rad);
    camera.masts.push_back(mast);
  });
}

void read_camera(const Section& section, Scenario& scenario) {
  CameraParams& camera = scenario.camera;
  read_lens(section, camera.intrinsics);
  section.mount("mount", scenario.T_base_camera);
  section.number("rate_hz", within(1, 1000), camera.rate_hz);
  section.number("exposure_s", within(1e-6, 1), camera.exposure_s);
  section.integer("bits", within(8, 16), camera.bits);
  if (camera.bits != 8 && camera.bits != 16) section.map().fault("bits", "is neither: give 8 or 16");
  section.number("psf_sigma_px", within(0.2, 10), camera.psf_sigma_px);
  section.number("ambient_e", within(0, 1e6), camera.ambient_e);
  section.number("read_noise_e", within(0, 1e4), camera.read_noise_e);
  section.number("full_well_e", within(100, 1e9), camera.full_well_e);
  section.number("gain_dn_per_e", within(1e-6, 1e3), camera.gain_dn_per_e);
  section.number("black_level_dn", within(0, 65535), camera.black_level_dn);
  section.number("falloff_exponent", within(0, 10), camera.falloff_exponent);
  section.degrees("half_field_deg", within(1, 120), camera.half_field_rad);
  section.number("jitter_s", within(0, 0.01), camera.jitter_s);
  section.number("stamp_noise_s", within(0, 0.01), camera.stamp_noise_s);
  section.number("clock_drift_ppm", within(-10000, 10000), camera.clock_drift_ppm);
  section.number("drop_probability", within(0, 1), camera.drop_probability);
  section.number("latency_s", within(0, 1), camera.latency_s);
  read_masts(section, camera);

  if (camera.exposure_s * camera.rate_hz > 1)
    section.map().fault(section.map().has("exposure_s") ? "exposure_s" : "rate_hz",
                        "does not fit: an exposure of " + print(camera.exposure_s) + " s is longer than a frame at " +
                            print(camera.rate_hz) + " Hz");
  if (section.faults().empty())
    if (const auto model = CameraModel::create(camera.intrinsics); !model)
      section.faults().add(section.map().line(), "camera: " + model.error());
}

void read_ir(const Section& section, Scenario& scenario) {
  IrReceiverParams& ir = scenario.ir;
  section.flag("enabled", scenario.has_ir);
  section.mount("mount", ir.T_base_ir);
  section.integer("diodes", within(2, 64), ir.diodes);
  section.degrees("tilt_deg", within(0, 90), ir.tilt_rad);
  section.degrees("half_angle_deg", within(1, 90), ir.half_angle_rad);
  section.number("response_exponent", within(0, 20), ir.response_exponent);
  section.number("level_1m", above(0, 1e6), ir.level_1m);
  section.number("min_level", within(0, 1), ir.min_level);
  section.number("level_noise", within(0, 1), ir.level_noise);
  section.number("bit_error_rate", within(0, 0.5), ir.bit_error_rate);
  section.number("junk_rate_hz", within(0, 1000), ir.junk_rate_hz);
  section.number("stamp_noise_s", within(0, 0.001), ir.stamp_noise_s);
  section.flag("samples", scenario.ir_samples);
  section.number("sample_noise", within(0, 1), ir.sample_noise);
}

void read_imu(const Section& section, Scenario& scenario) {
  ImuParams& imu = scenario.imu;
  section.flag("enabled", scenario.has_imu);
  section.mount("mount", imu.T_base_imu);
  section.number("rate_hz", within(1, 2000), imu.rate_hz);
  section.degrees("gyro_noise_deg_s", within(0, 50), imu.gyro_noise_rad_s);
  section.degrees("gyro_bias_deg_s", within(0, 50), imu.gyro_bias_rad_s);
  section.degrees("gyro_bias_walk_deg_s_sqrt_s", within(0, 10), imu.gyro_bias_walk_rad_s_sqrt_s);
  section.number("accelerometer_noise_m_s2", within(0, 10), imu.accelerometer_noise_m_s2);
  section.number("accelerometer_bias_m_s2", within(0, 10), imu.accelerometer_bias_m_s2);
  section.number("accelerometer_bias_walk_m_s2_sqrt_s", within(0, 10), imu.accelerometer_bias_walk_m_s2_sqrt_s);
}

void read_odometry(const Section& section, Scenario& scenario) {
  WheelOdometryParams& odometry = scenario.odometry;
  section.flag("enabled", scenario.has_odometry);
  section.number("rate_hz", within(1, 1000), odometry.rate_hz);
  section.number("scale_error", within(-0.5, 0.5), odometry.scale_error);
  section.number("yaw_scale_error", within(-0.5, 0.5), odometry.yaw_scale_error);
  section.number("slip_per_m_s2", within(-0.5, 0.5), odometry.slip_per_m_s2);
  section.number("slip_every_s", within(0, 1e6), odometry.slip_every_s);
  section.number("slip_for_s", within(0, 100), odometry.slip_for_s);
  section.number("slip_sigma", within(0, 2), odometry.slip_sigma);
  section.number("velocity_noise_m_s", within(0, 5), odometry.velocity_noise_m_s);
  section.degrees("yaw_rate_noise_deg_s", within(0, 50), odometry.yaw_rate_noise_rad_s);
}

void read_fixes(const Section& section, Scenario& scenario) {
  FixSensorParams fixes;
  section.number("rate_hz", above(0, 1000), fixes.rate_hz);
  section.number("position_sigma_m", above(0, 100), fixes.position_sigma_m);
  section.degrees("yaw_sigma_deg", above(0, 180), fixes.yaw_sigma_rad);
  if (const auto latency = section.map().numbers("latency_s", 2, 2, within(0, 10))) {
    fixes.latency_from_s = (*latency)[0].value;
    fixes.latency_to_s = (*latency)[1].value;
    if (fixes.latency_to_s < fixes.latency_from_s)
      section.map().fault("latency_s", "ends before it begins: give [from, to], as [0.15, 0.3]");
  }
  section.number("outlier_probability", within(0, 1), fixes.outlier_probability);
  section.number("outlier_m", within(0, 1e4), fixes.outlier_m);
  section.each("blackouts", kBlackoutKeys, [&](const Section& item) {
    FixSensorParams::Blackout blackout;
    item.number("from_s", within(0, 1e7), blackout.from_s);
    item.number("to_s", within(0, 1e7), blackout.to_s);
    fixes.blackouts.push_back(blackout);
  });
  scenario.fixes = fixes;
}

void read_loads(const Section& section, Scenario& scenario) {
  LoadParams& loads = scenario.loads.emplace();
  section.mount("mount", scenario.T_base_fork);
  section.number("rate_hz", within(2, 1000), loads.rate_hz);
  section.number("height_sigma_m", within(0, 1), loads.height_sigma_m);
  section.number("seat_sigma_m", within(0, 1), loads.seat_sigma_m);
  section.degrees("seat_sigma_deg", within(0, 45), loads.seat_sigma_rad);
  section.number("label_probability", within(0, 1), loads.label_probability);
}

}  // namespace

void read_sensors(const Section& file, Scenario& scenario) {
  scenario.has_camera = file.map().has("camera");
  if (scenario.has_camera) read_camera(file.section("camera", kCameraKeys), scenario);
  if (file.map().has("fixes")) read_fixes(file.section("fixes", kFixKeys), scenario);
  if (!scenario.has_camera && !scenario.fixes)
    file.faults().add(file.map().line(), "there is neither camera nor fixes: give at least one of them");
  read_ir(file.section("ir", kIrKeys), scenario);
  read_imu(file.section("imu", kImuKeys), scenario);
  read_odometry(file.section("odometry", kOdometryKeys), scenario);
  if (file.map().has("loads")) read_loads(file.section("loads", kLoadKeys), scenario);
}

}  // namespace lodestar::sim
