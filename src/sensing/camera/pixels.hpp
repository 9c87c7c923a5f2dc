#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar {

/// Packed rows in new memory.
DeviceFrame new_frame(int width_px, int height_px, int bits, const FrameAllocator& allocate);

/// Grey pixels of an image of 8 or 16 bits with 1, 3 or 4 channels; none for any other.
std::optional<DeviceFrame> frame_of(const cv::Mat& image, const FrameAllocator& allocate);

/// Every second byte is luma (V4L2_PIX_FMT_YUYV).
DeviceFrame frame_of_yuyv(const std::uint8_t* data, int width_px, int height_px, std::size_t stride_bytes,
                          const FrameAllocator& allocate);

/// None when the data is no JPEG of this size.
std::optional<DeviceFrame> frame_of_jpeg(const std::uint8_t* data, std::size_t bytes, int width_px, int height_px,
                                         const FrameAllocator& allocate);

}  // namespace lodestar
