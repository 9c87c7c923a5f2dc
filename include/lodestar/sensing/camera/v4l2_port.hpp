#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// The few system calls that a v4l2 camera is spoken to by.
class V4l2Port {
 public:
  virtual ~V4l2Port() = default;
  /// 0, or errno.
  virtual int control(unsigned long request, void* argument) = 0;
  /// Whether there is something to take within this time.
  virtual bool wait(Duration timeout) = 0;
  /// A buffer of the driver's; null when it cannot be mapped. Unmapped with the port.
  virtual std::uint8_t* map(std::size_t bytes, std::int64_t offset) = 0;
};

/// @throws CameraError the device cannot be opened
std::unique_ptr<V4l2Port> open_v4l2_port(const std::string& device);

}  // namespace lodestar
