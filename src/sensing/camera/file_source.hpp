#pragma once

#include <memory>
#include <opencv2/videoio.hpp>
#include <string>

#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar {

/// A video or an image sequence as a camera of a steady rate; stamps are those of its schedule.
class FileSource : public FrameSource {
 public:
  /// @param address of the URI: `path`, `path?loop`. @throws CameraError it cannot be read
  explicit FileSource(const std::string& address);

  SourceInfo start(const CameraSettings& settings, const FrameAllocator& allocate) override;
  Result<DeviceFrame, NoFrame> next(Duration timeout) override;

 private:
  void rewind();
  bool read();
  bool leave_out();
  std::optional<NoFrame> next_picture();

  std::string path_;
  bool loop_ = false, is_sequence_ = false;
  cv::VideoCapture capture_;
  cv::Mat image_;
  FrameAllocator allocate_;
  Duration period_{};
  Stamp due_;
  std::uint64_t id_ = 0;
};

}  // namespace lodestar
