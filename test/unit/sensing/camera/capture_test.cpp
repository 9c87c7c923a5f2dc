#include "lodestar/sensing/camera/capture.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "support/camera/heap_frames.hpp"

namespace lodestar {
namespace {

enum class Step { kFrame, kTimeout, kIncomplete, kEnd, kGone, kThrow };

/// What a camera does next; every camera that is opened reads from the same script.
struct Script {
  std::deque<Step> steps;
  std::deque<bool> there;  ///< for each opening; then: yes
  int opened = 0, open_now = 0;
  bool triggered = false;
  double period_s = 0;
  int frame_every = 0;  ///< if not 0, instead of the steps: all calls but each n-th since the opening time out
};

class ScriptedSource : public FrameSource {
 public:
  explicit ScriptedSource(Script& script) : script_(script) {
    ++script_.opened;
    ++script_.open_now;
  }
  ~ScriptedSource() override { --script_.open_now; }
  SourceInfo start(const CameraSettings&, const FrameAllocator&) override {
    SourceInfo info;
    info.name = "scripted";
    info.triggered = script_.triggered;
    info.period_s = script_.period_s;
    return info;
  }
  Result<DeviceFrame, NoFrame> next(Duration) override {
    const Step step = next_step();
    ticks_ += step == Step::kTimeout ? 100'000'000 : 10'000'000;
    if (step == Step::kTimeout) return NoFrame::kTimeout;
    if (step == Step::kIncomplete) return NoFrame::kIncomplete;
    if (step == Step::kEnd) return NoFrame::kEnd;
    if (step == Step::kGone) throw CameraError("gone");
    if (step == Step::kThrow) throw std::logic_error("anything");
    DeviceFrame frame;
    frame.id = id_++;
    frame.ticks = ticks_;
    frame.heard = {frame.ticks, Stamp(Duration(frame.ticks))};
    return frame;
  }

 private:
  Step next_step() {
    if (script_.frame_every > 0) return ++calls_ % script_.frame_every == 0 ? Step::kFrame : Step::kTimeout;
    if (script_.steps.empty()) return Step::kTimeout;
    const Step step = script_.steps.front();
    script_.steps.pop_front();
    return step;
  }

  Script& script_;
  int calls_ = 0;
  std::uint64_t id_ = 1, ticks_ = 0;
};

class CaptureTest : public testing::Test {
 protected:
  CaptureTest()
      : capture_(
            [this] {
              const bool there = script_.there.empty() || script_.there.front();
              if (!script_.there.empty()) script_.there.pop_front();
              if (!there) throw CameraError("not there");
              EXPECT_EQ(script_.open_now, 0) << "a device serves one at a time";
              return std::make_unique<ScriptedSource>(script_);
            },
            {}, frames_.allocator(), 0) {}

  int frames_of(int calls) {
    int frames = 0;
    for (int i = 0; i < calls; ++i) frames += capture_.next().has_value();
    return frames;
  }

