#include "lodestar/ros/convert/camera_info.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {
namespace {

struct LensModel {
  CameraIntrinsics::Distortion distortion;
  const char* name;
  std::size_t coefficients;
};
constexpr LensModel kLensModels[] = {
    {CameraIntrinsics::Distortion::kEquidistant, "equidistant", 4},
    {CameraIntrinsics::Distortion::kPlumbBob, "plumb_bob", 5},
    {CameraIntrinsics::Distortion::kRationalPolynomial, "rational_polynomial", 8},
};

const LensModel* find_model(const std::string& name) {
  for (const LensModel& model : kLensModels)
    if (name == model.name) return &model;
  return nullptr;
}

const LensModel& find_model(CameraIntrinsics::Distortion distortion) {
  return *std::find_if(std::begin(kLensModels), std::end(kLensModels),
                       [distortion](const LensModel& model) { return model.distortion == distortion; });
}

bool all_finite(const double* first, std::size_t n) {
  return std::all_of(first, first + n, [](double value) { return std::isfinite(value); });
}

}  // namespace

Result<CameraIntrinsics, std::string> intrinsics_from(const sensor_msgs::CameraInfo& message) {
  const LensModel* model = find_model(message.distortion_model);
  if (!model) {
    return "distortion_model is '" + message.distortion_model +
           "', it has to be equidistant, plumb_bob or rational_polynomial: calibrate the camera with one of them";
  }
  if (message.D.size() != model->coefficients) {
    return "D has " + std::to_string(message.D.size()) + " numbers, " + model->name + " has " +
           std::to_string(model->coefficients) + ": calibrate the camera anew or correct its calibration file";
  }
  if (!all_finite(message.K.data(), message.K.size()) || !all_finite(message.D.data(), message.D.size())) {
    return std::string("K or D holds NaN or infinity: correct the camera's calibration file");
  }
  if (message.width == 0 || message.height == 0 || message.width > 65535 || message.height > 65535) {
    return "the image size is " + std::to_string(message.width) + " x " + std::to_string(message.height) +
           ", each side has to be 1 to 65535: correct the camera's calibration file";
  }
  if (message.K[0] <= 0 || message.K[4] <= 0) {
    return "the focal lengths in K are " + std::to_string(message.K[0]) + " and " + std::to_string(message.K[4]) +
           ", they have to be above 0: calibrate the camera (a driver sends zeros when it has no calibration)";
  }
  if (message.K[1] != 0 || message.K[3] != 0 || message.K[6] != 0 || message.K[7] != 0 || message.K[8] != 1) {
    return std::string("K is not of the form [fx 0 cx; 0 fy cy; 0 0 1]: skew is not supported, calibrate without it");
  }
  if (message.binning_x > 1 || message.binning_y > 1) {
    return std::string("binning is above 1: calibrate the camera in the mode that it runs in");
  }
  if (message.roi.x_offset != 0 || message.roi.y_offset != 0 ||
      (message.roi.width != 0 && message.roi.width != message.width) ||
      (message.roi.height != 0 && message.roi.height != message.height)) {
    return std::string("roi is not the full image: calibrate the camera in the mode that it runs in");
  }

  CameraIntrinsics intrinsics;
  intrinsics.distortion = model->distortion;
  intrinsics.width_px = static_cast<int>(message.width);
  intrinsics.height_px = static_cast<int>(message.height);
  intrinsics.fx_px = message.K[0];
  intrinsics.cx_px = message.K[2];
  intrinsics.fy_px = message.K[4];
  intrinsics.cy_px = message.K[5];
  std::copy(message.D.begin(), message.D.end(), intrinsics.coefficients.begin());
  return intrinsics;
}

sensor_msgs::CameraInfo camera_info_message(const CameraIntrinsics& intrinsics, Stamp stamp,
                                            const std::string& frame_id) {
  const LensModel& model = find_model(intrinsics.distortion);
  sensor_msgs::CameraInfo message;
  message.header.stamp = ros_time(stamp);
  message.header.frame_id = frame_id;
  message.width = static_cast<std::uint32_t>(intrinsics.width_px);
  message.height = static_cast<std::uint32_t>(intrinsics.height_px);
  message.distortion_model = model.name;
  message.D.assign(intrinsics.coefficients.begin(),
                   intrinsics.coefficients.begin() + static_cast<std::ptrdiff_t>(model.coefficients));
  const double fx = intrinsics.fx_px, fy = intrinsics.fy_px, cx = intrinsics.cx_px, cy = intrinsics.cy_px;
  message.K = {fx, 0, cx, 0, fy, cy, 0, 0, 1};
  message.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.P = {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0};
  return message;
}

}  // namespace lodestar
