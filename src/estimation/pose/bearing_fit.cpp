#include "lodestar/estimation/pose/bearing_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// A further step that gains less moves the pose by less than a thirtieth of its own sigma.
constexpr double kConverged_chi2 = 1e-3;
/// A step may raise chi2 by so much: the survey's weights change a little with the ranges.
constexpr double kHarmless_chi2 = 0.1;
constexpr int kMaxIterations = 20, kMaxHalvings = 8;

/// Two unit vectors that make a right-handed frame with a third: Duff et al., "Building an orthonormal basis,
/// revisited", JCGT 2017.
std::pair<Eigen::Vector3d, Eigen::Vector3d> tangents(const Eigen::Vector3d& n) {
  const double sign = std::copysign(1.0, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  return {{1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()}, {b, sign + n.y() * n.y() * a, -n.y()}};
}

Eigen::Matrix2d inverse(const Eigen::Matrix2d& S) {
  const double per_det = 1 / (S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0));
  Eigen::Matrix2d out;
  out << S(1, 1) * per_det, -S(0, 1) * per_det, -S(1, 0) * per_det, S(0, 0) * per_det;
  return out;
}

/// What gravity and R_map_level disagree in, about the levelled x and y axes.
Eigen::Vector2d tilt_rad(const Eigen::Matrix3d& R_map_level) { return {R_map_level(2, 1), -R_map_level(2, 0)}; }

/// What a further step would gain after one that gained gain_chi2: the square of how far the model bends over the step,
/// seen from the nearest beacon, and what the residuals, milliradians, add to the model's slope.
double next_gain_chi2(double gain_chi2, const PoseStep& step, double per_depth) {
  return gain_chi2 * (2 * (per_depth * per_depth * step.head<3>().squaredNorm() + step.tail<3>().squaredNorm()) + 1e-5);
}

LevelledPose moved(const LevelledPose& pose, const PoseStep& step) {
  const Eigen::Quaterniond turn(1, 0.5 * step(kTilt), 0.5 * step(kTilt + 1), 0.5 * step(kYaw));
  return {pose.camera_map + pose.R_map_level * step.head<3>(), pose.R_map_level * turn.normalized().toRotationMatrix()};
}

}  // namespace

LevelledPose LevelledPose::of(const TwoBeaconRoot& root) {
  LevelledPose pose;
  pose.camera_map = root.camera_map;
  pose.R_map_level << root.yaw_cos, -root.yaw_sin, 0, root.yaw_sin, root.yaw_cos, 0, 0, 0, 1;
  return pose;
}

BearingFit::BearingFit(const std::vector<BeaconBearing>& bearings, const Eigen::Matrix3d& R_level_camera,
                       double tilt_sigma_rad)
    : rays_(bearings.size(), boost::container::default_init), tilt_variance_(tilt_sigma_rad * tilt_sigma_rad) {
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const BeaconBearing& bearing = bearings[i];
    const auto [x_camera, y_camera] = tangents(bearing.direction_camera);
    const Eigen::Vector3d Cx = bearing.covariance * x_camera, Cy = bearing.covariance * y_camera;
    Ray& ray = rays_[i];
    ray.bearing.beacon_map = bearing.position_map;
    ray.bearing.direction_level.noalias() = R_level_camera * bearing.direction_camera;
    ray.x_level.noalias() = R_level_camera * x_camera;
    ray.y_level.noalias() = R_level_camera * y_camera;
    ray.covariance = {x_camera.dot(Cx), x_camera.dot(Cy), y_camera.dot(Cy)};
    ray.survey_variance_m2 = bearing.position_sigma_m * bearing.position_sigma_m;
  }
}

bool BearingFit::valid() const {
  constexpr double kLeast = 1e-16;
  return std::all_of(rays_.begin(), rays_.end(), [](const Ray& ray) {
    const Covariance2 rest{ray.covariance.xx - kLeast, ray.covariance.xy, ray.covariance.yy - kLeast};
    return rest.xx > 0 && rest.determinant() > 0;
  });
}

/// A bearing's part of the normal equations, before it is summed.
struct BearingFit::Rows {
  std::array<PoseStep, 2> J;
  Covariance2 S;
  double x_rad, y_rad, per_depth;
};

