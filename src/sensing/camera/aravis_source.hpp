#pragma once

#include <memory>
#include <string>

#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar {

enum class AravisBus { kGige, kUsb3 };

/// A GigE Vision or USB3 Vision camera through Aravis. The driver writes each frame into the allocator's memory: nobody
/// copies it.
/// @param address id, serial number or network address; empty: the first camera found
/// @throws CameraError it is not there; CameraRefusal this build has no Aravis
std::unique_ptr<FrameSource> open_aravis_source(AravisBus bus, const std::string& address);

}  // namespace lodestar
