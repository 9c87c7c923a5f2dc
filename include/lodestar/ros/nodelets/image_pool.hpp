#pragma once

#include <sensor_msgs/Image.h>

#include <memory>
#include <string>
#include <vector>

#include "lodestar/sensing/camera/capture.hpp"

namespace lodestar {

/// Messages whose pixels a camera's driver writes itself: it is handed the vector's own memory. What the driver wrote
/// is what a subscriber in the same manager reads. A message that nobody holds any more is used again. One thread.
class ImagePool {
 public:
  FrameMemory take(std::size_t bytes);

  /// The message whose pixels take() gave, with all that else belongs to it.
  static sensor_msgs::ImagePtr message(const CapturedFrame& captured, const std::string& frame_id);

 private:
  std::vector<std::shared_ptr<sensor_msgs::Image>> images_;
};

}  // namespace lodestar
