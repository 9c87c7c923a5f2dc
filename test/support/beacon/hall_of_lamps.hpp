#pragma once

#include <map>

#include "lodestar/estimation/naming/beacon_namer.hpp"
#include "support/beacon/grid.hpp"

namespace lodestar::test {

enum class Lamps {
  kSteady,
  kFlickering,     ///< with the mains, 2 to 100 % depth, sine or rectified
  kTubes,          ///< 1.5 m long, flickering
  kWarningLights,  ///< of trucks that come the other way, 1 to 3 Hz, on-off or turning
  kReflections,    ///< of lamps in ribbed cladding: they twinkle as the truck passes the ribs
  kSun,            ///< the same of the sun, which goes along with the truck
};
inline const std::map<Lamps, const char*> kAllLamps = {{Lamps::kSteady, "steady"},
                                                       {Lamps::kFlickering, "flickering"},
                                                       {Lamps::kTubes, "tubes"},
                                                       {Lamps::kWarningLights, "warning lights"},
                                                       {Lamps::kReflections, "reflections of lamps"},
                                                       {Lamps::kSun, "sun"}};

/// Drives under lamps of one kind. A straight aisle, the ceiling 6 m above the camera. Beacons of a planned site hang
/// among the lamps and are heard, but only one in four shines: those show that the line names at all, and each of the
/// others is a name that lies ready for a lamp.
struct HallOfLamps {
  Lamps lamps = Lamps::kSteady;
  double speed_m_s = 2;
  double mains_hz = 50;
  bool motion_input = true;

  long frames = 0, lamps_in_view = 0;
  long sightings = 0;    ///< of no beacon
  long named_alone = 0;  ///< ... that get a name without a receiver, where a site has every code of one to three tones
  std::map<ToneSet, long> codes;  ///< ... by code

  /// Names as the shipped line gives them.
  struct Names {
    long right = 0;
    long wrong = 0;  ///< of a beacon that is dark, or elsewhere
  };
  Names heard;    ///< no pose yet: of those whose announcement is heard
  Names located;  ///< once a pose is known

  /// Sightings in a code that plan_codes gives.
  long nameable() const {
    const std::vector<ToneSet> planned = planned_codes();
    long count = 0;
    for (const auto& [code, times] : codes)
      count += std::find(planned.begin(), planned.end(), code) != planned.end() ? times : 0;
    return count;
  }

  void run(double duration_s, unsigned seed) {
    BlobScene scene = vga_scene(seed);
    scene.electrons_per_level = 20;
    scene.exposure_s = 0.002;
    const auto lens = fisheye(640, 480, 230);
    const auto camera = CameraModel::create(lens).value();
    Noise& random = scene.random();
    const double turn_rad = random.uniform(0.02, 0.1), turn_hz = random.uniform(0.05, 0.3);
    const auto yaw_rad = [=](double t) { return turn_rad * std::sin(2 * kPi * turn_hz * t); };
    const Eigen::Vector2d nowhere = Eigen::Vector2d::Constant(-1e9);
    const auto place = [=](double t, const Eigen::Vector3d& place_map) -> Eigen::Vector2d {
      const Eigen::Vector3d ray(place_map.x() - speed_m_s * t, place_map.y(), place_map.z());
      const auto projection = camera->project(so3_exp({0, 0, -yaw_rad(t)}) * ray);
      return projection ? projection->pixel : nowhere;
    };
    const auto seen_from = [=](double t, const Eigen::Vector3d& place_map) {
      constexpr double kSight_m = 25;
      return std::abs(place_map.x() - speed_m_s * t) > kSight_m ? nowhere : place(t, place_map);
    };
    hang(speed_m_s * duration_s, seen_from, scene);
    const std::vector<Beacon> site = hang_beacons(speed_m_s * duration_s, seen_from, scene);

    BeaconDetector detector = detector_for(scene, plan_params(), lens);
    const std::vector<Beacon> every_code = one_of_each_code();
    BeaconNamerParams shipped;
    shipped.require_announcement = true;
    BeaconNamer alone({}), as_shipped(shipped);
    CameraMotion motion;
    const auto count = static_cast<long>(duration_s * kPlanRate_hz);
    for (long i = 0; i < count; ++i) {
      const double t = static_cast<double>(i) / kPlanRate_hz;
      const Image image = scene.render(t);
      if (motion_input) {
        const double yaw_rate = (yaw_rad(t + 1e-3) - yaw_rad(t - 1e-3)) / 2e-3;
        const Eigen::Vector2d velocity = speed_m_s * Eigen::Vector2d(std::cos(yaw_rad(t)), -std::sin(yaw_rad(t)));
        motion.add_odometry({image.stamp, velocity, yaw_rate, Eigen::Vector3d::Zero(), 0});
        motion.add_imu({image.stamp, {0, 0, yaw_rate}, {0, 0, 9.81}});
      }
      ++frames;
      Sightings seen;
      seen.stamp = image.stamp;
      seen.sightings = detect(detector, image, motion);
      const auto is_of = [&](const Sighting& sighting, const Beacon& beacon) {
        constexpr double kReach_px = 5;
        return shines(beacon) && sighting.tones == beacon.tones &&
               (sighting.pixel - place(t, beacon.position_map)).norm() < kReach_px;
      };
      const auto is_true = [&](const Sighting& sighting) {
        return std::any_of(site.begin(), site.end(), [&](const Beacon& beacon) { return is_of(sighting, beacon); });
      };
      for (const Sighting& sighting : seen.sightings) {
        if (is_true(sighting)) continue;
        ++sightings;
        ++codes[sighting.tones];
      }
      alone.name(seen, every_code, {}, {}, *camera, RigidTransform::Identity(), std::nullopt);
      for (const Sighting& sighting : seen.sightings) named_alone += sighting.beacon && !is_true(sighting);

      const auto tell = [&](const std::optional<PoseEstimate>& pose, Names& names) {
        as_shipped.name(seen, site, heard_at(speed_m_s * t, site), {}, *camera, RigidTransform::Identity(), pose);
        for (const Sighting& sighting : seen.sightings) {
          if (!sighting.beacon) continue;
          const bool right = is_of(sighting, site[sighting.beacon->value - 1]);
          (right ? names.right : names.wrong) += 1;
        }
      };
      tell(std::nullopt, heard);
      PoseEstimate pose;
      pose.T_map_base.translation().x() = speed_m_s * t;
      pose.T_map_base.linear() = so3_exp({0, 0, yaw_rad(t)});
      pose.covariance.diagonal() << 0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4;
      tell(pose, located);
      if (i % 60 == 0) {
        for (const Light& light : scene.lights) lamps_in_view += camera->contains(light.pixel(t)) ? 60 : 0;
      }
    }
  }

