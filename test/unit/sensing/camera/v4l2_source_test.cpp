#include "lodestar/sensing/camera/v4l2_source.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "lodestar/sensing/camera/open_source.hpp"
#include "support/camera/fake_v4l2_camera.hpp"
#include "support/camera/heap_frames.hpp"

namespace lodestar {
namespace {

class V4l2SourceTest : public testing::Test {
 protected:
  V4l2SourceTest() {
    camera_->alive = [this](const std::uint8_t* data) { return memory_.alive(data); };
    source_.emplace("/dev/fake", std::unique_ptr<V4l2Port>(camera_));
  }
  SourceInfo start() { return source_->start(settings_, memory_.allocator()); }
  std::string refusal() {
    try {
      start();
    } catch (const CameraRefusal& refusal) {
      return refusal.what();
    }
    return "";
  }
  static cv::Mat grey() {
    cv::Mat image(48, 64, CV_8UC1);
    for (int v = 0; v < 48; ++v)
      for (int u = 0; u < 64; ++u) image.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(3 * u + v);
    return image;
  }
  void show_grey() {
    camera_->formats = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_Y16};
    const cv::Mat image = grey();
    camera_->picture.assign(image.data, image.data + 64 * 48);
  }
  void expect_copies() {
    for (int i = 0; i < 10; ++i) {
      const auto frame = source_->next({});
      ASSERT_TRUE(frame.ok());
      EXPECT_TRUE(memory_.gave(frame->memory.data));
      EXPECT_NE(frame->memory.data, camera_->written);
      EXPECT_EQ(difference(*frame), 0);
    }
  }
  void expect_ten_incomplete() {
    camera_->picture.assign(64 * 48, 1);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(source_->next({}).error(), NoFrame::kIncomplete);
    camera_->picture.assign(64 * 48 * 2, 1);
    camera_->next_flags = V4L2_BUF_FLAG_ERROR;
    for (int i = 0; i < 10; ++i) EXPECT_EQ(source_->next({}).error(), NoFrame::kIncomplete);
  }
  static int difference(const DeviceFrame& frame) {
    const cv::Mat got(frame.height_px, frame.width_px, CV_8UC1, frame.memory.data, frame.stride_bytes);
    double largest = 0;
    cv::minMaxLoc(cv::abs(got - grey()), nullptr, &largest);
    return static_cast<int>(largest);
  }

  std::map<std::uint32_t, int> controls_;
  test::HeapFrames memory_;
  test::FakeV4l2Camera* camera_ = new test::FakeV4l2Camera(controls_);
  std::optional<V4l2Source> source_;
  CameraSettings settings_;
};

TEST_F(V4l2SourceTest, YuyvIsItsLuma) {
  start();
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      camera_->picture.push_back(grey().at<std::uint8_t>(v, u));
      camera_->picture.push_back(200);  // colour
    }
  for (std::uint32_t i = 0; i < 10; ++i) {  // more than there are buffers
    const auto frame = source_->next({});
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(difference(*frame), 0);
    EXPECT_EQ(frame->id, i);
    EXPECT_LT(seconds(Duration(frame->heard.ticks - frame->ticks)), 0.1);
  }
}

TEST_F(V4l2SourceTest, MjpegIsDecodedAndBrokenOnesAreIncomplete) {
  settings_.pixel_format = "mjpeg";
  start();
  cv::imencode(".jpg", grey(), camera_->picture, {cv::IMWRITE_JPEG_QUALITY, 100});
  const auto frame = source_->next({});
  ASSERT_TRUE(frame.ok());
  EXPECT_LE(difference(*frame), 3);
  constexpr std::uint8_t kStartOfFrame[] = {0xFF, 0xC0, 0x00, 0x0B, 0x08};
  const auto size =
      std::search(camera_->picture.begin(), camera_->picture.end(), std::begin(kStartOfFrame), std::end(kStartOfFrame));
  ASSERT_LT(size + 9, camera_->picture.end());
  std::fill(size + 5, size + 9, std::uint8_t{0xFF});  // 65535 x 65535
  EXPECT_EQ(source_->next({}).error(), NoFrame::kIncomplete);
  camera_->picture = {1, 2, 3};
  EXPECT_EQ(source_->next({}).error(), NoFrame::kIncomplete);
}

