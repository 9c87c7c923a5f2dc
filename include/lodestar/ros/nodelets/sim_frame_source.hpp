#pragma once

#include <memory>
#include <string>

#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar {

/// open_source() and, beside it, `sim:/path/scenario.yaml`: the camera of a simulated truck, in real time. It stands at
/// the edge, which alone sees both camera and simulator.
std::unique_ptr<FrameSource> open_camera(const std::string& uri);

}  // namespace lodestar
