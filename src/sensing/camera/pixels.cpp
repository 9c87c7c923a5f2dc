#include "pixels.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace lodestar {
namespace {

cv::Mat pixels_of(const DeviceFrame& frame) {
  return cv::Mat(frame.height_px, frame.width_px, frame.bits == 8 ? CV_8UC1 : CV_16UC1, frame.memory.data,
                 frame.stride_bytes);
}

}  // namespace

DeviceFrame new_frame(int width_px, int height_px, int bits, const FrameAllocator& allocate) {
  DeviceFrame frame;
  frame.width_px = width_px;
  frame.height_px = height_px;
  frame.bits = bits;
  frame.stride_bytes = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(bits / 8);
  frame.memory = allocate(frame.stride_bytes * static_cast<std::size_t>(height_px));
  return frame;
}

std::optional<DeviceFrame> frame_of(const cv::Mat& image, const FrameAllocator& allocate) {
  const int channels = image.channels();
  if ((image.depth() != CV_8U && image.depth() != CV_16U) || image.empty() || channels == 2) return std::nullopt;
  const DeviceFrame frame = new_frame(image.cols, image.rows, image.depth() == CV_8U ? 8 : 16, allocate);
  cv::Mat grey = pixels_of(frame);
  if (channels == 1) {
    image.copyTo(grey);
  } else {
    cv::cvtColor(image, grey, channels == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
  }
  return frame;
}

DeviceFrame frame_of_yuyv(const std::uint8_t* data, int width_px, int height_px, std::size_t stride_bytes,
                          const FrameAllocator& allocate) {
  const DeviceFrame frame = new_frame(width_px, height_px, 8, allocate);
  const cv::Mat yuyv(height_px, width_px, CV_8UC2, const_cast<std::uint8_t*>(data), stride_bytes);
  cv::Mat luma = pixels_of(frame);
  cv::extractChannel(yuyv, luma, 0);
  return frame;
}

std::optional<DeviceFrame> frame_of_jpeg(const std::uint8_t* data, std::size_t bytes, int width_px, int height_px,
                                         const FrameAllocator& allocate) {
  if (bytes == 0) return std::nullopt;
  const cv::Mat packed(1, static_cast<int>(bytes), CV_8UC1, const_cast<std::uint8_t*>(data));
  try {
    const cv::Mat image = cv::imdecode(packed, cv::IMREAD_GRAYSCALE);
    if (image.cols != width_px || image.rows != height_px) return std::nullopt;
    return frame_of(image, allocate);
  } catch (const cv::Exception&) {  // a header that claims a giant
    return std::nullopt;
  }
}

}  // namespace lodestar
