#include "lodestar/sensing/camera/open_source.hpp"

#include "aravis_source.hpp"
#include "file_source.hpp"
#include "lodestar/sensing/camera/v4l2_source.hpp"

namespace lodestar {

std::unique_ptr<FrameSource> open_source(const std::string& uri) {
  const std::size_t colon = uri.find(':');
  const std::string kind = uri.substr(0, colon);
  const std::string address = colon == std::string::npos ? "" : uri.substr(colon + 1);
  if (address.empty() && (kind == "file" || kind == "v4l2"))
    throw CameraRefusal({{uri, 0, "names nothing: it has to go on as file:/path/video.avi or v4l2:/dev/video0"}});
  if (kind == "file") return std::make_unique<FileSource>(address);
  if (kind == "v4l2") return std::make_unique<V4l2Source>(address, open_v4l2_port(address));
  if (kind == "gige") return open_aravis_source(AravisBus::kGige, address);
  if (kind == "usb3") return open_aravis_source(AravisBus::kUsb3, address);
  throw CameraRefusal({{"'" + uri + "'", 0, "is no camera: it has to begin with gige:, usb3:, v4l2:, file: or sim:"}});
}

}  // namespace lodestar
