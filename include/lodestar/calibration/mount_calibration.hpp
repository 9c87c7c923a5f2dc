#pragma once

#include <string>
#include <vector>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/calibration/stand_collector.hpp"

namespace lodestar {

/// One sigma of everything that the calibration takes for known but that is not known exactly.
struct MountCalibrationParams {
  RigidTransform T_base_camera = RigidTransform::Identity();  ///< as measured by hand: the angles within 15 deg or so
  double mount_sigma_m = 0.01;                                ///< of its position, each axis
  double bearing_sigma_rad = 0.001;                           ///< of the lens's calibration, new in each stand
  double floor_sigma_rad = radians(0.3);                      ///< slope of the floor at a place
  double same_place_m = 0.3;                                  ///< stands within this distance share that slope ...
  double roughness_sigma_rad = radians(0.05);                 ///< ... but for so much
  double floor_sigma_m = 0.01;                                ///< of the floor's height under base_link
  double odometry_scale_sigma = 0.02;                         ///< of a displacement, relative
  double odometry_slip_sigma = 0.005;                         ///< across it, relative to the path
  double odometry_sigma_m = 0.003;                            ///< of a displacement that is nothing
};

struct MountCalibration {
  RigidTransform T_base_camera = RigidTransform::Identity();
  RollPitchYaw angles, sigma;  ///< of T_base_camera, about the fixed axes of base_link
  int stands = 0, places = 0;
  double chi2 = 0;
  int degrees_of_freedom = 0;  ///< chi2 should be about this
  double beacon_height_m = 0;  ///< mean, over the camera
};

/// How far straight on the truck has to drive, and stand again, for yaw's sigma to come down to the limit; 0: it is
/// there (docs/math/mount_calibration.md, equation 3).
/// @param limit_rad above params.odometry_slip_sigma: no leg tells more than the wheels' own slip
double straight_leg_m(const MountCalibration& found, const MountCalibrationParams& params, double limit_rad);

/// Roll, pitch and yaw of the camera in base_link from stands at several headings (docs/math/mount_calibration.md). A
/// mount that is tilted turns with the truck, a floor that slopes does not: that tells them apart. Yaw comes from where
/// the wheels say that the truck went, and from the camera's way around base_link in a turn.
/// @return why not, and what would help: too few stands, headings or beacons, or bearings that fit no mount
Result<MountCalibration, std::string> calibrate_mount(const std::vector<Stand>& stands,
                                                      const MountCalibrationParams& params);

}  // namespace lodestar
