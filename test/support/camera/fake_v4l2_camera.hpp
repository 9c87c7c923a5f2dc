#pragma once

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "lodestar/sensing/camera/v4l2_port.hpp"

namespace lodestar::test {

/// A camera of 64 x 48 at 30 or 60 Hz, as the kernel's documentation has one answer. What it was handed it may write to
/// at any time until it gives it back or is closed, and it does.
struct FakeV4l2Camera : V4l2Port {
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
  std::set<std::uint32_t> memories = {V4L2_MEMORY_MMAP, V4L2_MEMORY_USERPTR};  ///< that its driver takes
  int takes_ours = 1000;  ///< how many buffers of ours its driver takes
  std::function<bool(const std::uint8_t*)> alive = [](const std::uint8_t*) { return true; };  ///< of what is ours
  std::uint32_t kind = V4L2_MEMORY_MMAP;                                                      ///< of its buffers
  std::vector<std::vector<std::uint8_t>> maps;
  std::vector<std::uint8_t*> memory;  ///< of its buffers, by their index
  std::deque<std::uint32_t> queue;
  const std::uint8_t* written = nullptr;  ///< where the last frame was written
  std::vector<std::uint8_t> picture;      ///< of the next frames
  std::uint32_t least_stride_bytes = 0;
  std::uint32_t sequence = 0, next_flags = 0, rate_hz = 30;
  bool streaming = false, unplugged = false;
  bool wakes = true;  ///< wait() learns when it is unplugged

  explicit FakeV4l2Camera(std::map<std::uint32_t, int>& controls_in) : controls(controls_in) {
    controls = {{V4L2_CID_EXPOSURE_AUTO, 3}, {V4L2_CID_AUTOGAIN, 1}, {V4L2_CID_EXPOSURE_ABSOLUTE, 156}};
    format.width = 64;
    format.height = 48;
    format.pixelformat = formats.front();
    format.bytesperline = 64 * 2;
    format.sizeimage = 64 * 48 * 2;
  }
  ~FakeV4l2Camera() override { scribble(); }

  void scribble() {
    for (const std::uint32_t index : queue) {
      const bool there = kind != V4L2_MEMORY_USERPTR || alive(memory[index]);
      EXPECT_TRUE(there) << "the kernel writes into memory that is gone";
      if (there) std::fill_n(memory[index], format.sizeimage, std::uint8_t{0xEE});
    }
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
        format.bytesperline = std::max(as<v4l2_format>(argument).fmt.pix.bytesperline, least_stride_bytes);
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
      case VIDIOC_REQBUFS: {
        const auto& request = as<v4l2_requestbuffers>(argument);
        if (memories.count(request.memory) == 0) return EINVAL;
        scribble();
        queue.clear();
        kind = request.memory;
        maps.assign(request.count, std::vector<std::uint8_t>(format.sizeimage));
        memory.assign(request.count, nullptr);
        return 0;
      }
      case VIDIOC_QUERYBUF: {
        auto& buffer = as<v4l2_buffer>(argument);
        buffer.length = format.sizeimage;
        buffer.m.offset = buffer.index;
        buffer.flags = stamp_flags;
        return 0;
      }
      case VIDIOC_QBUF: {
        auto& buffer = as<v4l2_buffer>(argument);
        std::uint8_t* data = maps[buffer.index].data();
        if (buffer.memory == V4L2_MEMORY_USERPTR) {
          if (buffer.length < format.sizeimage || takes_ours-- <= 0) return EINVAL;
          data = reinterpret_cast<std::uint8_t*>(buffer.m.userptr);
        }
        memory[buffer.index] = data;
        queue.push_back(buffer.index);
        return 0;
      }
      case VIDIOC_STREAMON:
        streaming = true;
        return 0;
      case VIDIOC_STREAMOFF:
        scribble();
        streaming = false;
        queue.clear();
        return 0;
      case VIDIOC_DQBUF: {
        if (!streaming || queue.empty()) return EAGAIN;
        auto& buffer = as<v4l2_buffer>(argument);
        scribble();
        buffer.index = queue.front();
        queue.pop_front();
        written = memory[buffer.index];
        std::copy(picture.begin(), picture.end(), memory[buffer.index]);
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
  std::uint8_t* map(std::size_t, std::int64_t offset) override { return maps[static_cast<std::size_t>(offset)].data(); }
};

}  // namespace lodestar::test
