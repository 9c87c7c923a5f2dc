#include "lodestar/sensing/beacon/beacon_detector.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

using test::at;
using test::BlobScene;
using test::steady;
using test::tones;

const std::vector<double> kTable = {6, 8, 10, 12, 14, 16, 24, 26};

std::shared_ptr<const CameraModel> camera_for(const BlobScene& scene) {
  CameraIntrinsics lens;
  lens.width_px = scene.width_px;
  lens.height_px = scene.height_px;
  lens.fx_px = lens.fy_px = 100;
  lens.cx_px = scene.width_px / 2.0;
  lens.cy_px = scene.height_px / 2.0;
  return CameraModel::create(lens).value();
}

BeaconDetector detector_for(const BlobScene& scene, std::vector<double> table = kTable, int window = 30) {
  BeaconDetectorParams params;
  params.tone_table_hz = std::move(table);
  params.window_frames = window;
  if (scene.bits == 16) params.white_level = scene.white_level;
  BeaconDetector detector(params);
  detector.set_camera(camera_for(scene));
  return detector;
}

/// The result of the last of `frames` frames at `rate_hz`.
Sightings run(
    BlobScene& scene, BeaconDetector& detector, int frames, double rate_hz,
    const std::function<double(int)>& jitter_s = [](int) { return 0.0; }) {
  Sightings last;
  const CameraMotion standing;
  for (int i = 0; i < frames; ++i) {
    const auto result = detector.process(scene.render(i / rate_hz + jitter_s(i)), standing);
    EXPECT_TRUE(result.ok());
    if (result) last = *result;
  }
  return last;
}

TEST(BeaconDetector, ReadsCodesOfOneToThreeTones) {
  BlobScene scene;
  scene.lights = {{at(30.3, 40.2), tones(250, {6})},
                  {at(70.7, 90.4), tones(250, {10, 24})},
                  {at(120.1, 60.9), tones(250, {8, 14, 26})}};
  auto detector = detector_for(scene);
  const auto result = run(scene, detector, 31, 60);
  ASSERT_EQ(result.sightings.size(), 3u);
  const ToneSet codes[] = {{0}, {2, 6}, {1, 4, 7}};
  for (const Sighting& sighting : result.sightings) {
    bool found = false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (sighting.tones != codes[i]) continue;
      found = true;
      EXPECT_LT((sighting.pixel - scene.lights[i].pixel(0)).norm(), 0.05);
      EXPECT_GT(sighting.snr_db, 20);
      EXPECT_FALSE(sighting.saturated);
    }
    EXPECT_TRUE(found);
  }
}

TEST(BeaconDetector, SaysNothingUntilItsWindowIsFull) {
  BlobScene scene;
  scene.lights = {{at(30, 40), tones(250, {6})}};
  auto detector = detector_for(scene);
  EXPECT_TRUE(run(scene, detector, 29, 60).sightings.empty());
  EXPECT_EQ(detector.process(scene.render(29 / 60.0), CameraMotion()).value().sightings.size(), 1u);
}

TEST(BeaconDetector, FindsABeaconThatNoSingleFrameShows) {
  BlobScene scene;
  scene.noise = 1.5;
  scene.lights = {{at(64.0, 40.0), tones(22, {8})}};  // peak pixel: 4 grey levels at most, noise 1.5
  BeaconDetectorParams params;
  params.tone_table_hz = kTable;
  BeaconDetector detector(params);
  detector.set_camera(camera_for(scene));
  const auto result = run(scene, detector, 35, 60);
  ASSERT_EQ(result.sightings.size(), 1u);
  EXPECT_EQ(result.sightings[0].tones, ToneSet{1});
  EXPECT_LT((result.sightings[0].pixel - Eigen::Vector2d(64, 40)).norm(), 0.5);
}