void BearingFit::set_rows(int i, const Residual& r, Rows& out) const {
  const Ray& ray = rays_[i];
  const Eigen::Vector3d &m = ray.bearing.direction_level, &w = r.arm_level;
  const auto set = [&](const Eigen::Vector3d& tangent, double value_rad, PoseStep& row) {
    const double x = r.per_depth * (tangent.x() - value_rad * m.x());
    const double y = r.per_depth * (tangent.y() - value_rad * m.y());
    const double z = r.per_depth * (tangent.z() - value_rad * m.z());
    row[0] = -x;
    row[1] = -y;
    row[2] = -z;
    row[3] = x * w.y() - y * w.x();
    row[4] = y * w.z() - z * w.y();
    row[5] = z * w.x() - x * w.z();
  };
  set(ray.x_level, r.x_rad, out.J[0]);
  set(ray.y_level, r.y_rad, out.J[1]);
  out.S = r.covariance;
  out.x_rad = r.x_rad;
  out.y_rad = r.y_rad;
  out.per_depth = r.per_depth;
}

BearingFit::Covariance2 BearingFit::innovation(int i, const Residual& r, const PoseStepCovariance& P) const {
  Rows rows;
  set_rows(i, r, rows);
  const PoseStep PJx = P * rows.J[0], PJy = P * rows.J[1];
  return {rows.J[0].dot(PJx), rows.J[0].dot(PJy), rows.J[1].dot(PJy)};
}

void BearingFit::Normal::add(const Rows& r) {
  const Covariance2 W = r.S.inverse();
  const PoseStep WJx = W.xx * r.J[0] + W.xy * r.J[1], WJy = W.xy * r.J[0] + W.yy * r.J[1];
  A.noalias() += WJx * r.J[0].transpose();
  A.noalias() += WJy * r.J[1].transpose();
  g += r.x_rad * WJx + r.y_rad * WJy;
  chi2 += W.of(r.x_rad, r.y_rad);
  nearest_per_m = std::max(nearest_per_m, r.per_depth);
}

void BearingFit::add_gravity(const LevelledPose& pose, Normal& normal) const {
  const Eigen::Vector2d tilt = tilt_rad(pose.R_map_level);
  normal.A.diagonal().tail<2>().array() += 1 / tilt_variance_;
  normal.g.tail<2>() += tilt / tilt_variance_;
  normal.chi2 += tilt.squaredNorm() / tilt_variance_;
}

BearingFit::Normal BearingFit::normal_equations(const LevelledPose& pose, const Selection& selection) const {
  boost::container::small_vector<Rows, 16> all(size(), boost::container::default_init);
  int count = 0;
  for (int i = 0; i < size(); ++i)
    if (selection[i]) set_rows(i, residual(i, pose), all[count++]);
  Normal normal;
  for (int i = 0; i < count; ++i) normal.add(all[i]);
  add_gravity(pose, normal);
  return normal;
}

/// The normal equations solved by blocks: V for position and yaw with tilt held, K how they follow tilt, and tilt's own
/// covariance, which is gravity's alone where gravity is given (equation 14).
struct BearingFit::Solution {
  Eigen::Matrix4d V;
  Eigen::Matrix<double, 4, 2> K;
  Eigen::Matrix2d tilt;
  PoseStep step;       ///< to the answer
  PoseStep explained;  ///< to what explains all: the same but where gravity is given
  bool regular;

  PoseStepCovariance covariance() const {
    PoseStepCovariance P;
    P.topRightCorner<4, 2>().noalias() = K * tilt;
    P.topLeftCorner<4, 4>() = V;
    P.topLeftCorner<4, 4>().noalias() += P.topRightCorner<4, 2>() * K.transpose();
    P.bottomLeftCorner<2, 4>() = P.topRightCorner<4, 2>().transpose();
    P.bottomRightCorner<2, 2>() = tilt;
    return P;
  }
};

BearingFit::Solution BearingFit::solve(const Normal& normal, Gravity gravity) const {
  Solution out;
  out.V = normal.A.topLeftCorner<4, 4>().inverse();
  out.K.noalias() = -out.V * normal.A.topRightCorner<4, 2>();
  const Eigen::Matrix2d S = normal.A.bottomRightCorner<2, 2>() + normal.A.topRightCorner<4, 2>().transpose() * out.K;
  out.tilt = inverse(S);
  const Eigen::Vector4d tilt_held = -out.V * normal.g.head<4>();
  const Eigen::Vector2d tilt_step = -out.tilt * (normal.g.tail<2>() + out.K.transpose() * normal.g.head<4>());
  out.explained << tilt_held + out.K * tilt_step, tilt_step;
  out.step = out.explained;
  if (gravity == Gravity::kGiven) {
    out.step << tilt_held, Eigen::Vector2d::Zero();
    out.tilt = tilt_variance_ * Eigen::Matrix2d::Identity();
  }
  out.regular = out.V.diagonal().minCoeff() > 0 && out.tilt.diagonal().minCoeff() > 0 && out.V.allFinite() &&
                out.explained.allFinite();
  return out;
}