  Script script_;
  test::HeapFrames frames_;
  Capture capture_;
};

TEST_F(CaptureTest, FramesCome) {
  script_.steps.assign(5, Step::kFrame);
  EXPECT_EQ(frames_of(5), 5);
  EXPECT_EQ(capture_.report().state, CaptureState::kRunning);
  EXPECT_EQ(capture_.report().reconnects, 0u);
}

TEST_F(CaptureTest, SilenceIsToldWithinHalfASecondAndThenTheCameraIsOpenedAnew) {
  script_.steps.assign(1, Step::kFrame);
  script_.steps.insert(script_.steps.end(), 5, Step::kTimeout);
  script_.steps.push_back(Step::kFrame);
  EXPECT_EQ(frames_of(6), 1);
  EXPECT_EQ(capture_.report().state, CaptureState::kSilent);
  EXPECT_EQ(capture_.report().fault, "scripted is silent");
  EXPECT_EQ(script_.opened, 1);
  EXPECT_EQ(frames_of(1), 1);
  EXPECT_EQ(script_.opened, 2);
  EXPECT_EQ(capture_.report().state, CaptureState::kRunning);
  EXPECT_EQ(capture_.report().reconnects, 1u);
  EXPECT_EQ(capture_.report().fault, "");
}

TEST_F(CaptureTest, ASlowCameraIsSilentHalfASecondAfterItsFrameWasDue) {
  script_.period_s = 1;
  script_.steps.assign(9, Step::kTimeout);
  script_.steps.push_back(Step::kFrame);
  EXPECT_EQ(frames_of(10), 1);
  EXPECT_EQ(frames_of(14), 0);
  EXPECT_EQ(capture_.report().state, CaptureState::kRunning);
  EXPECT_EQ(frames_of(1), 0);
  EXPECT_EQ(capture_.report().state, CaptureState::kSilent);
  EXPECT_EQ(script_.opened, 1);
}

TEST_F(CaptureTest, TheRateThatWasAskedForSaysWhenAFrameIsDue) {
  CameraSettings settings;
  settings.rate_hz = 1;
  Capture capture([this] { return std::make_unique<ScriptedSource>(script_); }, settings, frames_.allocator(), 0);
  for (int i = 0; i < 14; ++i) capture.next();
  EXPECT_EQ(capture.report().state, CaptureState::kRunning);
  capture.next();
  EXPECT_EQ(capture.report().state, CaptureState::kSilent);
}

// Each opening waits twice as long as the last, until two frames tell the period.
TEST_F(CaptureTest, ASlowCameraThatDoesNotSayItsPeriodIsNotOpenedForEver) {
  script_.frame_every = 25;
  EXPECT_EQ(frames_of(5), 0);
  EXPECT_EQ(capture_.report().state, CaptureState::kSilent);
  EXPECT_EQ(frames_of(10 + 20), 0);
  EXPECT_EQ(capture_.report().state, CaptureState::kSilent) << "no frame came yet";
  EXPECT_EQ(frames_of(25 * 4), 4);
  EXPECT_EQ(capture_.report().state, CaptureState::kRunning);
  EXPECT_EQ(script_.opened, 4);
  EXPECT_EQ(frames_of(25 * 4), 4);
  EXPECT_EQ(script_.opened, 4);
}

TEST_F(CaptureTest, ACameraThatWaitsForItsTriggerMayBeSilent) {
  script_.triggered = true;
  EXPECT_EQ(frames_of(50), 0);
  EXPECT_EQ(capture_.report().state, CaptureState::kRunning);
  EXPECT_EQ(script_.opened, 1);

  script_.steps = {Step::kFrame, Step::kTimeout, Step::kFrame};
  EXPECT_EQ(frames_of(3), 2) << "triggered twice";
  EXPECT_EQ(frames_of(50), 0);
  EXPECT_EQ(capture_.report().state, CaptureState::kRunning);
  EXPECT_EQ(capture_.report().frames, 2u);
  EXPECT_EQ(script_.opened, 1);
}

TEST_F(CaptureTest, ACameraThatIsGoneIsTriedUntilItIsBack) {
  script_.steps = {Step::kFrame, Step::kGone, Step::kFrame};
  script_.there = {true, false, false, true};
  EXPECT_EQ(frames_of(2), 1);
  EXPECT_EQ(capture_.report().fault, "gone");
  EXPECT_EQ(frames_of(2), 0);
  EXPECT_EQ(capture_.report().fault, "not there");
  EXPECT_EQ(capture_.report().state, CaptureState::kClosed);
  EXPECT_EQ(frames_of(1), 1);
  EXPECT_EQ(capture_.report().reconnects, 1u);
}

TEST_F(CaptureTest, LostPacketsAreCountedAndNoWholeFrameForHalfASecondIsTold) {
  script_.period_s = 0.01;
  script_.steps.assign(60, Step::kIncomplete);
  script_.steps.push_back(Step::kFrame);
  EXPECT_EQ(frames_of(49), 0);
  EXPECT_EQ(capture_.report().missed[NoFrame::kIncomplete], 49u);
  EXPECT_EQ(capture_.report().state, CaptureState::kRunning);
  EXPECT_EQ(frames_of(11), 0);
  EXPECT_EQ(capture_.report().state, CaptureState::kSpoilt);
  EXPECT_EQ(capture_.report().fault, "scripted sends no whole frame: incomplete");
  EXPECT_EQ(frames_of(1), 1);
  EXPECT_EQ(capture_.report().state, CaptureState::kRunning);
  EXPECT_EQ(script_.opened, 1) << "to open it anew mends no cable";
}

TEST_F(CaptureTest, WhyACameraIsNotThereIsKnownFromTheFirst) {
  script_.there = {false};
  EXPECT_THROW(capture_.open(), CameraError);
  EXPECT_EQ(capture_.report().fault, "not there");
  EXPECT_EQ(capture_.report().state, CaptureState::kClosed);
}

TEST_F(CaptureTest, ADriverThatThrowsAnythingIsALostCamera) {
  script_.steps = {Step::kFrame, Step::kThrow, Step::kFrame};
  EXPECT_EQ(frames_of(2), 1);
  EXPECT_EQ(capture_.report().fault, "anything");
  EXPECT_EQ(frames_of(1), 1);
}

TEST_F(CaptureTest, WhenTheHostsClockWasSetTheCamerasIsLearntAgain) {
  capture_.host_clock_set();
  script_.steps.assign(4, Step::kFrame);
  EXPECT_EQ(frames_of(2), 2);
  EXPECT_EQ(capture_.report().clock_restarts, 0u);
  capture_.host_clock_set();
  EXPECT_EQ(frames_of(2), 2);
  EXPECT_EQ(capture_.report().clock_restarts, 1u);
}

TEST_F(CaptureTest, ARecordingEnds) {
  script_.steps = {Step::kFrame, Step::kEnd};
  EXPECT_EQ(frames_of(10), 1);
  EXPECT_EQ(capture_.report().state, CaptureState::kOver);
  EXPECT_EQ(script_.opened, 1);
}

}  // namespace
}  // namespace lodestar