TEST_F(V4l2SourceTest, GreyIsWrittenIntoTheFrameByTheKernel) {
  show_grey();
  EXPECT_TRUE(start().in_place);
  for (std::uint32_t i = 0; i < 10; ++i) {  // more than there are buffers
    const auto frame = source_->next({});
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(frame->memory.data, camera_->written);
    EXPECT_EQ(difference(*frame), 0);
    EXPECT_EQ(frame->id, i);
  }
}

TEST_F(V4l2SourceTest, Grey16KeepsItsBits) {
  camera_->formats = {V4L2_PIX_FMT_Y16};
  camera_->picture.assign(64 * 48 * 2, 0x12);
  EXPECT_TRUE(start().in_place);
  const auto frame = source_->next({});
  ASSERT_TRUE(frame.ok());
  EXPECT_EQ(frame->memory.data, camera_->written);
  EXPECT_EQ(frame->bits, 16);
  EXPECT_EQ(*reinterpret_cast<const std::uint16_t*>(frame->memory.data), 0x1212);
}

TEST_F(V4l2SourceTest, PaddedRowsStayWhereTheyAre) {
  show_grey();
  cv::Mat padded(48, 80, CV_8UC1, cv::Scalar(0));
  grey().copyTo(padded.colRange(0, 64));
  camera_->least_stride_bytes = 80;
  camera_->picture.assign(padded.data, padded.data + 80 * 48);
  start();
  const auto frame = source_->next({});
  ASSERT_TRUE(frame.ok());
  EXPECT_EQ(frame->memory.data, camera_->written);
  EXPECT_EQ(frame->stride_bytes, 80u);
  EXPECT_EQ(difference(*frame), 0);
}

TEST_F(V4l2SourceTest, TheKernelNeverWritesIntoAFrameThatSomebodyHolds) {
  show_grey();
  start();
  std::vector<DeviceFrame> held;
  for (int i = 0; i < 100; ++i) {
    camera_->picture.assign(64 * 48, static_cast<std::uint8_t>(i));
    held.push_back(source_->next({}).value());
  }
  for (int i = 0; i < 100; ++i) {
    const DeviceFrame& frame = held[static_cast<std::size_t>(i)];
    EXPECT_EQ(std::count(frame.memory.data, frame.memory.data + 64 * 48, i), 64 * 48) << i;
  }
  held.clear();
  EXPECT_EQ(memory_.alive(), 4) << "those that the kernel has";
}

TEST_F(V4l2SourceTest, WhatTheKernelHasIsKeptUntilItIsClosed) {
  show_grey();
  start();
  source_->next({});
  camera_->unplugged = true;  // it does not even hear that it is to stop
  EXPECT_THROW(source_->next({}), CameraError);
  camera_->scribble();
  source_.reset();
  EXPECT_EQ(memory_.alive(), 0);
}

TEST_F(V4l2SourceTest, ADriverWithMemoryOfItsOwnOnlyIsCopiedFrom) {
  show_grey();
  camera_->memories = {V4L2_MEMORY_MMAP};
  EXPECT_FALSE(start().in_place);
  expect_copies();
}

TEST_F(V4l2SourceTest, ADriverThatRefusesOurMemoryOnlyWhenItSeesItIsCopiedFrom) {
  show_grey();
  camera_->takes_ours = 2;
  EXPECT_FALSE(start().in_place);
  EXPECT_EQ(memory_.alive(), 0);
  expect_copies();
}

TEST_F(V4l2SourceTest, ADriverThatTakesOurMemoryOnlyIsNoFault) {
  show_grey();
  camera_->memories = {V4L2_MEMORY_USERPTR};
  EXPECT_TRUE(start().in_place);
}

TEST_F(V4l2SourceTest, ADriverWithoutBuffersIsAnError) {
  show_grey();
  camera_->memories = {};
  EXPECT_THROW(start(), CameraError);
}

