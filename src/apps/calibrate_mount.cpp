// calibrate_mount: roll, pitch and yaw of the camera in base_link, from a drive with stands below known beacons.

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <variant>

#include "cli/command_line.hpp"
#include "cli/progress_bar.hpp"
#include "lodestar/base/common/angle.hpp"
#include "lodestar/calibration/mount_calibration.hpp"
#include "lodestar/line/frame_rate.hpp"
#include "lodestar/line/localization_line.hpp"
#include "lodestar/ros/bag/recording.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "calibrate_mount - roll, pitch and yaw of the camera in base_link, from a truck that stands, turns and stands "
    "again\n"
    "\n"
    "Usage: calibrate_mount --site S.yaml --bag IN.bag [--vehicle V.yaml] [--floor-sigma-deg 0.3] [--mount-sigma-m "
    "0.01]\n"
    "                       [--yaw-limit-deg 0.5]\n"
    "\n"
    "Examples:\n"
    "  calibrate_mount --site hall.yaml --bag turning.bag --vehicle truck.yaml\n"
    "  calibrate_mount --site hall.yaml --bag turning.bag --floor-sigma-deg 0.1 --mount-sigma-m 0.005\n"
    "\n"
    "Stand 5 s at each of 8 headings or more, all around, below at least three beacons; then drive 10 m straight on "
    "and\n"
    "stand again. docs/nodes/calibrate_mount.md has the rest.\n";

double within(const po::variables_map& options, const std::string& name, double least, double most) {
  const double value = options[name].as<double>();
  if (value >= least && value <= most) return value;
  char text[120];
  std::snprintf(text, sizeof text, "--%s is %g, it must be from %g to %g.", name.c_str(), value, least, most);
  throw UserError(text);
}

/// What the recording says of the camera before it is run through the line.
struct Camera {
  CameraMount mount;
  double rate_hz = 0;
};

Camera read_camera(const std::string& bag_path, const RecordingReaderParams& reading, const Vehicle& vehicle) {
  RecordingReader reader(bag_path, reading);
  Camera camera;
  const auto T_base_camera = vehicle.T_base_camera ? vehicle.T_base_camera : reader.T_base_camera();
  if (!T_base_camera)
    throw UserError(bag_path + ": /tf_static holds no base_link -> camera_optical_frame; give the mount in --vehicle.");
  camera.mount.T_base_camera = *T_base_camera;
  FrameRateEstimate rate;
  std::optional<double> rate_hz = vehicle.camera_rate_hz;
  while (!rate_hz || !camera.mount.model) {
    const auto record = reader.next();
    if (!record) throw UserError(bag_path + ": holds too few images, or no good /camera/camera_info.");
    if (const auto* image = std::get_if<Image>(&record->content); image != nullptr && !rate_hz)
      rate_hz = rate.add(image->stamp);
    if (const auto* intrinsics = std::get_if<CameraIntrinsics>(&record->content)) {
      auto model = CameraModel::create(*intrinsics);
      if (!model) throw UserError("camera_info: " + model.error());
      camera.mount.model = std::move(model).value();
    }
  }
  camera.rate_hz = *rate_hz;
  return camera;
}

/// The line's own detection and names, its sightings cut into stands.
class StandRun {
 public:
  StandRun(const Site& site, const LineParams& params, const Camera& camera, const StandParams& stands)
      : beacons_(site.beacons), camera_(camera.mount), line_(site, params), collector_(stands) {
    line_.set_camera(camera_);
  }
  void feed(const Record& record) {
    if (const auto* imu = std::get_if<ImuSample>(&record.content)) line_.add_imu(*imu);
    if (const auto* frame = std::get_if<RawIrFrame>(&record.content)) line_.add_ir_frame(*frame);
    if (const auto* image = std::get_if<Image>(&record.content)) take(*image);
    if (const auto* wheels = std::get_if<OdometrySample>(&record.content)) {
      line_.add_odometry(*wheels);
      collector_.add_odometry(*wheels);
    }
  }
  std::vector<Stand> stands() const { return collector_.stands(); }

 private:
  void take(const Image& image) {
    const auto outcome = line_.process(image);
    if (outcome) collector_.add_bearings(bearings(outcome->sightings, *camera_.model, beacons_, 0));
  }

  std::vector<Beacon> beacons_;
  CameraMount camera_;
  LocalizationLine line_;
  StandCollector collector_;
};

