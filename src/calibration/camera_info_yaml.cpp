#include <iomanip>
#include <sstream>

#include "lodestar/calibration/lens_calibration.hpp"

namespace lodestar {
namespace {

void add_matrix(std::ostringstream& yaml, const char* name, int rows, int columns, const std::vector<double>& data) {
  yaml << name << ":\n  rows: " << rows << "\n  cols: " << columns << "\n  data: [";
  for (std::size_t i = 0; i < data.size(); ++i) yaml << (i > 0 ? ", " : "") << data[i];
  yaml << "]\n";
}

}  // namespace

std::string camera_info_yaml(const CameraIntrinsics& intrinsics, const std::string& camera_name) {
  const double fx = intrinsics.fx_px, fy = intrinsics.fy_px, cx = intrinsics.cx_px, cy = intrinsics.cy_px;
  const auto& k = intrinsics.coefficients;
  std::ostringstream yaml;
  yaml << std::setprecision(10) << "image_width: " << intrinsics.width_px << "\nimage_height: " << intrinsics.height_px
       << "\ncamera_name: " << camera_name << "\n";
  add_matrix(yaml, "camera_matrix", 3, 3, {fx, 0, cx, 0, fy, cy, 0, 0, 1});
  yaml << "distortion_model: equidistant\n";
  add_matrix(yaml, "distortion_coefficients", 1, 4, {k[0], k[1], k[2], k[3]});
  add_matrix(yaml, "rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  add_matrix(yaml, "projection_matrix", 3, 4, {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0});
  return yaml.str();
}

}  // namespace lodestar
