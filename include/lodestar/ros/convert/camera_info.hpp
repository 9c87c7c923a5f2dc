#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/camera_model.hpp"

namespace lodestar {

/// The lens as K and D give it, for the raw image (R and P are of no concern). The error says which field is wrong, its
/// value and what it may be: unknown model, a D of the wrong length, NaN, skew, binning or a region of interest.
Result<CameraIntrinsics, std::string> intrinsics_from(const sensor_msgs::CameraInfo& message);

sensor_msgs::CameraInfo camera_info_message(const CameraIntrinsics& intrinsics, Stamp stamp,
                                            const std::string& frame_id);

}  // namespace lodestar
