#include "lodestar/ros/nodelets/edge_drop.hpp"

namespace lodestar {

const char* name(EdgeDrop reason) {
  switch (reason) {
    case EdgeDrop::kTimeStep:
      return "time step";
    case EdgeDrop::kCameraInfo:
      return "bad camera_info";
    case EdgeDrop::kNoCameraInfo:
      return "no camera_info";
    case EdgeDrop::kTones:
      return "rate does not suit the tones";
    case EdgeDrop::kNoMount:
      return "no mount";
    case EdgeDrop::kCount:
      break;
  }
  return "unknown";
}

}  // namespace lodestar
