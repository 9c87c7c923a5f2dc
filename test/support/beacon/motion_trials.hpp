#pragma once

#include <optional>
#include <string>

#include "support/beacon/grid.hpp"

namespace lodestar::test {

/// A camera that moves under beacons, and what it is told of its motion.
struct MotionCase {
  enum class Path {
    kLinear,   ///< straight on under a ceiling, lens without distortion: the whole image moves alike
    kYaw,      ///< turning on the spot, beacons 70 deg off the axis of a fisheye
    kHandHeld  ///< swaying about all axes, a fisheye
  };
  Path path = Path::kLinear;
  double speed = 0;           ///< px a frame (hand-held: at its fastest); kYaw: rad/s
  bool motion_input = true;   ///< gyro and odometry at 100 Hz, with noise and 1 % scale error; else a camera alone
  bool square = false;        ///< on-off beacons of one tone; else two never-dark tones
  double jitter = 0;          ///< of the frame's instant, a share of the period; the stamp is right
  double loss = 0;            ///< share of frames lost at random
  int lost_in_a_row = 0;      ///< frames lost together, once in 40
  double stamp_offset_s = 0;  ///< of all frames' stamps
  double dimmest = 100, brightest = 1000;  ///< grey levels in all, 8 bits
};

/// What became of the windows: one for each frame and each beacon that has been in view for N + 5 frames.
struct MotionTally {
  long windows = 0, right = 0;
  long wrong = 0;   ///< sightings at a beacon with another code than its own
  long ghosts = 0;  ///< sightings where no beacon is
  double square_px2 = 0;
  double rms_px() const { return std::sqrt(square_px2 / static_cast<double>(2 * right)); }  ///< each axis
  double identified() const { return static_cast<double>(right) / static_cast<double>(windows); }
};

/// One run of a moving camera.
class MotionRun {
 public:
  MotionRun(const MotionCase& what, unsigned seed) : case_(what), scene_(vga_scene(seed)), random_(scene_.random()) {
    scene_.electrons_per_level = 20;
    scene_.exposure_s = 0.002;
    lens_ = case_.path == MotionCase::Path::kLinear ? pinhole(640, 480, kPinhole_px) : fisheye(640, 480, kFisheye_px);
    camera_ = CameraModel::create(lens_).value();
    heading_rad_ = random_.uniform(-0.2, 0.2);
    for (double& phase : sway_phase_rad_) phase = random_.uniform(-kPi, kPi);
    if (case_.path == MotionCase::Path::kLinear) {
      hang_beacons_along_the_track();
    } else {
      hang_beacons_around();
    }
  }

  void run(int frames, MotionTally& tally) {
    BeaconDetectorParams params = plan_params();
    BeaconDetector detector = detector_for(scene_, params, lens_);
    detector.set_plane_height(kHeight_m);
    CameraMotion motion;
    double told_until_s = -1.0;
    for (int i = 0; i < frames; ++i) {
      if (random_.uniform(0, 1) < case_.loss || i % 40 < case_.lost_in_a_row) continue;
      const double t = (i + case_.jitter * random_.uniform(-1, 1)) / kPlanRate_hz;
      for (; case_.motion_input && told_until_s < t; told_until_s += 0.01) tell(told_until_s, motion);
      Image image = scene_.render(t);
      image.stamp += from_seconds(case_.stamp_offset_s);
      score(detect(detector, image, motion), t, static_cast<std::size_t>(params.window_frames + 5), tally);
    }
  }

 private:
  static constexpr double kPinhole_px = 400, kFisheye_px = 230, kHeight_m = 4, kGyroNoise_rad_s = 0.002,
                          kWheelNoise_m_s = 0.01, kWheelScale = 1.01;

  struct Hung {
    Eigen::Vector3d place_map;
    ToneSet code;
    std::size_t age_frames = 0;  ///< since it came into view
  };

  double speed_m_s() const { return case_.speed * kHeight_m / kPinhole_px * kPlanRate_hz; }
  Eigen::Vector3d along() const { return {std::cos(heading_rad_), std::sin(heading_rad_), 0}; }

  RigidTransform T_map_camera(double t) const {
    RigidTransform T = RigidTransform::Identity();
    if (case_.path == MotionCase::Path::kLinear) T.translation() = speed_m_s() * t * along();
    if (case_.path == MotionCase::Path::kYaw) T.linear() = so3_exp({0, 0, case_.speed * t});
    if (case_.path == MotionCase::Path::kHandHeld) {
      // Three axes, each a slow sway; together at most `speed` px a frame near the axis.
      Eigen::Vector3d turn;
      for (int axis = 0; axis < 3; ++axis) {
        const double omega = 2 * kPi * (0.6 + 0.25 * axis);
        turn[axis] =
            0.6 * case_.speed / kFisheye_px * kPlanRate_hz / omega * std::sin(omega * t + sway_phase_rad_[axis]);
      }
      T.linear() = so3_exp(turn);
    }
    return T;
  }

