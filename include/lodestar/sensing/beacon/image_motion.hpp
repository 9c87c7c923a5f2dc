#pragma once

#include <deque>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/motion.hpp"

namespace lodestar {

/// How the image of the ceiling moves while the truck drives: gyro and odometry, integrated into the camera's motion
/// between two instants. Samples may come late or out of order by up to the buffer; what is missing is extrapolated.
class ImageMotion {
 public:
  explicit ImageMotion(double buffer_s = 3.0);

  void set_camera(std::shared_ptr<const CameraModel> model, const RigidTransform& T_base_camera);
  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);
  void reset();

  /// Motion of the camera: maps coordinates of the camera at `now` to the camera at `then`. Identity where nothing is
  /// known of the motion (a camera alone).
  RigidTransform T_then_now(Stamp then, Stamp now) const;

 private:
  struct Rate {
    Stamp stamp;
    Eigen::Vector3d value;
  };
  double buffer_s_;
  RigidTransform T_base_camera_ = RigidTransform::Identity();
  std::deque<Rate> angular_, linear_;
};

}  // namespace lodestar