PoseFit BearingFit::of_root(const TwoBeaconRoot& root, int first, int second) const {
  PoseFit out;
  out.pose = out.explained = LevelledPose::of(root);
  const Ray* rays[] = {&rays_[first], &rays_[second]};
  Covariance2 S[2];
  Eigen::Matrix4d J;
  Eigen::Matrix<double, 4, 2> J_tilt;
  for (int i = 0; i < 2; ++i) {  // equation 11 with a residual of 0
    const Eigen::Vector3d &x = rays[i]->x_level, &y = rays[i]->y_level;
    const double per_depth = 1 / root.depth_m[i];
    J.row(2 * i) << -per_depth * x.x(), -per_depth * x.y(), -per_depth * x.z(), -y.z();
    J.row(2 * i + 1) << -per_depth * y.x(), -per_depth * y.y(), -per_depth * y.z(), x.z();
    J_tilt.row(2 * i) << -y.x(), -y.y();
    J_tilt.row(2 * i + 1) << x.x(), x.y();
    S[i] = rays[i]->spread(per_depth);
  }
  const Eigen::Matrix4d X = J.inverse();
  const Eigen::Matrix<double, 4, 2> K = -X * J_tilt;
  Eigen::Matrix4d XS;
  for (int i = 0; i < 2; ++i) {
    XS.col(2 * i) = S[i].xx * X.col(2 * i) + S[i].xy * X.col(2 * i + 1);
    XS.col(2 * i + 1) = S[i].xy * X.col(2 * i) + S[i].yy * X.col(2 * i + 1);
  }
  out.covariance.topRightCorner<4, 2>() = tilt_variance_ * K;
  out.covariance.topLeftCorner<4, 4>().noalias() = XS * X.transpose();
  out.covariance.topLeftCorner<4, 4>().noalias() += out.covariance.topRightCorner<4, 2>() * K.transpose();
  out.covariance.bottomLeftCorner<2, 4>() = out.covariance.topRightCorner<4, 2>().transpose();
  out.covariance.diagonal().tail<2>().setConstant(tilt_variance_);
  out.regular = X.allFinite() && root.miss_m == 0;
  return out;
}

/// @param from where the solution steps off
PoseFit BearingFit::ended(const LevelledPose& from, const LevelledPose& at, const Normal& normal,
                          const Solution& solution, Gravity gravity) {
  const double chi2 = normal.chi2 + normal.g.dot(solution.explained);
  return {at, gravity == Gravity::kGiven ? moved(from, solution.explained) : at, solution.covariance(), chi2,
          solution.regular};
}

PoseFit BearingFit::fit(const LevelledPose& start, const Selection& selection, Gravity gravity) const {
  LevelledPose pose = start;
  Normal normal = normal_equations(pose, selection);
  Solution solution = solve(normal, gravity);
  for (int iteration = 0; iteration < kMaxIterations && solution.regular; ++iteration) {
    const double gain_chi2 = -normal.g.dot(solution.step);
    PoseStep step = solution.step;
    LevelledPose next = moved(pose, step);
    if (next_gain_chi2(gain_chi2, step, normal.nearest_per_m) < kConverged_chi2)
      return ended(pose, next, normal, solution, gravity);
    Normal normal_next = normal_equations(next, selection);
    const auto worse = [&] { return !(normal_next.chi2 <= normal.chi2 + kHarmless_chi2); };
    for (int halving = 0; halving < kMaxHalvings && worse(); ++halving) {
      step *= 0.5;
      next = moved(pose, step);
      normal_next = normal_equations(next, selection);
    }
    if (worse()) break;
    pose = next;
    normal = normal_next;
    solution = solve(normal, gravity);
  }
  return ended(pose, pose, normal, solution, gravity);
}

}  // namespace lodestar
