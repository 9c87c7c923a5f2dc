// Against Aravis' own fake GigE Vision camera, a process that speaks the protocol on the loopback.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

#include "lodestar/sensing/camera/capture.hpp"
#include "lodestar/sensing/camera/open_source.hpp"
#include "support/camera/fake_gige_camera.hpp"
#include "support/camera/heap_frames.hpp"

#if LODESTAR_HAS_ARAVIS
#include <arv.h>
#endif

namespace lodestar {
namespace {

using test::FakeGigeCamera;

double spread(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
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
  /// However slow the machine is.
  bool gets(Capture& capture, int frames) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (frames > 0 && std::chrono::steady_clock::now() < end) frames -= capture.next().has_value();
    return frames == 0;
  }

  /// The next whole frame. A sender that a busy machine stops in the middle of one leaves it incomplete.
  static DeviceFrame whole_frame(FrameSource& source) {
    for (int i = 0; i < 50; ++i)
      if (const auto frame = source.next(std::chrono::seconds(1))) return *frame;
    throw std::runtime_error("no whole frame");
  }

  CameraSettings settings_;
  test::HeapFrames memory_;
};

TEST_F(AravisSourceTest, TheDriverWritesIntoOurMemory) {
  const FakeGigeCamera camera;
  const auto source = open_source(FakeGigeCamera::kUri);
  const SourceInfo info = source->start(settings_, memory_.allocator());
  EXPECT_NEAR(info.exposure_s, 0.002, 1e-9);
  EXPECT_NEAR(info.period_s, 0.01, 1e-6);
  EXPECT_EQ(info.clock.frame_id_bits, 16);
  for (int i = 0; i < 10; ++i) {
    const DeviceFrame frame = whole_frame(*source);
    EXPECT_TRUE(memory_.gave(frame.memory.data));
    EXPECT_EQ(frame.stride_bytes, static_cast<std::size_t>(frame.width_px));
    std::uint8_t* const end = frame.memory.data + frame.stride_bytes * static_cast<std::size_t>(frame.height_px);
    EXPECT_NE(std::find_if(frame.memory.data, end, [](std::uint8_t grey) { return grey != 0; }), end);
  }
}

TEST_F(AravisSourceTest, SixteenBitsAndAnotherSize) {
  const FakeGigeCamera camera;
  settings_.pixel_format = "mono16";
  settings_.width_px = 320;
  settings_.height_px = 200;
  const auto source = open_source(FakeGigeCamera::kUri);
  source->start(settings_, memory_.allocator());
  const DeviceFrame frame = whole_frame(*source);
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
    open_source(FakeGigeCamera::kUri)->start(settings_, memory_.allocator());
    FAIL() << "was not refused";
  } catch (const CameraRefusal& refusal) {
    EXPECT_EQ(std::string(refusal.what()),
              "gige:127.0.0.1: exposure_s is 20 s, the camera takes 1e-05 to 10 s: choose one of these\n"
              "gige:127.0.0.1: gain is 50, the camera takes 0 to 10: choose one of these\n"
              "gige:127.0.0.1: pixel_format is 'mjpeg', the camera has mono8, mono16: choose one of these\n");
  }
}

#if LODESTAR_HAS_ARAVIS
/// The fake camera as Aravis itself opens it.
std::unique_ptr<ArvCamera, void (*)(gpointer)> by_aravis() {
  return {arv_camera_new("127.0.0.1", nullptr), g_object_unref};
}

TEST_F(AravisSourceTest, AutomaticsAreStopped) {
  const FakeGigeCamera camera;
  arv_camera_set_gain_auto(by_aravis().get(), ARV_AUTO_CONTINUOUS, nullptr);
  ASSERT_EQ(arv_camera_get_gain_auto(by_aravis().get(), nullptr), ARV_AUTO_CONTINUOUS);
  open_source(FakeGigeCamera::kUri)->start(settings_, memory_.allocator());
  EXPECT_EQ(arv_camera_get_gain_auto(by_aravis().get(), nullptr), ARV_AUTO_OFF);
}

TEST_F(AravisSourceTest, SettingsReachTheCamera) {
  const FakeGigeCamera camera;
  settings_.gain = 3;
  open_source(FakeGigeCamera::kUri)->start(settings_, memory_.allocator());
  EXPECT_NEAR(arv_camera_get_gain(by_aravis().get(), nullptr), 3, 1e-9);
  EXPECT_NEAR(arv_camera_get_exposure_time(by_aravis().get(), nullptr), 2000, 1e-6);
}
#endif