TEST_F(V4l2SourceTest, ABufferThatCannotBeHandedOverMidwayIsAnError) {
  show_grey();
  camera_->takes_ours = 6;
  start();
  EXPECT_TRUE(source_->next({}).ok());
  EXPECT_TRUE(source_->next({}).ok());
  EXPECT_THROW(source_->next({}), CameraError);
}

TEST_F(V4l2SourceTest, ShortOrDamagedFramesAreIncompleteAndTheirBuffersComeBack) {
  EXPECT_FALSE(start().in_place) << "luma has to be picked out";
  expect_ten_incomplete();
}

TEST_F(V4l2SourceTest, ShortOrDamagedFramesInOurMemoryToo) {
  camera_->formats = {V4L2_PIX_FMT_Y16};
  EXPECT_TRUE(start().in_place);
  expect_ten_incomplete();
  EXPECT_EQ(memory_.alive(), 4);
}

TEST_F(V4l2SourceTest, NothingIsAutomatic) {
  settings_.exposure_s = 0.002;
  settings_.gain = 7;
  settings_.rate_hz = 60;
  const auto switches = {V4L2_CID_AUTOGAIN, V4L2_CID_FOCUS_AUTO, V4L2_CID_AUTO_WHITE_BALANCE, V4L2_CID_AUTOBRIGHTNESS,
                         V4L2_CID_BACKLIGHT_COMPENSATION};
  for (const std::uint32_t automatic : switches) {
    camera_->ranges[automatic] = {0, 1};
    controls_[automatic] = 1;
  }
  const SourceInfo info = start();
  EXPECT_EQ(controls_[V4L2_CID_EXPOSURE_AUTO], V4L2_EXPOSURE_MANUAL);
  for (const std::uint32_t automatic : switches) EXPECT_EQ(controls_[automatic], 0) << automatic;
  EXPECT_EQ(controls_[V4L2_CID_EXPOSURE_ABSOLUTE], 20);
  EXPECT_EQ(controls_[V4L2_CID_GAIN], 7);
  EXPECT_DOUBLE_EQ(info.exposure_s, 0.002);
  EXPECT_DOUBLE_EQ(info.period_s, 1 / 60.0);
  EXPECT_EQ(info.clock.stamped, SourceClock::Stamped::kExposureStart);
  EXPECT_FALSE(info.clock.heard_at_arrival);
}

TEST_F(V4l2SourceTest, AControlThatCannotBeSetIsNoFaultWhileItStandsAsWanted) {
  camera_->stuck = {{V4L2_CID_AUTOGAIN, EACCES}};
  controls_[V4L2_CID_AUTOGAIN] = 0;
  EXPECT_EQ(refusal(), "");
}

TEST_F(V4l2SourceTest, WhatStaysAutomaticIsRefused) {
  camera_->stuck = {{V4L2_CID_AUTOGAIN, EACCES}};
  EXPECT_EQ(refusal(), "v4l2:/dev/fake: Fake Control cannot be set to 0, it is 1: Permission denied\n");
}

TEST_F(V4l2SourceTest, AControlThatIsBusyMayBeTriedAgain) {
  camera_->stuck = {{V4L2_CID_AUTOGAIN, EBUSY}};
  EXPECT_THROW(start(), CameraError);
}

TEST_F(V4l2SourceTest, AnExposureThatCanOnlyBeReadHasNoLimits) {
  camera_->read_only = {V4L2_CID_EXPOSURE_ABSOLUTE};
  settings_.exposure_s = 0.002;
  EXPECT_EQ(refusal(), "v4l2:/dev/fake: exposure_s is 0.002 s, the camera cannot be told: leave exposure_s out\n");
}

TEST_F(V4l2SourceTest, LimitsAreTold) {
  settings_.exposure_s = 3;
  settings_.gain = 1000;
  settings_.pixel_format = "mono8";
  EXPECT_EQ(refusal(),
            "v4l2:/dev/fake: exposure_s is 3 s, the camera takes 0.0001 to 0.5 s: choose one of these\n"
            "v4l2:/dev/fake: gain is 1000, the camera takes 0 to 100: choose one of these\n"
            "v4l2:/dev/fake: pixel_format is 'mono8', the camera has yuyv, mjpeg: choose one of these\n");
}

