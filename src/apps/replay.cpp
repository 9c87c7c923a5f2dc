// replay: the optical line over a recording, with the same core objects as the nodelets.

#include <algorithm>
#include <chrono>
#include <deque>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/estimate_writer.hpp"
#include "cli/progress_bar.hpp"
#include "lodestar/line/frame_rate.hpp"
#include "lodestar/line/localization_line.hpp"
#include "lodestar/line/time_jump.hpp"
#include "lodestar/ros/bag/recording.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "replay - run the localization over a recorded bag, without a roscore and faster than real time\n"
    "\n"
    "Usage: replay --site S.yaml --bag IN.bag --out EST.csv [--vehicle V.yaml] [--out-bag OUT.bag]\n"
    "\n"
    "Examples:\n"
    "  replay --site config/site_hall.yaml --bag drive.bag --out drive.csv\n"
    "  replay --site hall.yaml --bag drive.bag --out drive.csv --vehicle truck.yaml --out-bag result.bag\n"
    "  evaluate --truth drive.bag --estimate drive.csv --plot drive.png\n"
    "\n"
    "EST.csv gets one row for each camera frame after start-up, from data received by then alone.\n";

/// The camera's rate from the stamps of its first frames; the records that were read for it are kept.
struct Opening {
  std::deque<Record> records;
  std::optional<double> frame_rate_hz;
};

Opening read_opening(RecordingReader& reader) {
  Opening opening;
  FrameRateEstimate rate;
  while (!opening.frame_rate_hz) {
    auto record = reader.next();
    if (!record) break;
    if (const auto* image = std::get_if<Image>(&record->content)) opening.frame_rate_hz = rate.add(image->stamp);
    opening.records.push_back(std::move(*record));
  }
  return opening;
}

/// What went through, for the summary at the end.
struct Tally {
  std::size_t frames = 0, sightings = 0, named = 0, fixes = 0, rows = 0, resets = 0, time_steps = 0;
};

/// Feeds the line with records and writes down what it says.
class Replay {
 public:
  Replay(LocalizationLine& line, const CameraMount& mount, const std::string& map_frame, EstimateWriter& csv,
         RecordingWriter* out_bag)
      : line_(line), mount_(mount), map_frame_(map_frame), csv_(csv), out_bag_(out_bag) {}

  void feed(const Record& record) {
    received_ = record.received;
    std::visit(
        [this](const auto& content) {
          if (admit(content)) take(content);
        },
        record.content);
  }

  const Tally& tally() const { return tally_; }

 private:
  /// The same rule on time as the nodelets': one bad stamp is dropped, time that goes back starts the line anew.
  template <class Content>
  bool admit(const Content& content) {
    const TimeVerdict verdict = jump_.check(content.stamp, received_);
    if (verdict == TimeVerdict::kReset) line_.reset();
    tally_.resets += verdict == TimeVerdict::kReset;
    tally_.time_steps += verdict == TimeVerdict::kDrop;
    return verdict != TimeVerdict::kDrop;
  }
  bool admit(const CameraIntrinsics&) { return true; }

  void take(const CameraIntrinsics& intrinsics) {
    auto model = CameraModel::create(intrinsics);
    if (!model) throw UserError("camera_info: " + model.error());
    mount_.model = std::move(model).value();
    line_.set_camera(mount_);
  }
  void take(const ImuSample& sample) { line_.add_imu(sample); }
  void take(const OdometrySample& sample) {
    line_.add_odometry(sample);
    odometry_ = sample;
  }
  void take(const RawIrFrame& frame) {
    const auto announcement = line_.add_ir_frame(frame);
    if (announcement && out_bag_) out_bag_->write(received_, *announcement);
  }
  void take(const IrSampleBlock& samples) { line_.add_ir_samples(samples); }
  void take(const Image& image) {
    const auto outcome = line_.process(image);
    if (!outcome) return;
    ++tally_.frames;
    std::size_t named = 0;
    for (const Sighting& sighting : outcome->sightings.sightings) named += sighting.beacon.has_value();
    tally_.sightings += outcome->sightings.sightings.size();
    tally_.named += named;
    tally_.fixes += outcome->fix.has_value();
    if (outcome->estimate) {
      csv_.add(*outcome->estimate, named, line_.fusion().filter().mode());
      ++tally_.rows;
    }
    if (out_bag_) write(*outcome);
  }
  void take(const Fix&) {}
  void take(const TruthPose&) {}
  void take(const TruthCameraPose&) {}

  void write(const LocalizationLine::Outcome& outcome) {
    out_bag_->write(received_, outcome.sightings);
    if (outcome.fix) out_bag_->write(received_, *outcome.fix);
    if (!outcome.estimate) return;
    out_bag_->write(received_, *outcome.estimate);
    if (!odometry_) return;
    RigidTransform T_odom_base = RigidTransform::Identity();
    T_odom_base.linear() = rotation({0, 0, odometry_->yaw_odom_rad});
    T_odom_base.translation() = odometry_->position_odom_m;
    if (const auto then = line_.fusion().filter().estimate_at(odometry_->stamp)) {
      out_bag_->write(received_, map_frame_, "odom", odometry_->stamp, then->T_map_base * T_odom_base.inverse());
    }
  }

  LocalizationLine& line_;
  CameraMount mount_;
  std::string map_frame_;
  TimeJump jump_;
  EstimateWriter& csv_;
  RecordingWriter* out_bag_;
  std::optional<OdometrySample> odometry_;
  Stamp received_;
  Tally tally_;
};