 private:
  using SeenFrom = std::function<Eigen::Vector2d(double, const Eigen::Vector3d&)>;

  /// Pairs, none a multiple of the other, nor its neighbour.
  static std::vector<ToneSet> planned_codes() {
    std::vector<ToneSet> codes;
    for (int a = 0; a < static_cast<int>(kPlanTones_hz.size()); ++a) {
      for (int b = a + 1; b < static_cast<int>(kPlanTones_hz.size()); ++b) {
        const double low_hz = kPlanTones_hz[static_cast<std::size_t>(a)];
        const double high_hz = kPlanTones_hz[static_cast<std::size_t>(b)];
        const double apart_hz = 1.5 * kPlanRate_hz / plan_params().window_frames;
        if (std::fmod(high_hz, low_hz) != 0 && high_hz - low_hz > apart_hz) codes.push_back({a, b});
      }
    }
    return codes;
  }

  static bool shines(const Beacon& beacon) { return beacon.id.value % 4 == 1; }

  /// Two rows, beacons 5.5 m apart; a code returns after 44 m, farther than a camera sees and a receiver hears together.
  static std::vector<Beacon> hang_beacons(double length_m, const SeenFrom& seen_from, BlobScene& scene) {
    Noise& random = scene.random();
    const std::vector<ToneSet> codes = planned_codes();
    std::vector<Beacon> beacons;
    for (double x = -14; x < length_m + 14; x += 5.5) {
      for (const double y : {-1.8, 1.8}) {
        Beacon beacon;
        beacon.id = BeaconId{static_cast<std::uint32_t>(beacons.size() + 1)};
        beacon.position_map = {x, y, 6};
        beacon.tones = codes[beacons.size() % codes.size()];
        beacons.push_back(beacon);
        if (!shines(beacon)) continue;
        std::vector<double> tones_hz;
        for (const int tone : beacon.tones.indices()) tones_hz.push_back(kPlanTones_hz[static_cast<std::size_t>(tone)]);
        const Eigen::Vector3d place_map = beacon.position_map;
        scene.lights.push_back({[=](double t) { return seen_from(t, place_map); },
                                test::beacon(random, random.log_uniform(200, 1000), tones_hz, false)});
      }
    }
    return beacons;
  }

  static std::vector<BeaconId> heard_at(double x, const std::vector<Beacon>& site) {
    constexpr double kEarshot_m = 15;
    std::vector<BeaconId> heard;
    for (const Beacon& beacon : site)
      if (std::abs(beacon.position_map.x() - x) < kEarshot_m) heard.push_back(beacon.id);
    return heard;
  }

  /// A site that uses every code of one to three tones, each once.
  static std::vector<Beacon> one_of_each_code() {
    std::vector<Beacon> beacons;
    const auto tones = static_cast<int>(kPlanTones_hz.size());
    const auto add = [&](ToneSet code) {
      Beacon beacon;
      beacon.id = BeaconId{static_cast<std::uint32_t>(beacons.size() + 1)};
      beacon.tones = code;
      beacons.push_back(beacon);
    };
    for (int a = 0; a < tones; ++a) {
      add({a});
      for (int b = a + 1; b < tones; ++b) {
        add({a, b});
        for (int c = b + 1; c < tones; ++c) add({a, b, c});
      }
    }
    return beacons;
  }