TEST_F(V4l2SourceTest, RatesBetweenItsModesAreRefused) {
  settings_.rate_hz = 100;
  EXPECT_NE(refusal().find("the camera takes 30 to 60 Hz"), std::string::npos) << refusal();
  settings_.rate_hz = 50;
  EXPECT_NE(refusal().find("the nearest that the camera has is 60"), std::string::npos) << refusal();
}

TEST_F(V4l2SourceTest, WhatIsNoCameraIsRefused) {
  camera_->capabilities = V4L2_CAP_VIDEO_OUTPUT;
  EXPECT_NE(refusal(), "");
}

TEST_F(V4l2SourceTest, UnpluggedIsAnError) {
  start();
  EXPECT_EQ(source_->next({}).error(), NoFrame::kTimeout);
  camera_->unplugged = true;
  EXPECT_THROW(source_->next({}), CameraError);
  camera_->wakes = false;
  EXPECT_THROW(source_->next({}), CameraError) << "a camera is asked";
}

TEST(V4l2, DevicesThatAreNone) {
  EXPECT_THROW(open_source("v4l2:/dev/no_such_video"), CameraError);
  test::HeapFrames memory;
  EXPECT_THROW(open_source("v4l2:/dev/null")->start({}, memory.allocator()), CameraError);
}

/// Why this device is no camera that a test may use; empty: it is one.
std::string why_not(const std::string& device) {
  const int file = open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return device + ": " + std::strerror(errno) + "\n";
  v4l2_capability capability{};
  const bool answers = ioctl(file, VIDIOC_QUERYCAP, &capability) == 0;
  close(file);
  if (!answers) return device + ": " + std::strerror(errno) + "\n";
  const std::uint32_t can =
      capability.capabilities & V4L2_CAP_DEVICE_CAPS ? capability.device_caps : capability.capabilities;
  return can & V4L2_CAP_VIDEO_CAPTURE ? "" : device + ": it does not capture video\n";
}

struct CameraHere {
  std::string device;  ///< the first of /dev/video* that captures; empty: none
  std::string why_not;
};

CameraHere camera_of_this_machine() {
  std::set<std::string> devices;
  for (const auto& entry : std::filesystem::directory_iterator("/dev"))
    if (entry.path().filename().string().rfind("video", 0) == 0) devices.insert(entry.path());
  if (devices.empty()) return {"", "this machine has no /dev/video*"};
  std::string faults;
  for (const std::string& device : devices) {
    const std::string fault = why_not(device);
    if (fault.empty()) return {device, ""};
    faults += fault;
  }
  return {"", faults};
}

std::vector<DeviceFrame> ten_frames(FrameSource& source) {
  std::vector<DeviceFrame> frames;
  for (int tries = 0; frames.size() < 10 && tries < 60; ++tries)
    if (const auto frame = source.next(std::chrono::seconds(1))) frames.push_back(*frame);
  return frames;
}

// Where a machine has a camera: the kernel itself instead of the fake. Test patterns will do (modprobe vivid).
TEST(V4l2, TheFirstCameraOfThisMachineStreams) {
  const CameraHere here = camera_of_this_machine();
  if (here.device.empty()) GTEST_SKIP() << here.why_not;
  test::HeapFrames memory;
  CameraSettings beyond;
  beyond.exposure_s = 1e6;
  EXPECT_THROW(open_source("v4l2:" + here.device)->start(beyond, memory.allocator()), CameraRefusal);

  const auto source = open_source("v4l2:" + here.device);
  const SourceInfo info = source->start({}, memory.allocator());
  const auto frames = ten_frames(*source);
  ASSERT_EQ(frames.size(), 10u) << info.name;
  double least_age_s = 1e9;  // a busy machine takes frames late
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_TRUE(memory.gave(frames[i].memory.data));
    least_age_s = std::min(least_age_s, std::abs(seconds(Duration(frames[i].heard.ticks) - Duration(frames[i].ticks))));
    if (i == 0) continue;
    EXPECT_GT(frames[i].id, frames[i - 1].id);
    EXPECT_GT(frames[i].ticks, frames[i - 1].ticks);
  }
  EXPECT_LT(least_age_s, 1);
}

