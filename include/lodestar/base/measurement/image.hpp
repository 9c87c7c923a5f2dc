#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// One camera frame, looked at, not owned: `owner` keeps the pixels alive for as long as anyone holds the image.
/// 8 or 16 bits a pixel, one channel, the host's byte order.
struct Image {
  Stamp stamp;  ///< middle of the exposure
  int width_px = 0, height_px = 0;
  int bits = 8;                  ///< 8 or 16
  std::size_t stride_bytes = 0;  ///< from one row to the next
  const std::uint8_t* data = nullptr;
  std::shared_ptr<const void> owner;

  template <class Pixel>
  const Pixel* row(int v) const {
    return reinterpret_cast<const Pixel*>(data + static_cast<std::size_t>(v) * stride_bytes);
  }
};

}  // namespace lodestar
