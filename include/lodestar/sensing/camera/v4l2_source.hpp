#pragma once

#include <linux/videodev2.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/sensing/camera/frame_source.hpp"
#include "lodestar/sensing/camera/v4l2_port.hpp"

namespace lodestar {

/// A camera of the kernel's video4linux2, which stamps frames by the host's steady clock. Grey frames are written into
/// the allocator's memory by the kernel itself, where its driver takes that (V4L2_MEMORY_USERPTR); all else is unpacked
/// into it from the driver's own (V4L2_MEMORY_MMAP).
class V4l2Source : public FrameSource {
 public:
  V4l2Source(std::string device, std::unique_ptr<V4l2Port> port);
  ~V4l2Source() override;

  SourceInfo start(const CameraSettings& settings, const FrameAllocator& allocate) override;
  Result<DeviceFrame, NoFrame> next(Duration timeout) override;

 private:
  struct Buffer {
    FrameMemory memory;  ///< without owner: the driver's own
    std::size_t bytes;
  };

  void demand(unsigned long request, void* argument, const std::string& doing);
  void set_if_there(std::uint32_t control, double value);
  double exposure_s();
  double period_s();
  void set_format(const CameraSettings& settings);
  void set_rate(double rate_hz);
  void provide_buffers(SourceClock& clock);
  void queue_buffers(v4l2_memory memory, SourceClock& clock);
  v4l2_buffer kernel_buffer(std::uint32_t index) const;
  Buffer our_buffer() const;
  Buffer mapped_buffer(const v4l2_buffer& buffer);
  void queue(std::uint32_t index);
  std::optional<DeviceFrame> frame_in(Buffer& buffer, std::size_t bytes_used) const;
  [[noreturn]] void refuse(const std::string& what) const;

  std::string name_;
  std::vector<Buffer> buffers_;  // go after the port: until it is closed the kernel may write there
  std::unique_ptr<V4l2Port> port_;
  FrameAllocator allocate_;
  v4l2_pix_format format_{};
  v4l2_memory memory_ = V4L2_MEMORY_MMAP;
  bool streaming_ = false;
};

}  // namespace lodestar