  Eigen::Vector2d pixel(const Eigen::Vector3d& place_map, double t) const {
    const auto projection = camera_->project(T_map_camera(t).inverse() * place_map);
    return projection ? projection->pixel : Eigen::Vector2d::Constant(-1e9);
  }

  void hang(const Eigen::Vector3d& place_map) {
    static const std::vector<ToneSet> pairs = {{0, 2}, {1, 4}, {3, 5}, {4, 6}, {0, 7}, {1, 2},
                                               {3, 7}, {5, 6}, {0, 4}, {1, 7}, {2, 3}, {4, 5}};
    const std::size_t i = beacons_.size();
    const ToneSet code = case_.square ? ToneSet{static_cast<int>(i % kPlanTones_hz.size())} : pairs[i % pairs.size()];
    std::vector<double> tones_hz;
    for (const int tone : code.indices()) tones_hz.push_back(kPlanTones_hz[static_cast<std::size_t>(tone)]);
    beacons_.push_back({place_map, code});
    const double light = random_.log_uniform(case_.dimmest, case_.brightest);
    scene_.lights.push_back(
        {[this, place_map](double t) { return pixel(place_map, t); }, beacon(random_, light, tones_hz, case_.square)});
  }

  /// Three rows, 1.6 m apart (160 px), heights within 5 % of what the detector is told.
  void hang_beacons_along_the_track() {
    const Eigen::Vector3d across(-along().y(), along().x(), 0);
    const int columns = 8 + static_cast<int>(speed_m_s() * 3 / 1.6);
    for (int column = -4; column < columns; ++column) {
      for (int row = -1; row <= 1; ++row) {
        hang(along() * (1.6 * column + random_.uniform(-0.2, 0.2)) + across * (1.4 * row + random_.uniform(-0.2, 0.2)) +
             Eigen::Vector3d(0, 0, kHeight_m * random_.uniform(0.95, 1.05)));
      }
    }
  }

  /// A ring of eight, 70 deg off axis; hand-held: at any angle up to that.
  void hang_beacons_around() {
    for (int i = 0; i < 8; ++i) {
      const double azimuth_rad = 2 * kPi * (i + random_.uniform(-0.2, 0.2)) / 8;
      const double off_axis_rad = case_.path == MotionCase::Path::kYaw ? radians(70) : radians(random_.uniform(15, 50));
      hang(kHeight_m * Eigen::Vector3d(std::tan(off_axis_rad) * std::cos(azimuth_rad),
                                       std::tan(off_axis_rad) * std::sin(azimuth_rad), 1));
    }
  }

  void tell(double t, CameraMotion& motion) {
    const Stamp stamp = Stamp{} + std::chrono::seconds(1000) + from_seconds(t);
    const double yaw_rate = case_.path == MotionCase::Path::kYaw ? case_.speed : 0;
    const double speed = case_.path == MotionCase::Path::kLinear ? speed_m_s() : 0;
    ImuSample imu{stamp, Eigen::Vector3d(0, 0, yaw_rate), Eigen::Vector3d(0, 0, 9.81)};
    for (int axis = 0; axis < 3; ++axis) imu.angular_velocity_rad_s[axis] += kGyroNoise_rad_s * random_.normal();
    motion.add_imu(imu);
    OdometrySample odometry;
    odometry.stamp = stamp;
    odometry.velocity_m_s = (kWheelScale * speed + kWheelNoise_m_s * random_.normal()) * along().head<2>();
    odometry.yaw_rate_rad_s = kWheelScale * yaw_rate;
    motion.add_odometry(odometry);
  }

  void score(const std::vector<Sighting>& sightings, double t, std::size_t least_age, MotionTally& tally) {
    constexpr double kReach_px = 5, kMargin_px = 8;
    std::vector<const Hung*> seen(sightings.size(), nullptr);
    for (Hung& hung : beacons_) {
      const Eigen::Vector2d place = pixel(hung.place_map, t);
      const Sighting* sighting = nearest(sightings, place, kReach_px);
      if (sighting) seen[static_cast<std::size_t>(sighting - sightings.data())] = &hung;
      const bool in_view = place.x() >= kMargin_px && place.x() <= scene_.width_px - 1 - kMargin_px &&
                           place.y() >= kMargin_px && place.y() <= scene_.height_px - 1 - kMargin_px;
      hung.age_frames = in_view ? hung.age_frames + 1 : 0;
      if (hung.age_frames < least_age) continue;
      ++tally.windows;
      if (!sighting || sighting->tones != hung.code) continue;
      ++tally.right;
      tally.square_px2 += (sighting->pixel - place).squaredNorm();
    }
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (!seen[i]) ++tally.ghosts;
      if (seen[i] && seen[i]->code != sightings[i].tones) ++tally.wrong;
    }
  }

