#include "lodestar/sensing/camera/v4l2_source.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <deque>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "lodestar/sensing/camera/open_source.hpp"
#include "support/camera/heap_frames.hpp"

namespace lodestar {
namespace {

/// A camera of 64 x 48 at 30 or 60 Hz, as the kernel's documentation has one answer.
struct FakeCamera : V4l2Port {
  std::vector<std::uint32_t> formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG};
  std::map<std::uint32_t, std::pair<int, int>> ranges = {{V4L2_CID_EXPOSURE_ABSOLUTE, {1, 5000}},
                                                         {V4L2_CID_EXPOSURE_AUTO, {0, 3}},
                                                         {V4L2_CID_GAIN, {0, 100}},
                                                         {V4L2_CID_AUTOGAIN, {0, 1}}};
  std::set<std::uint32_t> read_only;
  std::map<std::uint32_t, int> stuck;  ///< controls that answer with this errno when they are set
  std::map<std::uint32_t, int>& controls;
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::uint32_t stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  v4l2_pix_format format{};
  std::vector<std::vector<std::uint8_t>> memory;
  std::deque<std::uint32_t> queue;
  std::vector<std::uint8_t> picture;  ///< of the next frames
  std::uint32_t sequence = 0, next_flags = 0, rate_hz = 30;
  bool streaming = false, unplugged = false;
  bool wakes = true;  ///< wait() learns when it is unplugged

  explicit FakeCamera(std::map<std::uint32_t, int>& controls_in) : controls(controls_in) {
    controls = {{V4L2_CID_EXPOSURE_AUTO, 3}, {V4L2_CID_AUTOGAIN, 1}, {V4L2_CID_EXPOSURE_ABSOLUTE, 156}};
    format.width = 64;
    format.height = 48;
    format.pixelformat = formats.front();
  }

  template <class Structure>
  static Structure& as(void* argument) {
    return *static_cast<Structure*>(argument);
  }

  int control(unsigned long request, void* argument) override {
    if (unplugged) return ENODEV;
    switch (request) {
      case VIDIOC_QUERYCAP:
        as<v4l2_capability>(argument).capabilities = capabilities;
        std::strcpy(reinterpret_cast<char*>(as<v4l2_capability>(argument).card), "Fake");
        return 0;
      case VIDIOC_QUERYCTRL: {
        auto& query = as<v4l2_queryctrl>(argument);
        if (ranges.count(query.id) == 0) return EINVAL;
        std::tie(query.minimum, query.maximum) = ranges[query.id];
        std::strcpy(reinterpret_cast<char*>(query.name), "Fake Control");
        query.flags = read_only.count(query.id) > 0 ? V4L2_CTRL_FLAG_READ_ONLY : 0u;
        return 0;
      }
      case VIDIOC_S_CTRL:
        if (stuck.count(as<v4l2_control>(argument).id) > 0) return stuck[as<v4l2_control>(argument).id];
        controls[as<v4l2_control>(argument).id] = as<v4l2_control>(argument).value;
        return 0;
      case VIDIOC_G_CTRL:
        as<v4l2_control>(argument).value = controls[as<v4l2_control>(argument).id];
        return 0;
      case VIDIOC_ENUM_FMT:
        if (as<v4l2_fmtdesc>(argument).index >= formats.size()) return EINVAL;
        as<v4l2_fmtdesc>(argument).pixelformat = formats[as<v4l2_fmtdesc>(argument).index];
        return 0;
      case VIDIOC_ENUM_FRAMESIZES: {
        auto& size = as<v4l2_frmsizeenum>(argument);
        if (size.index > 0) return EINVAL;
        size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
        size.discrete = {64, 48};
        return 0;
      }
      case VIDIOC_ENUM_FRAMEINTERVALS: {
        auto& interval = as<v4l2_frmivalenum>(argument);
        if (interval.index > 1) return EINVAL;
        interval.type = V4L2_FRMIVAL_TYPE_DISCRETE;
        interval.discrete = {1, interval.index == 0 ? 30u : 60u};
        return 0;
      }
      case VIDIOC_G_FMT:
        as<v4l2_format>(argument).fmt.pix = format;
        return 0;
      case VIDIOC_S_FMT:
        format.pixelformat = as<v4l2_format>(argument).fmt.pix.pixelformat;
        as<v4l2_format>(argument).fmt.pix = format;
        return 0;
      case VIDIOC_S_PARM: {
        auto& interval = as<v4l2_streamparm>(argument).parm.capture.timeperframe;
        interval = {1, interval.denominator / interval.numerator >= 45 ? 60u : 30u};
        rate_hz = interval.denominator;
        return 0;
      }
      case VIDIOC_G_PARM:
        as<v4l2_streamparm>(argument).parm.capture.timeperframe = {1, rate_hz};
        return 0;
      case VIDIOC_REQBUFS:
        memory.assign(as<v4l2_requestbuffers>(argument).count, std::vector<std::uint8_t>(64 * 48 * 2));
        return 0;
      case VIDIOC_QUERYBUF: {
        auto& buffer = as<v4l2_buffer>(argument);
        buffer.length = static_cast<std::uint32_t>(memory[buffer.index].size());
        buffer.m.offset = buffer.index;
        buffer.flags = stamp_flags;
        return 0;
      }
      case VIDIOC_QBUF:
        queue.push_back(as<v4l2_buffer>(argument).index);
        as<v4l2_buffer>(argument).sequence = 0;  // as the kernel does: the buffer is a new one
        as<v4l2_buffer>(argument).timestamp = {};
        return 0;
      case VIDIOC_STREAMON:
        streaming = true;
        return 0;
      case VIDIOC_DQBUF: {
        if (!streaming || queue.empty()) return EAGAIN;
        auto& buffer = as<v4l2_buffer>(argument);
        buffer.index = queue.front();
        queue.pop_front();
        std::copy(picture.begin(), picture.end(), memory[buffer.index].begin());
        buffer.bytesused = static_cast<std::uint32_t>(picture.size());
        buffer.flags = stamp_flags | next_flags;
        buffer.sequence = sequence++;
        timespec now{};
        clock_gettime(CLOCK_MONOTONIC, &now);
        buffer.timestamp = {now.tv_sec, now.tv_nsec / 1000};
        return 0;
      }
      default:
        return 0;
    }
  }
  bool wait(Duration) override { return wakes && (unplugged || (streaming && !picture.empty())); }
  std::uint8_t* map(std::size_t, std::int64_t offset) override {
    return memory[static_cast<std::size_t>(offset)].data();
  }
};

class V4l2SourceTest : public testing::Test {
 protected:
  SourceInfo start() { return source_.start(settings_, memory_.allocator()); }
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
  static int difference(const DeviceFrame& frame) {
    const cv::Mat got(frame.height_px, frame.width_px, CV_8UC1, frame.memory.data, frame.stride_bytes);
    double largest = 0;
    cv::minMaxLoc(cv::abs(got - grey()), nullptr, &largest);
    return static_cast<int>(largest);
  }

