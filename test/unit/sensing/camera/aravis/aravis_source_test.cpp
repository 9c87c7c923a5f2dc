// Against Aravis' own fake GigE Vision camera, a process that speaks the protocol on the loopback.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "lodestar/sensing/camera/capture.hpp"
#include "lodestar/sensing/camera/open_source.hpp"
#include "support/camera/fake_gige_camera.hpp"
#include "support/camera/heap_frames.hpp"
#include "support/real_time.hpp"

#if LODESTAR_HAS_ARAVIS
#include <arv.h>
#endif

namespace lodestar {
namespace {

using test::FakeGigeCamera;

/// A busy machine may let any exchange with the camera, and any frame, be late or lost. So no test here says how soon
/// something comes, only that it does; CaptureTest and AnswerWatch say how soon, by a given clock.
constexpr double kLongest_s = 30;

/// What `attempt` returns once the camera answered in time.
template <class Attempt>
auto patiently(Attempt attempt) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kLongest_s);
  for (;;) try {
      return attempt();
    } catch (const CameraError&) {
      if (std::chrono::steady_clock::now() > end) throw;
    }
}

class AravisSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!LODESTAR_HAS_ARAVIS || !FakeGigeCamera::installed()) GTEST_SKIP() << "no Aravis, or no aravis-tools";
    settings_.rate_hz = 100;
    settings_.exposure_s = 0.002;
  }
  Capture capture() {
    return Capture([] { return open_source(FakeGigeCamera::kUri); }, settings_, memory_.allocator(), 0);
  }
  SourceInfo start() {
    return patiently([&] { return open_source(FakeGigeCamera::kUri)->start(settings_, memory_.allocator()); });
  }
  template <class Done>
  static bool comes_true(Capture& capture, Done done) {
    return test::run_until(
        done, [&] { capture.next(); }, kLongest_s);
  }
  static CapturedFrame next_frame(Capture& capture) {
    std::optional<CapturedFrame> frame;
    if (!test::run_until([&] { return frame.has_value(); }, [&] { frame = capture.next(); }, kLongest_s))
      throw std::runtime_error("no frame: " + capture.report().fault);
    return *frame;
  }

  CameraSettings settings_;
  test::HeapFrames memory_;
};

TEST_F(AravisSourceTest, TheDriverWritesIntoOurMemory) {
  const FakeGigeCamera camera;
  const SourceInfo info = start();
  EXPECT_NEAR(info.exposure_s, 0.002, 1e-9);
  EXPECT_NEAR(info.period_s, 0.01, 1e-6);
  EXPECT_EQ(info.clock.frame_id_bits, 16);
  Capture capture = this->capture();
  for (int i = 0; i < 10; ++i) {
    const DeviceFrame frame = next_frame(capture).frame;
    EXPECT_TRUE(memory_.gave(frame.memory.data));
    EXPECT_EQ(frame.stride_bytes, static_cast<std::size_t>(frame.width_px));
    std::uint8_t* const end = frame.memory.data + frame.stride_bytes * static_cast<std::size_t>(frame.height_px);
    EXPECT_NE(std::find_if(frame.memory.data, end, [](std::uint8_t grey) { return grey != 0; }), end);
  }
}

TEST_F(AravisSourceTest, IsFoundByItsNameAndSerialNumberAndWithoutAny) {
  const FakeGigeCamera camera;
  for (const char* uri : {"gige:Aravis-Fake-GV01", "gige:GV01", "gige:"}) {
    SCOPED_TRACE(uri);
    Capture capture([uri] { return open_source(uri); }, settings_, memory_.allocator(), 0);
    EXPECT_NO_THROW(next_frame(capture));
  }
}

TEST_F(AravisSourceTest, SixteenBitsAndAnotherSize) {
  const FakeGigeCamera camera;
  settings_.pixel_format = "mono16";
  settings_.width_px = 320;
  settings_.height_px = 200;
  Capture capture = this->capture();
  const DeviceFrame frame = next_frame(capture).frame;
  EXPECT_EQ(frame.bits, 16);
  EXPECT_EQ(frame.width_px, 320);
  EXPECT_EQ(frame.height_px, 200);
  EXPECT_EQ(frame.stride_bytes, 640u);
}

TEST_F(AravisSourceTest, LimitsAreTheCameras) {
  const FakeGigeCamera camera;
  settings_.exposure_s = 20;
  settings_.gain = 50;
  settings_.pixel_format = "mjpeg";
  try {
    start();
    FAIL() << "was not refused";
  } catch (const CameraRefusal& refusal) {
    EXPECT_EQ(std::string(refusal.what()),
              "gige:127.0.0.1: exposure_s is 20 s, the camera takes 1e-05 to 10 s: choose one of these\n"
              "gige:127.0.0.1: gain is 50, the camera takes 0 to 10: choose one of these\n"
              "gige:127.0.0.1: pixel_format is 'mjpeg', the camera has mono8, mono16: choose one of these\n");
  }
}

#if LODESTAR_HAS_ARAVIS
/// Whether the fake camera, as Aravis itself opens it, comes to be so.
template <class Is>
bool camera_comes_to_be(Is is) {
  return test::run_until(
      [&] {
        GError* error = nullptr;
        const std::unique_ptr<ArvCamera, void (*)(gpointer)> camera(arv_camera_new("127.0.0.1", &error),
                                                                    g_object_unref);
        const bool so = camera && is(camera.get(), &error) && !error;
        g_clear_error(&error);
        return so;
      },
      [] {}, kLongest_s);
}

