#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/image.hpp"
#include "support/noise.hpp"

namespace lodestar::test {

/// What a camera sees of a flat picture: each pixel is the mean of rays through its area, by the lens's model at its
/// middle and that model's slope (0.001 px within a pixel of a lens of 200 px), blurred and with noise.
class BoardRenderer {
 public:
  static constexpr int kRays = 4;          ///< each way in a pixel
  static constexpr double kBlur_px = 0.7;  ///< of the lens, sigma

  explicit BoardRenderer(const CameraModel& camera)
      : size_(camera.intrinsics().width_px, camera.intrinsics().height_px) {
    for (int v = 0; v < size_.height; ++v)
      for (int u = 0; u < size_.width; ++u) {
        const auto bearing = camera.bearing(Eigen::Vector2d(u, v));
        for (int i = 0; i < kRays * kRays; ++i) {
          const Eigen::Vector2d within((i % kRays + 0.5) / kRays - 0.5, (i / kRays + 0.5) / kRays - 0.5);
          rays_.push_back(bearing ? (bearing->direction + bearing->J_direction_pixel * within).cast<float>().eval()
                                  : Eigen::Vector3f::Zero());
        }
      }
  }

  /// @param picture grey, its upper left corner at board (0, 0), x to the right, y down, or up when `y_up`
  cv::Mat render(const cv::Mat& picture, double pixels_per_m, const RigidTransform& T_camera_board, bool y_up,
                 std::uint64_t seed) const {
    constexpr float kWall = 110;
    Noise noise(seed);
    const Eigen::Matrix3f R = T_camera_board.linear().transpose().cast<float>();
    const Eigen::Vector3f eye = (T_camera_board.inverse() * Eigen::Vector3d::Zero()).cast<float>();
    const auto scale = static_cast<float>(pixels_per_m);
    const auto on_picture = [&](const Eigen::Vector3f& ray) {  // px; empty behind the camera
      const Eigen::Vector3f d = R * ray;
      const float range = -eye.z() / d.z();
      const float x = (eye.x() + range * d.x()) * scale, y = (eye.y() + range * d.y()) * scale;
      return range > 0 ? std::optional(cv::Point2f(x, y_up ? picture.rows - y : y)) : std::nullopt;
    };
    const auto within = [&](const std::optional<cv::Point2f>& at, float margin) {
      return at && at->x >= -margin && at->y >= -margin && at->x < picture.cols + margin &&
             at->y < picture.rows + margin;
    };
    const float pixel = 0.03f * scale;  // wider than a pixel's area on the board
    cv::Mat image(size_, CV_32FC1);
    const Eigen::Vector3f* ray = rays_.data();
    for (int v = 0; v < size_.height; ++v)
      for (int u = 0; u < size_.width; ++u, ray += kRays * kRays) {
        float sum = kWall * kRays * kRays;
        if (within(on_picture(*ray), pixel)) {
          for (int i = 0; i < kRays * kRays; ++i) {
            const auto at = on_picture(ray[i]);
            if (within(at, 0))
              sum += picture.at<std::uint8_t>(static_cast<int>(at->y), static_cast<int>(at->x)) - kWall;
          }
        }
        image.at<float>(v, u) = 20 + 0.8f * sum / (kRays * kRays) + static_cast<float>(noise.normal());
      }
    cv::GaussianBlur(image, image, cv::Size(), kBlur_px);
    cv::Mat grey;
    image.convertTo(grey, CV_8U);
    return grey;
  }

 private:
  cv::Size size_;
  std::vector<Eigen::Vector3f> rays_;
};

/// The image as the core sees it; `pixels` must outlive it.
inline Image image_of(const cv::Mat& pixels) {
  Image image;
  image.width_px = pixels.cols;
  image.height_px = pixels.rows;
  image.stride_bytes = pixels.step;
  image.data = pixels.data;
  return image;
}

/// A board held before the camera so that its middle is seen at a direction, tilted against it.
inline RigidTransform board_in_view(const Eigen::Vector2d& middle_m, double range_m, double off_axis_rad,
                                    double azimuth_rad, const Eigen::Vector3d& tilt) {
  const Eigen::Vector3d axis(-std::sin(azimuth_rad), std::cos(azimuth_rad), 0);
  const Eigen::Matrix3d towards = so3_exp(off_axis_rad * axis);
  RigidTransform T = RigidTransform::Identity();
  T.linear() = towards * so3_exp(tilt);
  T.translation() =
      towards * Eigen::Vector3d(0, 0, range_m) - T.linear() * Eigen::Vector3d(middle_m.x(), middle_m.y(), 0);
  return T;
}

}  // namespace lodestar::test
