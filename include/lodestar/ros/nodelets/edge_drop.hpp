#pragma once

namespace lodestar {

/// Why a well-formed message never reached its stage. What is wrong with a message itself is a MessageDrop.
enum class EdgeDrop {
  kTimeStep,      ///< its stamp is more than two seconds from the stamps around it
  kCameraInfo,    ///< camera_info that is no lens
  kNoCameraInfo,  ///< image or sightings before the first good camera_info
  kTones,         ///< image of a camera whose rate does not suit the site's tones
  kNoMount,       ///< no transform from the sensor's frame to the base yet
  kCount
};
const char* name(EdgeDrop reason);

}  // namespace lodestar