TEST(BeaconDetector, ReadsOnOffBeaconsAtThePapersRate) {
  for (double tone : {5.0, 10.0}) {
    for (double delay_s = 0; delay_s < 0.2; delay_s += 0.013) {
      BlobScene scene;
      scene.lights = {{at(50.4, 40.6), [=](double t) {
                         double share = 0;  // of a 10 ms exposure that the light is on
                         for (int i = 0; i < 20; ++i) {
                           share += std::fmod((t + delay_s + i * 0.0005) * tone, 1.0) < 0.5 ? 0.05 : 0.0;
                         }
                         return 300 * share;
                       }}};
      auto detector = detector_for(scene, {5, 10}, 15);
      const auto result = run(scene, detector, 20, 25);
      ASSERT_EQ(result.sightings.size(), 1u) << tone << " Hz, delay " << delay_s;
      EXPECT_EQ(result.sightings[0].tones, ToneSet{tone == 5.0 ? 0 : 1}) << "delay " << delay_s;
    }
  }
}

TEST(BeaconDetector, AClippedTwoToneBeaconKeepsItsCodeAndCentre) {
  for (double light : {3000.0, 10000.0, 30000.0}) {
    BlobScene scene;
    scene.lights = {{at(60.3, 50.8), tones(light, {6, 10})}};
    auto detector = detector_for(scene);
    const auto result = run(scene, detector, 31, 60);
    ASSERT_EQ(result.sightings.size(), 1u) << light;
    EXPECT_EQ(result.sightings[0].tones, (ToneSet{0, 2})) << light;
    EXPECT_TRUE(result.sightings[0].saturated);
    EXPECT_LT((result.sightings[0].pixel - Eigen::Vector2d(60.3, 50.8)).norm(), 0.1) << light;
  }
}

TEST(BeaconDetector, LampsAreNoBeacons) {
  const std::vector<std::function<double(double)>> lamps = {
      steady(400),
      [](double t) { return 300 * (1 + 0.9 * std::cos(2 * kPi * 100 * t)); },  // mains flicker
      [](double t) { return 300 * (1 + 0.4 * std::cos(2 * kPi * 120.01 * t)); },
      [](double t) { return 300 * std::pow(std::abs(std::sin(2 * kPi * 50 * t)), 3); },  // tube
      [](double t) { return std::fmod(t * 2, 1.0) < 0.5 ? 400.0 : 0.0; },                // warning lights
      [](double t) { return std::fmod(t * 1.5, 1.0) < 0.1 ? 400.0 : 0.0; },
      [](double t) { return std::fmod(t * 3, 1.0) < 0.2 ? 400.0 : 0.0; }};
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    BlobScene scene;
    scene.lights = {{at(60.3, 50.8), lamps[i]}};
    auto detector = detector_for(scene);
    const CameraMotion standing;
    for (int frame = 0; frame < 150; ++frame) {
      EXPECT_TRUE(detector.process(scene.render(frame / 60.0), standing).value().sightings.empty())
          << "lamp " << i << ", frame " << frame;
    }
  }
}

TEST(BeaconDetector, ALampThatShimmersInATonesRhythmIsNoBeacon) {
  for (const double depth : {0.02, 0.05, 0.15}) {
    BlobScene scene;
    scene.lights = {{at(60.3, 50.8), [=](double t) { return 700 * (1 + depth * std::cos(2 * kPi * 8 * t)); }}};
    auto detector = detector_for(scene);
    for (int frame = 0; frame < 60; ++frame) {
      EXPECT_TRUE(detector.process(scene.render(frame / 60.0), CameraMotion()).value().sightings.empty())
          << "depth " << depth << ", frame " << frame;
    }
  }
}

/// How many of four windows' frames show the light as a beacon of this code, and as any other.
struct Readings {
  int right = 0, wrong = 0;
};
constexpr int kFramesLeft = 4 * 30 - (30 + 5);  ///< once a beacon must have been seen
Readings readings(const std::function<double(double)>& light, ToneSet code, int window = 30) {
  BlobScene scene;
  scene.lights = {{at(60.3, 50.8), light}};
  auto detector = detector_for(scene, kTable, window);
  Readings count;
  for (int frame = 0; frame < 4 * window; ++frame) {
    const auto result = detector.process(scene.render(frame / 60.0), CameraMotion());
    for (const Sighting& sighting : result->sightings) ++(sighting.tones == code ? count.right : count.wrong);
  }
  return count;
}