  MotionCase case_;
  BlobScene scene_;
  Noise random_;
  CameraIntrinsics lens_;
  std::shared_ptr<const CameraModel> camera_;
  double heading_rad_ = 0;
  std::array<double, 3> sway_phase_rad_{};
  std::vector<Hung> beacons_;
};

/// Runs under ever new beacons until there are as many windows.
inline MotionTally motion_windows(const MotionCase& what, long windows, unsigned seed) {
  const int frames = what.path == MotionCase::Path::kLinear && what.speed < 8 ? 75 : 150;
  MotionTally tally;
  for (unsigned run = 0; tally.windows < windows; ++run) MotionRun(what, 1000 * seed + run).run(frames, tally);
  return tally;
}

inline std::string spelled(const ToneSet& code) {
  std::string text;
  for (const int tone : code.indices())
    text += std::to_string(static_cast<int>(kPlanTones_hz[static_cast<std::size_t>(tone)])) + " ";
  return text;
}

/// One beacon that is switched on, hidden at any instant of its waveform for a while, and shown again.
struct DarkAndHidden {
  double speed_px = 0;  ///< a frame
  bool motion_input = true;
  int hidden_frames = 10;
  double light = 300;
  ToneSet own = {1, 4};
  ToneSet back = own;   ///< the code of what comes back: another beacon, perhaps
  bool square = false;  ///< on-off, one tone

  std::optional<int> frames_until_seen, frames_until_back;
  int last_ghost_frame = 0;  ///< the last frame after the hiding in which it is still reported; 0: none
  int gaps = 0;              ///< frames between, in view, without a sighting
  int early_gaps = 0;        ///< ... while the window still holds frames from before it was switched on
  int wrong = 0;

  void run(unsigned seed) {
    constexpr int kOn = 40;
    constexpr double kFocal_px = 400, kHeight_m = 4;
    BlobScene scene(seed);
    const int hidden = kOn + 60 + static_cast<int>(scene.random().uniform(0, 30)), shown = hidden + hidden_frames;
    scene.width_px = 640;
    scene.height_px = 100;
    scene.electrons_per_level = 20;
    const double row = scene.random().uniform(30, 70);
    const double speed_px_s = speed_px * kPlanRate_hz;
    const auto place = [=](double t) { return Eigen::Vector2d(600 - speed_px_s * t, row); };
    const auto light_of = [&](const ToneSet& code) {
      std::vector<double> tones_hz;
      for (const int tone : code.indices()) tones_hz.push_back(kPlanTones_hz[static_cast<std::size_t>(tone)]);
      return beacon(scene.random(), light, tones_hz, square);
    };
    const auto light_on = light_of(own);
    const auto light_back = back == own ? light_on : light_of(back);
    scene.lights = {{place, [&](double t) {
                       const auto frame = static_cast<int>(std::lround(t * kPlanRate_hz));
                       if (frame < kOn || (frame >= hidden && frame < shown)) return 0.0;
                       return frame < shown ? light_on(t) : light_back(t);
                     }}};
    const BeaconDetectorParams params = plan_params();
    BeaconDetector detector = detector_for(scene, params, pinhole(scene.width_px, scene.height_px, kFocal_px));
    detector.set_plane_height(kHeight_m);
    CameraMotion motion;
    for (int i = 0; i < shown + 90; ++i) {
      const double t = i / kPlanRate_hz;
      const Image image = scene.render(t);
      if (motion_input) {
        motion.add_odometry({image.stamp, {speed_px_s * kHeight_m / kFocal_px, 0}, 0, Eigen::Vector3d::Zero(), 0});
      }
      const auto sightings = detect(detector, image, motion);
      const bool seen = nearest(sightings, place(t), 4);
      for (const Sighting& sighting : sightings) wrong += sighting.tones != (i < shown ? own : back);
      if (i < hidden) {
        if (seen && !frames_until_seen) frames_until_seen = i - kOn + 1;
        (i < kOn + params.window_frames ? early_gaps : gaps) += !seen && frames_until_seen;
      } else if (i < shown) {
        if (!sightings.empty()) last_ghost_frame = i - hidden + 1;
      } else {
        if (seen && !frames_until_back) frames_until_back = i - shown + 1;
        gaps += !seen && frames_until_back;
      }
    }
  }
};

}  // namespace lodestar::test