  std::function<double(double)> mains_flicker(double mean, double depth, Noise& random) const {
    const double hz = 2 * mains_hz * (1 + random.uniform(-0.002, 0.002)), phase = random.uniform(0, 1);
    const bool rectified = random.uniform(0, 1) < 0.3;
    return [=](double t) {
      const double wave = rectified ? 2.27 * std::pow(std::abs(std::sin(kPi * (hz * t + phase))), 3) - 0.96
                                    : std::cos(2 * kPi * (hz * t + phase));
      return mean * std::max(0.0, 1 + depth * wave);
    };
  }

  void hang(double length_m, const SeenFrom& seen_from, BlobScene& scene) const {
    Noise& random = scene.random();
    if (lamps == Lamps::kWarningLights) {
      for (double x = 0; x < 2 * length_m + 20; x += 5) meet_truck(x, seen_from, scene);
    } else if (lamps == Lamps::kReflections || lamps == Lamps::kSun) {
      const double end_m = lamps == Lamps::kSun ? 10 : length_m + 10;
      for (double x = -10; x < end_m; x += 4) shine_in_cladding(x, seen_from, scene);
    } else {
      for (double x = -16; x < length_m + 16; x += 4) {
        for (int row = -2; row <= 2; ++row) {
          const double y = 3.5 * row + random.uniform(-0.3, 0.3);
          hang_lamp({x + random.uniform(-0.5, 0.5), y, 6 + random.uniform(-0.5, 0.5)}, seen_from, scene);
        }
      }
    }
  }

  void hang_lamp(const Eigen::Vector3d& place_map, const SeenFrom& seen_from, BlobScene& scene) const {
    Noise& random = scene.random();
    const auto where = [=](double t) { return seen_from(t, place_map); };
    const double depth = random.log_uniform(0.02, 1);
    if (lamps == Lamps::kTubes) {
      const Eigen::Vector3d tube = random.uniform(0, 1) < 0.5 ? Eigen::Vector3d(1.5, 0, 0) : Eigen::Vector3d(0, 1.5, 0);
      scene.lights.push_back({where, mains_flicker(random.log_uniform(500, 20000), std::min(depth, 0.6), random),
                              [=](double t) { return seen_from(t, place_map + tube); }, 1.3});
      return;
    }
    const double sigma_px = random.log_uniform(0.9, 5);  // from a far LED to a bay lamp of 0.4 m
    const double light = random.log_uniform(5, 500) * 2 * kPi * sigma_px * sigma_px;
    const auto waveform = lamps == Lamps::kSteady ? steady(light) : mains_flicker(light, depth, random);
    scene.lights.push_back({where, waveform, {}, sigma_px});
  }

  /// A warning light 1 to 3 m above the camera.
  void meet_truck(double x, const SeenFrom& seen_from, BlobScene& scene) const {
    Noise& random = scene.random();
    const double rate_hz = random.uniform(1, 3), phase = random.uniform(0, 1), duty = random.log_uniform(0.05, 0.5);
    const double light = random.log_uniform(100, 5000), speed = random.uniform(0, 2);
    const double y = (random.uniform(0, 1) < 0.5 ? -1 : 1) * random.uniform(1.5, 4), z = random.uniform(1, 3);
    const auto where = [=](double t) { return seen_from(t, {x - speed * t, y, z}); };
    const auto turning = [=](double t) {
      return light * 3 * std::pow(std::max(0.0, std::cos(2 * kPi * (rate_hz * t + phase))), 8);
    };
    const bool turns = random.uniform(0, 1) < 0.5;
    if (turns) {
      scene.lights.push_back({where, turning});
    } else {
      scene.lights.push_back({where, blinking(light, rate_hz, phase, duty)});
    }
  }

  /// A lamp or the sun mirrored in a ribbed wall to one side: an image behind the wall that each rib shows for a
  /// moment, no two ribs equally bright.
  void shine_in_cladding(double x, const SeenFrom& seen_from, BlobScene& scene) const {
    Noise& random = scene.random();
    const double side = random.uniform(0, 1) < 0.5 ? -1 : 1;
    const Eigen::Vector3d mirrored(x, side * random.uniform(6, 9), random.uniform(3, 6));
    const double pitch_m = random.uniform(0.15, 0.4), phase = random.uniform(0, 1), speed = speed_m_s;
    const double light = random.log_uniform(100, 5000), sharpness = random.uniform(1, 6);
    const double share = lamps == Lamps::kSun ? 1.0 : 0.5;  // the wall is half way to the lamp's image
    const std::uint64_t wall = random.bits();
    const auto brightness = [=](double t) {
      const double ribs = share * speed * t / pitch_m + phase;
      const double of_rib = Noise(wall + static_cast<std::uint64_t>(std::floor(ribs))).log_uniform(0.4, 1);
      return light * of_rib * std::pow(0.5 - 0.5 * std::cos(2 * kPi * ribs), sharpness);
    };
    const bool sun = lamps == Lamps::kSun;
    scene.lights.push_back(
        {[=](double t) { return seen_from(t, sun ? mirrored + Eigen::Vector3d(speed * t, 0, 0) : mirrored); },
         brightness});
  }
};

}  // namespace lodestar::test
