#include "board_pose.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace lodestar {
namespace {

/// T_camera_board of a homography of columns r1, r2, t up to scale.
RigidTransform from_homography(Eigen::Matrix3d H) {
  H *= 2 / (H.col(0).norm() + H.col(1).norm());
  Eigen::Matrix3d R;
  R << H.col(0), H.col(1), H.col(0).cross(H.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d UV = svd.matrixU() * svd.matrixV().transpose();
  RigidTransform T = RigidTransform::Identity();
  T.linear() = svd.matrixU() * Eigen::Vector3d(1, 1, UV.determinant()).asDiagonal() * svd.matrixV().transpose();
  T.translation() = H.col(2);
  return T;
}

}  // namespace

std::optional<RigidTransform> board_pose(const BoardView& view, const CameraModel& camera) {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  for (const BoardPoint& point : view) centre_m += point.board_m / static_cast<double>(view.size());
  double scale = 1e-9;
  for (const BoardPoint& point : view) scale = std::max(scale, (point.board_m - centre_m).norm());

  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  Eigen::Vector3d mean_bearing = Eigen::Vector3d::Zero();
  for (const BoardPoint& point : view) {
    const auto bearing = camera.bearing(point.pixel);
    if (!bearing) return std::nullopt;
    mean_bearing += bearing->direction;
    const Eigen::Vector3d place((point.board_m - centre_m).x() / scale, (point.board_m - centre_m).y() / scale, 1);
    const Eigen::Matrix3d cross = skew(bearing->direction);
    Eigen::Matrix<double, 3, 9> rows;
    for (int i = 0; i < 3; ++i) rows.middleCols<3>(3 * i) = place[i] * cross;
    normal += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(normal);
  if (!(eigen.eigenvalues()[1] > 1e-9 * eigen.eigenvalues()[8])) return std::nullopt;
  Eigen::Matrix3d H = Eigen::Map<const Eigen::Matrix3d>(eigen.eigenvectors().col(0).data());
  if (H.col(2).dot(mean_bearing) < 0) H = -H;
  H.leftCols<2>() /= scale;
  RigidTransform T = from_homography(H);
  T.translation() -= T.linear().leftCols<2>() * centre_m;
  return T;
}

}  // namespace lodestar