TEST(BeaconDetector, WhatTwinklesOnRibsAtATonesRateIsNoBeacon) {
  const ToneSet none;
  const auto rib = [](double t, double sharpness) {
    return std::pow(0.5 - 0.5 * std::cos(2 * kPi * 8 * t), sharpness);
  };
  for (const double sharpness : {1.5, 2.0, 4.0})
    EXPECT_EQ(readings([&](double t) { return 700 * rib(t, sharpness); }, none).wrong, 0) << sharpness;
  const auto uneven = [&](double t) { return (static_cast<int>(8 * t) % 2 == 0 ? 700 : 350) * rib(t, 1); };
  EXPECT_EQ(readings(uneven, none).wrong, 0);
  const auto flat = [&](double t) { return (static_cast<int>(8 * t) % 2 == 0 ? 700 : 350) * (rib(t, 1) > 0.5); };
  EXPECT_EQ(readings(flat, none).wrong, 0);
}

TEST(BeaconDetector, ABeaconThatIsPassedMayGrowBrighter) {
  const auto growing = [](const std::function<double(double)>& beacon) {
    return [=](double t) { return std::exp(0.8 * t) * beacon(t); };
  };
  for (const auto& beacon : {tones(100, {8}), test::blinking(100, 8, 0.2)}) {
    const Readings count = readings(growing(beacon), {1});
    EXPECT_GE(count.right, kFramesLeft);
    EXPECT_EQ(count.wrong, 0);
  }
  EXPECT_GE(readings(growing(tones(100, {8, 14})), {1, 4}).right, kFramesLeft);
}

TEST(BeaconDetector, AnOnOffBeaconThatPausesToSendItsFrameKeepsItsCode) {
  const auto code = test::blinking(300, 8, 0.2);
  const auto paused = [=](double t) { return std::fmod(t, 0.8) < 0.025 ? 300 : code(t); };
  const Readings count = readings(paused, {1});
  EXPECT_GE(count.right, kFramesLeft);
  EXPECT_EQ(count.wrong, 0);
}

TEST(BeaconDetector, AWindowOfFiveFramesCannotProveTwoTones) {
  const Readings count = readings(tones(300, {12, 24}), {2, 6}, 5);
  EXPECT_EQ(count.right + count.wrong, 0);
}

TEST(BeaconDetector, ABeaconThatPausesToSendItsFrameKeepsItsCodeInMotion) {
  // Eight slots of 25 ms: at 30 frames/s each sixth frame shows the mean (optical_link.md, section 2).
  constexpr int kWindow = 15;
  constexpr double kRate_hz = 30, kMean = 250, kSlot_s = 0.025, kSuperframe_s = 8 * kSlot_s;
  const auto code = tones(kMean, {4, 14});
  BlobScene scene;
  scene.lights = {{[](double t) { return Eigen::Vector2d(20 + 30 * t, 50.4); },
                   [=](double t) { return std::fmod(t, kSuperframe_s) < kSlot_s ? kMean : code(t); }}};
  auto detector = detector_for(scene, {4, 6, 8, 14}, kWindow);
  int windows = 0, read = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const auto result = detector.process(scene.render(frame / kRate_hz), CameraMotion());
    if (frame < kWindow + 5) continue;
    ++windows;
    for (const Sighting& sighting : result->sightings) {
      EXPECT_EQ(sighting.tones, (ToneSet{0, 3}));
      ++read;
    }
  }
  EXPECT_GE(read, windows * 3 / 4) << "a pause in one frame of six spoils some windows";
}