void print(const MountCalibration& found, const Eigen::Vector3d& position) {
  const RollPitchYaw &a = found.angles, &s = found.sigma;
  std::printf("stands     %d at %d places; chi2 %.1f with %d degrees of freedom\n", found.stands, found.places,
              found.chi2, found.degrees_of_freedom);
  std::printf("roll       %8.3f deg, one sigma %.3f\n", degrees(a.roll_rad), degrees(s.roll_rad));
  std::printf("pitch      %8.3f deg, one sigma %.3f\n", degrees(a.pitch_rad), degrees(s.pitch_rad));
  std::printf("yaw        %8.3f deg, one sigma %.3f\n", degrees(a.yaw_rad), degrees(s.yaw_rad));
  std::printf(
      "\nFor the vehicle file:\ncamera:\n  mount: {xyz_m: [%.4f, %.4f, %.4f], rpy_deg: [%.3f, %.3f, %.3f]}\n"
      "  mount_sigma_deg: %.3f # of roll and pitch, the larger\n",
      position.x(), position.y(), position.z(), degrees(a.roll_rad), degrees(a.pitch_rad), degrees(a.yaw_rad),
      degrees(std::max(s.roll_rad, s.pitch_rad)));
}

void warn_of_yaw(const MountCalibration& found, const MountCalibrationParams& params, double limit_rad) {
  const double leg_m = straight_leg_m(found, params, limit_rad);
  if (leg_m == 0) return;
  std::printf(
      "\nwarning    yaw: one sigma is %.2f deg, above the limit of %.2f; it comes from the way that the wheels went. "
      "Record "
      "again\n           with a straight leg of %.0f m between two stands, or allow more with --yaw-limit-deg\n",
      degrees(found.sigma.yaw_rad), degrees(limit_rad), std::ceil(leg_m));
}

int calibrate_mount_of(const po::variables_map& options) {
  MountCalibrationParams params;
  params.floor_sigma_rad = radians(within(options, "floor-sigma-deg", 0.001, 5));
  const double yaw_limit_rad = radians(within(options, "yaw-limit-deg", 0.3, 5));
  params.mount_sigma_m = within(options, "mount-sigma-m", 1e-4, 1);
  const auto site_path = options["site"].as<std::string>(), bag_path = options["bag"].as<std::string>();
  const Site site = value_or_throw(load_site(site_path));
  if (site.beacons.empty()) throw UserError(site_path + ": lists no beacon; the mount is found from surveyed ones.");
  Vehicle vehicle =
      options.count("vehicle") ? value_or_throw(load_vehicle(options["vehicle"].as<std::string>())) : Vehicle();
  RecordingReaderParams reading;
  reading.T_base_imu = vehicle.T_base_imu;
  reading.camera_time_offset_s = vehicle.camera_time_offset_s;
  const Camera camera = read_camera(bag_path, reading, vehicle);
  const Faults tones = check_tones(site, {camera.rate_hz, vehicle.mains_hz, vehicle.window_frames}, site_path);
  if (!tones.empty()) throw UserError(describe(tones) + "Mend the file, then start again.");

  constexpr double kUnknownMount_deg = 3;  // names must not fail by what is to be found
  vehicle.camera_mount_sigma_rad = radians(kUnknownMount_deg);
  const LineParams line = line_params(site, vehicle, camera.rate_hz);
  StandParams stands;
  stands.window_s = line.detector.window_frames / camera.rate_hz;
  stands.settle_s = 0.5 + stands.window_s;
  StandRun run(site, line, camera, stands);
  {
    RecordingReader reader(bag_path, reading);
    ProgressBar bar("calibrate_mount");
    while (const auto record = reader.next()) {
      run.feed(*record);
      bar.show(reader.progress());
    }
  }

  params.T_base_camera = camera.mount.T_base_camera;
  const CameraIntrinsics& lens = camera.mount.model->intrinsics();
  params.bearing_sigma_rad = vehicle.calibration_sigma_px / std::min(lens.fx_px, lens.fy_px);
  params.odometry_scale_sigma = vehicle.odometry_scale_sigma;
  const auto found = calibrate_mount(run.stands(), params);
  if (!found) throw UserError(bag_path + ": " + found.error() + ".");
  print(*found, camera.mount.T_base_camera.translation());
  warn_of_yaw(*found, params, yaw_limit_rad);
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("site", po::value<std::string>()->required(), "site file (YAML) with surveyed beacons")(
      "bag", po::value<std::string>()->required(), "recording with images, camera_info and /odom")(
      "vehicle", po::value<std::string>(),
      "vehicle file (YAML); its mount is the first guess, else that of /tf_static")(
      "floor-sigma-deg", po::value<double>()->default_value(0.3, "0.3"), "slope of the floor, one sigma")(
      "mount-sigma-m", po::value<double>()->default_value(0.01, "0.01"),
      "of the camera's position in base_link, one sigma")(
      "yaw-limit-deg", po::value<double>()->default_value(0.5, "0.5"), "of yaw's sigma: a warning above it");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::calibrate_mount_of);
}
