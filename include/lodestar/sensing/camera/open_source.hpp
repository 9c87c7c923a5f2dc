#pragma once

#include <memory>
#include <string>

#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar {

/// A camera by its URI (docs/nodes/camera_capture.md):
/// - `gige:` the first GigE Vision camera, `gige:<id, serial number or address>` that one; `usb3:`, `usb3:<id>`
/// likewise
/// - `v4l2:/dev/video0`
/// - `file:/path/video.avi`, `file:/path/frame_%04d.png` (a sequence); `?rate=25` in Hz, `?loop=true`
/// @throws CameraRefusal no such kind of camera, or not in this build; CameraError it is not there
std::unique_ptr<FrameSource> open_source(const std::string& uri);

}  // namespace lodestar