TEST_F(AravisSourceTest, RateAndStampsAreTheCameras) {
  const FakeGigeCamera camera;
  settings_.rate_hz = 50;  // which it keeps on a busy machine, too
  Capture capture = this->capture();
  ASSERT_TRUE(gets(capture, 25));
  EXPECT_EQ(capture.report().clock_restarts, 0u);
  // It stamps by the host's own clock, then paints the frame and sends it: stamps are that least delay behind its own
  // time, and come more evenly than the arrivals.
  std::vector<double> stamp_delays_s, arrival_delays_s;
  std::vector<DeviceFrame> frames;
  while (frames.size() < 25) {
    const auto captured = capture.next();
    if (!captured) continue;
    frames.push_back(captured->frame);
    const Stamp begin(Duration(static_cast<std::int64_t>(captured->frame.ticks)));
    stamp_delays_s.push_back(seconds(captured->stamp - begin));
    arrival_delays_s.push_back(seconds(captured->frame.heard.host - begin));
  }
  EXPECT_LT(spread(stamp_delays_s), spread(arrival_delays_s) + 0.0001);
  const double before_arrival_s = 0.5 * *settings_.exposure_s;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_LE(stamp_delays_s[i], arrival_delays_s[i] - before_arrival_s + 1e-6);
    EXPECT_GE(stamp_delays_s[i], -before_arrival_s - 1e-3);
  }
  const double passed_s = seconds(Duration(frames.back().ticks - frames.front().ticks));
  const double rate_hz = static_cast<double>(frames.back().id - frames.front().id) / passed_s;
  EXPECT_NEAR(rate_hz, 50, 5);
  EXPECT_NEAR(capture.report().rate_hz, rate_hz, 0.15 * rate_hz);
}

TEST_F(AravisSourceTest, FrozenThenBack) {
  FakeGigeCamera camera;
  Capture capture = this->capture();
  ASSERT_TRUE(gets(capture, 10));
  camera.freeze();
  const auto frozen = std::chrono::steady_clock::now();
  while (capture.report().state == CaptureState::kRunning) capture.next();  // no frame, no answer: whichever is first
  EXPECT_LT(std::chrono::steady_clock::now() - frozen, std::chrono::seconds(1));
  camera.thaw();
  EXPECT_TRUE(gets(capture, 10));
  EXPECT_GE(capture.report().reconnects, 1u);  // a camera that wakes slowly is taken up once more
}

// No frame is awaited, so only whether it answers tells.
TEST_F(AravisSourceTest, WaitsForItsTriggerAndIsKilled) {
  FakeGigeCamera camera;
  settings_.trigger = "Line9";
  EXPECT_THROW(capture().open(), CameraRefusal);
  settings_.trigger = "Software";
  Capture capture = this->capture();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(capture.next());  // thirty frames' time
  EXPECT_EQ(capture.report().state, CaptureState::kRunning);
  camera.unplug();
  const auto unplugged = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::steady_clock::now() - unplugged; };
  while (capture.report().state == CaptureState::kRunning && passed() < std::chrono::seconds(20)) capture.next();
  EXPECT_EQ(capture.report().state, CaptureState::kClosed);
  EXPECT_NE(capture.report().fault.find("does not answer"), std::string::npos) << capture.report().fault;
  EXPECT_LT(passed(), std::chrono::seconds(1));
  camera.plug_in();
  while (capture.report().reconnects == 0 && passed() < std::chrono::seconds(30)) capture.next();
  EXPECT_EQ(capture.report().state, CaptureState::kRunning);
}

TEST_F(AravisSourceTest, LostPacketsCostFramesAndAreCounted) {
  const FakeGigeCamera camera(2);
  Capture capture = this->capture();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (capture.report().dropped == 0 && std::chrono::steady_clock::now() < end) ASSERT_TRUE(gets(capture, 10));
  EXPECT_GT(capture.report().missed[NoFrame::kIncomplete], 0u);
  EXPECT_GE(capture.report().dropped, 1u);
}

TEST_F(AravisSourceTest, NotOnThatBus) {
  const FakeGigeCamera camera;
  EXPECT_THROW(open_source("usb3:127.0.0.1"), CameraRefusal);
}

}  // namespace
}  // namespace lodestar