TEST(BeaconDetector, AMovingSteadyLampIsNoBeacon) {
  for (double speed_px_s : {3.0, 20.0, 60.0, 200.0}) {
    BlobScene scene;
    scene.lights = {
        {[=](double t) { return Eigen::Vector2d(10 + speed_px_s * t, 30 + 0.3 * speed_px_s * t); }, steady(400)}};
    auto detector = detector_for(scene);
    const CameraMotion unknown;
    const int frames = static_cast<int>(std::min(120.0, 140.0 / speed_px_s * 60));
    for (int i = 0; i < frames; ++i) {
      EXPECT_TRUE(detector.process(scene.render(i / 60.0), unknown).value().sightings.empty()) << speed_px_s << " px/s";
    }
  }
}

TEST(BeaconDetector, JitterAndLostFramesDoNotBendTheCode) {
  BlobScene scene;
  scene.lights = {{at(60.3, 50.8), tones(250, {12, 26})}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  auto detector = detector_for(scene);
  const CameraMotion standing;
  int windows = 0, right = 0, wrong = 0;
  for (int i = 0; i < 300; ++i) {
    if (uniform(random) > 0.8) continue;  // one in ten is lost
    const auto result = detector.process(scene.render((i + 0.2 * uniform(random)) / 60.0), standing);
    if (i < 40) continue;
    ++windows;
    for (const Sighting& sighting : result->sightings) ++(sighting.tones == ToneSet{3, 7} ? right : wrong);
  }
  EXPECT_GE(right, windows * 97 / 100);
  EXPECT_EQ(wrong, 0);
}

TEST(BeaconDetector, CarriesTwelveBitsInMono16) {
  BlobScene scene;
  scene.bits = 16;
  scene.white_level = 4095;
  scene.dark_level = 60;
  scene.noise = 2;
  scene.lights = {{at(40.2, 40.7), tones(9000, {6, 10})}, {at(110.6, 80.4), tones(60, {8, 16})}};
  auto detector = detector_for(scene);
  const auto result = run(scene, detector, 31, 60);
  ASSERT_EQ(result.sightings.size(), 2u);
  for (const Sighting& s : result.sightings) EXPECT_EQ(s.tones, s.pixel.x() < 80 ? (ToneSet{0, 2}) : (ToneSet{1, 5}));
}

TEST(BeaconDetector, FollowsTheMotionThatOdometryPredictsThoughTheHeightIsWrong) {
  BlobScene scene;
  const auto camera = camera_for(scene);
  const double height_m = 5, speed_m_s = 1.5;
  const auto place = [&](double t) {
    return camera->project(Eigen::Vector3d(2.5 - speed_m_s * t, 0.7, height_m))->pixel;
  };
  scene.lights = {{place, tones(250, {8, 16})}};
  auto detector = detector_for(scene);
  detector.set_plane_height(5.4);
  CameraMotion motion;
  int seen = 0;
  double square = 0;
  for (int i = 0; i < 80; ++i) {
    const double t = i / 60.0;
    const Image image = scene.render(t);
    motion.add_odometry({image.stamp, {speed_m_s, 0}, 0, Eigen::Vector3d::Zero(), 0});
    const auto result = detector.process(image, motion);
    if (i < 32) continue;
    ASSERT_EQ(result->sightings.size(), 1u) << "frame " << i;
    EXPECT_EQ(result->sightings[0].tones, (ToneSet{1, 5}));
    square += (result->sightings[0].pixel - place(t)).squaredNorm();
    ++seen;
  }
  EXPECT_LT(std::sqrt(square / seen / 2), 0.1) << "px rms, each axis, for the newest frame";
}

TEST(BeaconDetector, DropsWhatItCannotUseByReason) {
  BlobScene scene;
  const CameraMotion standing;
  BeaconDetectorParams params;
  params.tone_table_hz = kTable;
  BeaconDetector blind(params);
  EXPECT_EQ(blind.process(scene.render(0), standing).error(), FrameDrop::kNoCamera);

  auto detector = detector_for(scene);
  const auto refuse = [&](Image image) { return detector.process(image, standing).error(); };
  Image image;
  for (const double t : {0.96, 0.98, 1.0}) ASSERT_TRUE(detector.process(image = scene.render(t), standing).ok());
  EXPECT_EQ(refuse(image), FrameDrop::kDuplicate);
  EXPECT_EQ(refuse(scene.render(0.5)), FrameDrop::kBackwards);
  Image wrong = scene.render(2);
  wrong.data = nullptr;
  EXPECT_EQ(refuse(wrong), FrameDrop::kNoPixels);
  wrong = scene.render(2);
  wrong.bits = 24;
  EXPECT_EQ(refuse(wrong), FrameDrop::kFormat);
  wrong = scene.render(2);
  wrong.stride_bytes = 10;
  EXPECT_EQ(refuse(wrong), FrameDrop::kFormat);
  wrong = scene.render(2);
  wrong.bits = 16;
  wrong.stride_bytes = 2 * static_cast<std::size_t>(wrong.width_px) + 1;
  EXPECT_EQ(refuse(wrong), FrameDrop::kFormat) << "every second row at an odd address";
  wrong.stride_bytes += 1;
  ++wrong.data;
  EXPECT_EQ(refuse(wrong), FrameDrop::kFormat) << "every row at an odd address";
  wrong = scene.render(2);
  wrong.height_px -= 1;
  EXPECT_EQ(refuse(wrong), FrameDrop::kSize);
  EXPECT_EQ(detector.drops()[FrameDrop::kDuplicate], 1u);
  EXPECT_EQ(detector.drops().total(), 8u);
}

TEST(BeaconDetector, RefusesWhatItCannotWorkWith) {
  BeaconDetectorParams params;
  EXPECT_THROW(BeaconDetector{params}, std::invalid_argument) << "no tones";
  params.tone_table_hz.assign(33, 5.0);
  EXPECT_THROW(BeaconDetector{params}, std::invalid_argument) << "too many";
  params.tone_table_hz = kTable;
  params.window_frames = 3;
  EXPECT_THROW(BeaconDetector{params}, std::invalid_argument) << "no window";
  params.window_frames = 30;
  params.false_alarms_per_hour = 0;
  EXPECT_THROW(BeaconDetector{params}, std::invalid_argument) << "no threshold";
}

TEST(BeaconDetector, ALongPauseStartsTheWindowAnew) {
  BlobScene scene;
  scene.lights = {{at(60, 50), tones(250, {6})}};
  auto detector = detector_for(scene);
  EXPECT_EQ(run(scene, detector, 31, 60).sightings.size(), 1u);
  EXPECT_EQ(detector.process(scene.render(5), CameraMotion()).error(), FrameDrop::kAhead);
  EXPECT_TRUE(detector.process(scene.render(5.02), CameraMotion()).value().sightings.empty());
}

TEST(BeaconDetector, OneWildStampCostsOneFrame) {
  BlobScene scene;
  scene.lights = {{at(60, 50), tones(250, {6})}};
  auto detector = detector_for(scene);
  auto see = [&, frame = 0](double stamp_error_s) mutable {
    Image image = scene.render(frame++ / 60.0);
    image.stamp += from_seconds(stamp_error_s);
    const auto result = detector.process(image, CameraMotion());
    return result ? result->sightings.size() : 0;
  };
  see(0.9);  // the very first is wild
  for (int i = 0; i < 29; ++i) see(0);
  EXPECT_EQ(see(0), 1u);
  for (const double error_s : {0.2, 0.5, 0.9, 2.0, 100.0, 1e6, -0.2, -0.9, -1e3}) {
    see(error_s);
    EXPECT_EQ(see(0), 1u) << "the frame after a stamp that is off by " << error_s << " s";
  }
  // Time that goes on elsewhere is believed from the second frame on.
  see(0.5);
  see(0.5);
  EXPECT_EQ(detector.drops()[FrameDrop::kAhead], 7u);
}

}  // namespace
}  // namespace lodestar