  std::map<std::uint32_t, int> controls_;
  FakeCamera* camera_ = new FakeCamera(controls_);
  V4l2Source source_{"/dev/fake", std::unique_ptr<V4l2Port>(camera_)};
  CameraSettings settings_;
  test::HeapFrames memory_;
};

TEST_F(V4l2SourceTest, YuyvIsItsLuma) {
  start();
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      camera_->picture.push_back(grey().at<std::uint8_t>(v, u));
      camera_->picture.push_back(200);  // colour
    }
  for (std::uint32_t i = 0; i < 10; ++i) {  // more than there are buffers
    const auto frame = source_.next({});
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
  const auto frame = source_.next({});
  ASSERT_TRUE(frame.ok());
  EXPECT_LE(difference(*frame), 3);
  camera_->picture = {1, 2, 3};
  EXPECT_EQ(source_.next({}).error(), NoFrame::kIncomplete);
}

TEST_F(V4l2SourceTest, GreyIsAsItComes) {
  camera_->formats = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_Y16};
  start();
  const cv::Mat image = grey();
  camera_->picture.assign(image.data, image.data + 64 * 48);
  const auto frame = source_.next({});
  ASSERT_TRUE(frame.ok());
  EXPECT_EQ(difference(*frame), 0);
}

TEST_F(V4l2SourceTest, Grey16KeepsItsBits) {
  camera_->formats = {V4L2_PIX_FMT_Y16};
  start();
  camera_->picture.assign(64 * 48 * 2, 0x12);
  const auto frame = source_.next({});
  ASSERT_TRUE(frame.ok());
  EXPECT_EQ(frame->bits, 16);
  EXPECT_EQ(*reinterpret_cast<const std::uint16_t*>(frame->memory.data), 0x1212);
}

TEST_F(V4l2SourceTest, ShortOrDamagedFramesAreIncompleteAndTheirBuffersComeBack) {
  start();
  camera_->picture.assign(64 * 48, 1);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(source_.next({}).error(), NoFrame::kIncomplete);
  camera_->picture.assign(64 * 48 * 2, 1);
  camera_->next_flags = V4L2_BUF_FLAG_ERROR;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(source_.next({}).error(), NoFrame::kIncomplete);
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
  settings_.pixel_format = "mono8";
  EXPECT_EQ(refusal(),
            "v4l2:/dev/fake: exposure_s is 3 s, the camera takes 0.0001 to 0.5 s: choose one of these\n"
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
  EXPECT_EQ(source_.next({}).error(), NoFrame::kTimeout);
  camera_->unplugged = true;
  EXPECT_THROW(source_.next({}), CameraError);
  camera_->wakes = false;
  EXPECT_THROW(source_.next({}), CameraError) << "a camera is asked";
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
  std::vector<DeviceFrame> frames;
  for (int tries = 0; frames.size() < 10 && tries < 20; ++tries)
    if (const auto frame = source->next(std::chrono::seconds(1))) frames.push_back(*frame);
  ASSERT_EQ(frames.size(), 10u) << info.name;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_TRUE(memory.gave(frames[i].memory.data));
    EXPECT_LT(std::abs(seconds(Duration(frames[i].heard.ticks) - Duration(frames[i].ticks))), 1);
    if (i == 0) continue;
    EXPECT_GT(frames[i].id, frames[i - 1].id);
    EXPECT_GT(frames[i].ticks, frames[i - 1].ticks);
  }
}

}  // namespace
}  // namespace lodestar
