#pragma once

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Geometry>

#include "lodestar/base/measurement/bearing.hpp"

namespace lodestar {

/// How the unknowns of the mount's calibration lie in memory.
using MountUnknowns =
    Eigen::Matrix<double, 6, 1>;  // turn of the camera in base_link, from the first guess; its shift, m
using StandUnknowns = Eigen::Matrix<double, 5, 1>;  // x, y (m), yaw of base_link in map; its tilt against the place's
using PlaceUnknowns = Eigen::Matrix<double, 3, 1>;  // tilt of the floor about map's x and y, its height, m

/// A bearing against the beacon that it is of, whitened (mount_calibration.md, equation 1).
struct BearingTerm {
  Eigen::Vector3d position_map;
  Eigen::Matrix<double, 2, 3> whitened_tangent;  ///< zero along the bearing
  Eigen::Matrix3d R_base_camera;                 ///< first guess
  Eigen::Vector3d t_base_camera;

  template <class T>
  using Vector3 = Eigen::Matrix<T, 3, 1>;

  template <class T>
  static Vector3<T> turn_back(const Vector3<T>& angle_axis, const Vector3<T>& point) {
    const Vector3<T> back = -angle_axis;
    Vector3<T> turned;
    ceres::AngleAxisRotatePoint(back.data(), point.data(), turned.data());
    return turned;
  }

  template <class T>
  bool operator()(const T* mount, const T* stand, const T* place, const T* beacon, T* residual) const {
    const Vector3<T> arm_map(T(position_map.x()) + beacon[0] - stand[0], T(position_map.y()) + beacon[1] - stand[1],
                             T(position_map.z()) + beacon[2] - place[2]);
    const Vector3<T> tilt(place[0] + stand[3], place[1] + stand[4], T(0)), yaw(T(0), T(0), stand[2]);
    const Vector3<T> arm_base = turn_back(yaw, turn_back(tilt, arm_map));
    const Vector3<T> from_camera = arm_base - t_base_camera.cast<T>() - Vector3<T>(mount[3], mount[4], mount[5]);
    const Vector3<T> guessed = R_base_camera.transpose().cast<T>() * from_camera;
    const Vector3<T> seen = turn_back(Vector3<T>(mount[0], mount[1], mount[2]), guessed).normalized();
    Eigen::Map<Eigen::Matrix<T, 2, 1>>{residual} = whitened_tangent.cast<T>() * seen;
    return true;
  }
};

/// Where the truck went between two stands, as the wheels say, in axes halfway between its headings (equation 2).
struct DisplacementTerm {
  Eigen::Vector2d displacement_m;
  Eigen::Matrix2d whitening;

  template <class T>
  bool operator()(const T* from, const T* to, T* residual) const {
    const T heading = (from[2] + to[2]) * T(0.5), x = to[0] - from[0], y = to[1] - from[1];
    const T c = ceres::cos(heading), s = ceres::sin(heading);
    const Eigen::Matrix<T, 2, 1> off(c * x + s * y - T(displacement_m.x()), -s * x + c * y - T(displacement_m.y()));
    Eigen::Map<Eigen::Matrix<T, 2, 1>>{residual} = whitening.cast<T>() * off;
    return true;
  }
};

/// Unknowns that are zero but for a sigma each; a sigma of 0 leaves one free.
template <int kSize>
struct PriorTerm {
  Eigen::Matrix<double, kSize, 1> sigma;

  template <class T>
  bool operator()(const T* unknowns, T* residual) const {
    for (int i = 0; i < kSize; ++i) residual[i] = sigma[i] > 0 ? unknowns[i] / T(sigma[i]) : T(0);
    return true;
  }
};

}  // namespace lodestar