TEST_F(AravisSourceTest, AutomaticsAreStopped) {
  const FakeGigeCamera camera;
  ASSERT_TRUE(camera_comes_to_be([](ArvCamera* aravis, GError** error) {
    arv_camera_set_gain_auto(aravis, ARV_AUTO_CONTINUOUS, error);
    return !*error && arv_camera_get_gain_auto(aravis, error) == ARV_AUTO_CONTINUOUS;
  }));
  start();
  EXPECT_TRUE(camera_comes_to_be(
      [](ArvCamera* aravis, GError** error) { return arv_camera_get_gain_auto(aravis, error) == ARV_AUTO_OFF; }));
}

TEST_F(AravisSourceTest, SettingsReachTheCamera) {
  const FakeGigeCamera camera;
  settings_.gain = 3;
  start();
  EXPECT_TRUE(camera_comes_to_be(
      [](ArvCamera* aravis, GError** error) { return std::abs(arv_camera_get_gain(aravis, error) - 3) < 1e-9; }));
  EXPECT_TRUE(camera_comes_to_be([](ArvCamera* aravis, GError** error) {
    return std::abs(arv_camera_get_exposure_time(aravis, error) - 2000) < 1e-6;
  }));
  EXPECT_TRUE(camera_comes_to_be([](ArvCamera* aravis, GError** error) {
    return std::abs(arv_camera_get_frame_rate(aravis, error) - 100) < 1e-3;
  }));
}
#endif

// It stamps by the host's own clock. The line lies below all arrivals and touches one; from there to the newest it
// falls by max_drift at most.
TEST_F(AravisSourceTest, StampsAreHalfAnExposureBeforeTheLeastLateArrivals) {
  const FakeGigeCamera camera;
  Capture capture = this->capture();
  const double before_arrival_s = 0.5 * *settings_.exposure_s;
  std::optional<std::uint64_t> first_ticks;
  double least_delay_s = kLongest_s;
  for (int i = 0; i < 50; ++i) {
    const CapturedFrame captured = next_frame(capture);
    const std::uint64_t ticks = captured.frame.ticks;
    const double window_s = seconds(Duration(ticks - first_ticks.value_or(ticks)));
    first_ticks = first_ticks.value_or(ticks);
    const Stamp begin(Duration(static_cast<std::int64_t>(ticks)));
    const double delay_s = seconds(captured.frame.heard.host - begin);
    least_delay_s = std::min(least_delay_s, delay_s);
    const double line_s = seconds(captured.stamp - begin) + before_arrival_s;
    EXPECT_LE(line_s, delay_s + 1e-6);
    EXPECT_GE(line_s, least_delay_s - ClockFitParams().max_drift * window_s - 1e-6);
  }
}

TEST_F(AravisSourceTest, RunsAtItsRateByOneClock) {
  const FakeGigeCamera camera;
  settings_.rate_hz = 20;
  Capture capture = this->capture();
  const auto ten_frames_do = [&] {
    const std::uint64_t restarts = capture.report().clock_restarts;
    const DeviceFrame first = next_frame(capture).frame;
    for (int i = 0; i < 9; ++i) next_frame(capture);
    const DeviceFrame last = next_frame(capture).frame;
    const double rate_hz = static_cast<double>(last.id - first.id) / seconds(Duration(last.ticks - first.ticks));
    return std::abs(rate_hz - 20) < 2 && std::abs(capture.report().rate_hz - rate_hz) < 0.15 * rate_hz &&
           capture.report().clock_restarts == restarts;
  };
  EXPECT_TRUE(test::run_until(
      ten_frames_do, [] {}, kLongest_s));
}

TEST_F(AravisSourceTest, FrozenThenBack) {
  FakeGigeCamera camera;
  Capture capture = this->capture();
  next_frame(capture);
  camera.freeze();
  // no frame, no answer: whichever is first
  EXPECT_TRUE(comes_true(capture, [&] { return capture.report().state != CaptureState::kRunning; }));
  camera.thaw();
  for (int i = 0; i < 10; ++i) next_frame(capture);
  EXPECT_GE(capture.report().reconnects, 1u);  // a camera that wakes slowly is taken up once more
}

// No frame is awaited, so only whether it answers tells.
TEST_F(AravisSourceTest, WaitsForItsTriggerAndIsKilled) {
  FakeGigeCamera camera;
  settings_.trigger = "Line9";
  EXPECT_THROW(start(), CameraRefusal);
  settings_.trigger = "Software";
  Capture capture = this->capture();
  const auto runs = [&] { return capture.report().state == CaptureState::kRunning; };
  EXPECT_TRUE(test::run_until(
      [&] {
        bool waits = true;  // for longer than a camera may be silent
        for (Duration time{}; time < 2 * Capture::kSilence; time += Capture::kPatience)
          waits = !capture.next() && runs() && waits;
        return waits;
      },
      [] {}, kLongest_s));
  camera.unplug();
  EXPECT_TRUE(comes_true(capture, [&] { return !runs(); }));
  EXPECT_EQ(capture.report().state, CaptureState::kClosed);
  EXPECT_NE(capture.report().fault.find("does not answer"), std::string::npos) << capture.report().fault;
  camera.plug_in();
  EXPECT_TRUE(comes_true(capture, runs));
  EXPECT_GE(capture.report().reconnects, 1u);
}

TEST_F(AravisSourceTest, LostPacketsCostFramesAndAreCounted) {
  const FakeGigeCamera camera(2);
  Capture capture = this->capture();
  EXPECT_TRUE(comes_true(
      capture, [&] { return capture.report().missed[NoFrame::kIncomplete] > 0 && capture.report().dropped > 0; }));
}

TEST_F(AravisSourceTest, NotOnThatBus) {
  const FakeGigeCamera camera;
  EXPECT_THROW(patiently([] { return open_source("usb3:127.0.0.1"); }), CameraRefusal);
}

}  // namespace
}  // namespace lodestar