template <class Reason>
void print_drops(const char* what, const DropCounts<Reason>& drops) {
  if (drops.total() == 0) return;
  std::cerr << what << ":";
  drops.each([](const char* reason, std::uint64_t count) {
    if (count > 0) std::cerr << "  " << reason << " " << count;
  });
  std::cerr << "\n";
}

void print_summary(const Tally& tally, const LocalizationLine& line, const RecordingReader& reader, double wall_s) {
  const double recorded_s = seconds(reader.end() - reader.begin());
  std::cerr << std::fixed << std::setprecision(1) << tally.frames << " frames, " << tally.sightings << " sightings, "
            << tally.named << " named, " << tally.fixes << " fixes, " << tally.rows << " rows; " << recorded_s
            << " s recorded, " << wall_s << " s to replay (" << recorded_s / wall_s << " x real time)\n";
  if (tally.resets + tally.time_steps > 0) {
    std::cerr << "time went back " << tally.resets << " times, " << tally.time_steps << " bad stamps dropped\n";
  }
  print_drops("frames dropped", line.detection().drops());
  print_drops("IR frames dropped", line.beacon_table().drops());
  print_drops("no fix", line.pose().refusals());
  print_drops("not used by the filter", line.fusion().filter().drops());
  for (const auto& [where, count] : reader.drops()) {
    std::cerr << where.first << ": " << where.second << " " << count << "\n";
  }
}

int replay(const po::variables_map& options) {
  const auto started = std::chrono::steady_clock::now();
  const auto site_path = options["site"].as<std::string>();
  const Site site = value_or_throw(load_site(site_path));
  const Vehicle vehicle =
      options.count("vehicle") ? value_or_throw(load_vehicle(options["vehicle"].as<std::string>())) : Vehicle();

  RecordingReaderParams reading;
  reading.T_base_imu = vehicle.T_base_imu;
  reading.camera_time_offset_s = vehicle.camera_time_offset_s;
  const auto bag_path = options["bag"].as<std::string>();
  RecordingReader reader(bag_path, reading);

  CameraMount mount;
  if (const auto T_base_camera = vehicle.T_base_camera ? vehicle.T_base_camera : reader.T_base_camera()) {
    mount.T_base_camera = *T_base_camera;
  } else {
    throw UserError(bag_path + ": /tf_static holds no base_link -> camera_optical_frame; give the mount in --vehicle.");
  }

  Opening opening = read_opening(reader);
  const auto known_rate_hz = vehicle.camera_rate_hz ? vehicle.camera_rate_hz : opening.frame_rate_hz;
  if (!known_rate_hz) {
    throw UserError(bag_path + ": too few images on /camera/image_raw to tell the camera's rate (" +
                    std::to_string(FrameRateEstimate::kFrames) +
                    ", more where stamps tremble); give camera.rate_hz in --vehicle.");
  }
  const double rate_hz = *known_rate_hz;
  const Faults tones = check_tones(site, {rate_hz, vehicle.mains_hz, vehicle.window_frames}, site_path);
  if (!tones.empty()) throw UserError(describe(tones) + "Mend the file, then start again.");

  EstimateWriter csv(options["out"].as<std::string>());
  std::unique_ptr<RecordingWriter> out_bag;
  if (options.count("out-bag")) {
    RecordingWriterParams writing;
    writing.frames.map = site.frame_id;
    writing.tone_table_hz = site.tone_table_hz;
    out_bag = std::make_unique<RecordingWriter>(options["out-bag"].as<std::string>(), writing);
  }

  LocalizationLine line(site, line_params(site, vehicle, rate_hz));
  if (const auto T_base_imu = vehicle.T_base_imu ? vehicle.T_base_imu : reader.mount("imu_link")) {
    line.set_imu(T_base_imu->translation());
  }
  if (const auto T_base_ir = vehicle.T_base_ir ? vehicle.T_base_ir : reader.mount("ir_array"))
    line.set_ir_array(*T_base_ir);
  Replay replay(line, mount, site.frame_id, csv, out_bag.get());
  {
    ProgressBar bar("replay");
    // The calibration is received behind the image that it came with.
    const auto calibration = std::find_if(opening.records.begin(), opening.records.end(), [](const Record& record) {
      return std::holds_alternative<CameraIntrinsics>(record.content);
    });
    if (calibration != opening.records.end()) replay.feed(*calibration);
    for (const Record& record : opening.records) replay.feed(record);
    opening.records.clear();
    while (const auto record = reader.next()) {
      replay.feed(*record);
      bar.show(reader.progress());
    }
  }
  print_summary(replay.tally(), line, reader,
                std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count());
  if (replay.tally().frames == 0 && line.detection().drops()[FrameDrop::kNoCamera] > 0) {
    throw UserError(bag_path + ": no good /camera/camera_info came with the images, so nothing could be localized.");
  }
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("site", po::value<std::string>()->required(), "site file (YAML)")(
      "bag", po::value<std::string>()->required(), "recording to replay")("out", po::value<std::string>()->required(),
                                                                          "estimates, CSV")(
      "vehicle", po::value<std::string>(), "vehicle file (YAML); without it mounts come from /tf_static")(
      "out-bag", po::value<std::string>(), "sightings, fixes, poses and tf as a bag");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::replay);
}
