#pragma once

#include <linux/videodev2.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/sensing/camera/frame_source.hpp"
#include "lodestar/sensing/camera/v4l2_port.hpp"

namespace lodestar {

/// A camera of the kernel's video4linux2. Its frames are unpacked into the allocator's memory: one pass over the bytes.
/// The kernel stamps them by the host's steady clock.
class V4l2Source : public FrameSource {
 public:
  V4l2Source(std::string device, std::unique_ptr<V4l2Port> port);
  ~V4l2Source() override;

  SourceInfo start(const CameraSettings& settings, const FrameAllocator& allocate) override;
  Result<DeviceFrame, NoFrame> next(Duration timeout) override;

 private:
  struct Buffer {
    std::uint8_t* data;
    std::size_t bytes;
  };

  void demand(unsigned long request, void* argument, const std::string& doing);
  void set_if_there(std::uint32_t control, double value);
  double exposure_s();
  double period_s();
  void set_format(const CameraSettings& settings);
  void set_rate(double rate_hz);
  void map_buffers(SourceClock& clock);
  std::optional<DeviceFrame> unpack(const v4l2_buffer& buffer) const;
  [[noreturn]] void refuse(const std::string& what) const;

  std::string name_;
  std::unique_ptr<V4l2Port> port_;
  FrameAllocator allocate_;
  v4l2_pix_format format_{};
  std::vector<Buffer> buffers_;
  bool streaming_ = false;
};

}  // namespace lodestar
