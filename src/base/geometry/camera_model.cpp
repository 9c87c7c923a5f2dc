#include "lodestar/base/geometry/camera_model.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <sstream>

#include "equidistant_lens.hpp"
#include "pinhole_lens.hpp"

namespace lodestar {
namespace {

using Distortion = CameraIntrinsics::Distortion;
using ModelOrError = Result<std::shared_ptr<const CameraModel>, std::string>;

int coefficient_count(Distortion distortion) {
  switch (distortion) {
    case Distortion::kEquidistant:
      return 4;
    case Distortion::kPlumbBob:
      return 5;
    case Distortion::kRationalPolynomial:
      return 8;
  }
  return 0;
}

template <class Value>
std::string wrong(const std::string& what, Value value, const std::string& limit) {
  std::ostringstream text;
  text << what << " is " << value << ": it must be " << limit;
  return text.str();
}

/// What is wrong with the numbers, or nothing.
std::string complaint(const CameraIntrinsics& in) {
  if (in.width_px <= 0) return wrong("width_px", in.width_px, "above 0");
  if (in.height_px <= 0) return wrong("height_px", in.height_px, "above 0");
  if (!(in.fx_px > 0 && std::isfinite(in.fx_px))) return wrong("fx_px", in.fx_px, "finite and above 0");
  if (!(in.fy_px > 0 && std::isfinite(in.fy_px))) return wrong("fy_px", in.fy_px, "finite and above 0");
  if (!std::isfinite(in.cx_px)) return wrong("cx_px", in.cx_px, "finite");
  if (!std::isfinite(in.cy_px)) return wrong("cy_px", in.cy_px, "finite");
  const int used = coefficient_count(in.distortion);
  for (int i = 0; i < static_cast<int>(in.coefficients.size()); ++i) {
    const std::string what = "distortion coefficient " + std::to_string(i + 1);
    if (!std::isfinite(in.coefficients[i])) return wrong(what, in.coefficients[i], "finite");
    if (i >= used && in.coefficients[i] != 0)
      return wrong(what, in.coefficients[i], "0, since this distortion model has " + std::to_string(used));
  }
  return {};
}

bool equidistant(const CameraIntrinsics& in) { return in.distortion == Distortion::kEquidistant; }

/// The unit vector at angle theta from the axis, in the direction of the distorted point, and its Jacobian by it.
CameraModel::Bearing equidistant_bearing(const EquidistantLens& lens, const Eigen::Vector2d& distorted, double limit) {
  const double radius = std::hypot(distorted.x(), distorted.y());
  const double theta = invert_rising([&lens](double t) { return lens.distort(t); }, radius, limit);
  const double dtheta = 1 / lens.distort(theta).slope;
  const Eigen::Vector2d azimuth = radius > 0 ? Eigen::Vector2d(distorted / radius) : Eigen::Vector2d::UnitX();
  const double across = radius > 0 ? std::sin(theta) / radius : 1.0;
  CameraModel::Bearing out;
  out.direction << std::sin(theta) * azimuth, std::cos(theta);
  out.J_direction_pixel.topRows<2>() =
      across * Eigen::Matrix2d::Identity() + (std::cos(theta) * dtheta - across) * azimuth * azimuth.transpose();
  out.J_direction_pixel.bottomRows<1>() = -std::sin(theta) * dtheta * azimuth.transpose();
  return out;
}

CameraModel::Bearing pinhole_bearing(const PinholeLens& lens, const Eigen::Vector2d& point) {
  const double norm = point.homogeneous().norm();
  CameraModel::Bearing out;
  out.direction = point.homogeneous() / norm;
  Eigen::Matrix<double, 3, 2> J = -out.direction * out.direction.head<2>().transpose();
  J.topRows<2>() += Eigen::Matrix2d::Identity();
  out.J_direction_pixel = J / norm * lens.distort(point).J.inverse();
  return out;
}

CameraModel::Projection equidistant_projection(const EquidistantLens& lens, const Eigen::Vector3d& point) {
  const double across = std::hypot(point.x(), point.y());
  const double range = std::hypot(across, point.z());
  const CurvePoint at = lens.distort(std::atan2(across, point.z()));
  const Eigen::Vector2d azimuth = across > 0 ? Eigen::Vector2d(point.head<2>() / across) : Eigen::Vector2d::UnitX();
  const double turning = across > 0 ? at.value / across : 1 / point.z();
  const double radial = at.slope * (point.z() / range / range);
  CameraModel::Projection out;
  out.pixel = at.value * azimuth;
  out.J_pixel_point.leftCols<2>() =
      turning * Eigen::Matrix2d::Identity() + (radial - turning) * azimuth * azimuth.transpose();
  out.J_pixel_point.col(2) = -at.slope * (across / range / range) * azimuth;
  return out;
}

CameraModel::Projection pinhole_projection(const PinholeLens& lens, const Eigen::Vector3d& point) {
  const Eigen::Vector2d undistorted = point.hnormalized();
  const PinholeLens::Distorted at = lens.distort(undistorted);
  Eigen::Matrix<double, 2, 3> J;
  J << Eigen::Matrix2d::Identity(), -undistorted;
  return {at.point, at.J * J / point.z()};
}

}  // namespace

CameraModel::CameraModel(const CameraIntrinsics& intrinsics) : intrinsics_(intrinsics) {
  if (equidistant(intrinsics_)) {
    const EquidistantLens lens(intrinsics_.coefficients);
    max_radius_ = lens.limit_rad();
    max_distorted_radius_ = lens.distort(max_radius_).value;
  } else {
    const PinholeLens lens(intrinsics_.coefficients);
    max_radius_ = lens.limit();
    max_distorted_radius_ = lens.distort_radius(max_radius_).value;
  }
}

ModelOrError CameraModel::create(const CameraIntrinsics& intrinsics) {
  const std::string error = complaint(intrinsics);
  if (!error.empty()) return error;
  const std::shared_ptr<const CameraModel> model(new CameraModel(intrinsics));
  const double reach_px = model->max_distorted_radius_ * std::fmin(intrinsics.fx_px, intrinsics.fy_px);
  if (!(reach_px >= 1)) return wrong("radius in px up to which the distortion is monotonic", reach_px, "at least 1");
  return model;
}

std::optional<CameraModel::Bearing> CameraModel::bearing(const Eigen::Vector2d& pixel) const {
  if (!pixel.allFinite()) return std::nullopt;
  const Eigen::Vector2d focal(intrinsics_.fx_px, intrinsics_.fy_px);
  const Eigen::Vector2d distorted =
      (pixel - Eigen::Vector2d(intrinsics_.cx_px, intrinsics_.cy_px)).cwiseQuotient(focal);
  Bearing out;
  if (equidistant(intrinsics_)) {
    if (!(distorted.norm() <= max_distorted_radius_)) return std::nullopt;
    out = equidistant_bearing(EquidistantLens(intrinsics_.coefficients), distorted, max_radius_);
  } else {
    const PinholeLens lens(intrinsics_.coefficients);
    const std::optional<Eigen::Vector2d> point = lens.undistort(distorted, max_radius_);
    if (!point) return std::nullopt;
    out = pinhole_bearing(lens, *point);
  }
  out.J_direction_pixel *= focal.cwiseInverse().asDiagonal();
  return out;
}

std::optional<CameraModel::Projection> CameraModel::project(const Eigen::Vector3d& point_camera) const {
  const double scale = point_camera.cwiseAbs().maxCoeff();
  if (!point_camera.allFinite() || scale == 0) return std::nullopt;
  Projection out;
  if (equidistant(intrinsics_)) {
    const double across = std::hypot(point_camera.x(), point_camera.y());
    if (std::atan2(across, point_camera.z()) > max_radius_) return std::nullopt;
    out = equidistant_projection(EquidistantLens(intrinsics_.coefficients), point_camera);
  } else {
    if (!(point_camera.z() > 0) || !(point_camera.hnormalized().norm() <= max_radius_)) return std::nullopt;
    out = pinhole_projection(PinholeLens(intrinsics_.coefficients), point_camera);
  }
  const Eigen::Vector2d focal(intrinsics_.fx_px, intrinsics_.fy_px);
  out.pixel = out.pixel.cwiseProduct(focal) + Eigen::Vector2d(intrinsics_.cx_px, intrinsics_.cy_px);
  out.J_pixel_point = focal.asDiagonal() * out.J_pixel_point;
  if (!out.pixel.allFinite() || !out.J_pixel_point.allFinite()) return std::nullopt;
  return out;
}

bool CameraModel::contains(const Eigen::Vector2d& pixel) const {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() <= intrinsics_.width_px - 0.5 &&
         pixel.y() <= intrinsics_.height_px - 0.5;
}

}  // namespace lodestar