/// The kernel, and where of ours it was told to write.
struct WatchedPort : V4l2Port {
  std::unique_ptr<V4l2Port> kernel;
  bool takes_ours;
  std::set<const std::uint8_t*> handed;

  WatchedPort(const std::string& device, bool takes_ours_in)
      : kernel(open_v4l2_port(device)), takes_ours(takes_ours_in) {}
  int control(unsigned long request, void* argument) override {
    if (request == VIDIOC_REQBUFS && static_cast<v4l2_requestbuffers*>(argument)->memory == V4L2_MEMORY_USERPTR &&
        !takes_ours)
      return EINVAL;
    if (request == VIDIOC_QBUF && static_cast<v4l2_buffer*>(argument)->memory == V4L2_MEMORY_USERPTR)
      handed.insert(reinterpret_cast<const std::uint8_t*>(static_cast<v4l2_buffer*>(argument)->m.userptr));
    return kernel->control(request, argument);
  }
  bool wait(Duration timeout) override { return kernel->wait(timeout); }
  std::uint8_t* map(std::size_t bytes, std::int64_t offset) override { return kernel->map(bytes, offset); }
};

std::vector<DeviceFrame> watch(const std::string& device, const std::string& pixel_format, bool takes_ours,
                               test::HeapFrames& memory) {
  auto port = std::make_unique<WatchedPort>(device, takes_ours);
  const WatchedPort& watched = *port;
  V4l2Source source(device, std::move(port));
  CameraSettings settings;
  settings.pixel_format = pixel_format;
  EXPECT_EQ(source.start(settings, memory.allocator()).in_place, takes_ours);
  auto frames = ten_frames(source);
  for (const DeviceFrame& frame : frames) EXPECT_EQ(watched.handed.count(frame.memory.data) > 0, takes_ours);
  return frames;
}

// Its pictures stand still but for a text, so that both ways have to bring the same.
TEST(V4l2, VividWritesIntoOurMemoryWhatElseIsCopied) {
  const CameraHere here = camera_of_this_machine();
  if (here.device.empty()) GTEST_SKIP() << here.why_not;
  v4l2_capability capability{};
  constexpr std::uint32_t kTextMode = 0x00f0f001;  // VIVID_CID_OSD_TEXT_MODE, in no header that is installed
  v4l2_control no_text{kTextMode, 2};
  const auto port = open_v4l2_port(here.device);
  port->control(VIDIOC_QUERYCAP, &capability);
  if (std::strcmp(reinterpret_cast<const char*>(capability.driver), "vivid") != 0)
    GTEST_SKIP() << here.device << " is no vivid";
  ASSERT_EQ(port->control(VIDIOC_S_CTRL, &no_text), 0);

  test::HeapFrames memory;
  for (const std::string pixel_format : {"mono8", "mono16"}) {
    SCOPED_TRACE(pixel_format);
    const auto copied = watch(here.device, pixel_format, false, memory);
    const auto written = watch(here.device, pixel_format, true, memory);
    ASSERT_EQ(copied.size(), 10u);
    ASSERT_EQ(written.size(), 10u);
    const DeviceFrame& first = copied.front();
    const std::size_t bytes = first.stride_bytes * static_cast<std::size_t>(first.height_px);
    EXPECT_NE(std::count(first.memory.data, first.memory.data + bytes, first.memory.data[0]),
              static_cast<std::ptrdiff_t>(bytes));
    for (std::size_t i = 0; i < written.size(); ++i) {
      ASSERT_EQ(written[i].stride_bytes, first.stride_bytes);
      EXPECT_EQ(std::memcmp(written[i].memory.data, first.memory.data, bytes), 0) << i;
      if (i == 0) continue;
      EXPECT_GT(written[i].id, written[i - 1].id);
      EXPECT_GT(written[i].ticks, written[i - 1].ticks);
    }
  }
}

}  // namespace
}  // namespace lodestar
