#include "lodestar/calibration/mount_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "lodestar/base/common/chi_square.hpp"
#include "mount_terms.hpp"

namespace lodestar {
namespace {

constexpr std::size_t kFewestStands = 4;
constexpr std::size_t kFewestBearings = 3;

/// First guess of where the truck stood, with the floor flat and the camera mounted as it is said to be.
struct Pose2 {
  double x_m, y_m, yaw_rad;
};

/// Heading and position from directions and beacons: the turn that lines up horizontal directions between all pairs of
/// beacons at the height that the mount gives.
Pose2 stand_pose(const Stand& stand, const RigidTransform& T_base_camera) {
  std::vector<Eigen::Vector2d> base, map;  // feet of the beacons
  for (const BeaconBearing& bearing : stand.bearings) {
    const Eigen::Vector3d direction_base = T_base_camera.linear() * bearing.direction_camera;
    const double range = (bearing.position_map.z() - T_base_camera.translation().z()) / direction_base.z();
    base.push_back((T_base_camera.translation() + range * direction_base).head<2>());
    map.push_back(bearing.position_map.head<2>());
  }
  Eigen::Vector2d mean_base = Eigen::Vector2d::Zero(), mean_map = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < base.size(); ++i) {
    mean_base += base[i] / static_cast<double>(base.size());
    mean_map += map[i] / static_cast<double>(base.size());
  }
  double sine = 0, cosine = 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const Eigen::Vector2d a = base[i] - mean_base, b = map[i] - mean_map;
    sine += a.x() * b.y() - a.y() * b.x();
    cosine += a.dot(b);
  }
  const double yaw_rad = std::atan2(sine, cosine);
  const Eigen::Vector2d position = mean_map - Eigen::Rotation2Dd(yaw_rad) * mean_base;
  return {position.x(), position.y(), yaw_rad};
}

/// Two rows that measure how far a direction is off, in sigmas.
Eigen::Matrix<double, 2, 3> whitened_tangent(const BeaconBearing& bearing, double common_sigma_rad) {
  Eigen::Matrix<double, 2, 3> tangent;
  tangent.row(0) = bearing.direction_camera.unitOrthogonal().transpose();
  tangent.row(1) = bearing.direction_camera.cross(tangent.row(0).transpose()).transpose();
  const Eigen::Matrix2d covariance = tangent * bearing.covariance * tangent.transpose() +
                                     common_sigma_rad * common_sigma_rad * Eigen::Matrix2d::Identity();
  return covariance.llt().matrixL().solve(tangent);
}

template <class Term, int... kSizes>
ceres::CostFunction* cost(const Term& term) {
  return new ceres::AutoDiffCostFunction<Term, kSizes...>(new Term(term));
}

/// Roll, pitch and yaw by a small turn about the fixed axes.
Eigen::Matrix3d angles_by_turn(const RollPitchYaw& angles) {
  const double cp = std::cos(angles.pitch_rad), sp = std::sin(angles.pitch_rad);
  const double cy = std::cos(angles.yaw_rad), sy = std::sin(angles.yaw_rad);
  Eigen::Matrix3d turn_by_angles;
  turn_by_angles << cy * cp, -sy, 0, sy * cp, cy, 0, -sp, 0, 1;
  return turn_by_angles.inverse();
}

/// The least squares over mount, stands, places and beacons.
class Adjustment {
 public:
  Adjustment(const std::vector<Stand>& stands, const MountCalibrationParams& params);
  Result<MountCalibration, std::string> run();

  /// Length of the mean heading vector: 1 when the truck never turned.
  double one_way() const;

 private:
  void guess_stand(const Stand& stand);
  std::size_t place_of(const Eigen::Vector2d& position);
  void add_bearings(std::size_t stand);
  void add_displacement(std::size_t from);
  void add_priors();
  template <int kSize>
  void add_prior(const Eigen::Matrix<double, kSize, 1>& sigma, double* unknowns) {
    problem_.AddResidualBlock(cost<PriorTerm<kSize>, kSize, kSize>({sigma}), nullptr, unknowns);
  }
  MountCalibration result(double chi2, const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>& P) const;

  const std::vector<Stand>& stands_;
  const MountCalibrationParams& params_;
  MountUnknowns mount_ = MountUnknowns::Zero();
  std::vector<StandUnknowns> at_;
  std::vector<std::size_t> place_;  ///< of each stand
  std::vector<Eigen::Vector2d> place_centres_;
  std::vector<PlaceUnknowns> places_;
  std::map<BeaconId, Eigen::Vector3d> shifts_;  ///< of the beacons from their survey, m
  std::map<BeaconId, double> survey_sigma_m_;
  ceres::Problem problem_;
};

Adjustment::Adjustment(const std::vector<Stand>& stands, const MountCalibrationParams& params)
    : stands_(stands), params_(params) {
  for (const Stand& stand : stands) guess_stand(stand);
  places_.assign(place_centres_.size(), PlaceUnknowns::Zero());
  for (std::size_t i = 0; i < stands.size(); ++i) add_bearings(i);
  for (std::size_t i = 0; i + 1 < stands.size(); ++i) add_displacement(i);
  add_priors();
}

void Adjustment::guess_stand(const Stand& stand) {
  const Pose2 pose = stand_pose(stand, params_.T_base_camera);
  // Half of the turn between two stands is used: whole turns have to be the wheels'.
  const double expected =
      at_.empty() ? pose.yaw_rad : at_.front()[2] + stand.yaw_odom_rad - stands_.front().yaw_odom_rad;
  StandUnknowns at;
  at << pose.x_m, pose.y_m, expected + wrap_angle(pose.yaw_rad - expected), 0, 0;
  at_.push_back(at);
  place_.push_back(place_of({pose.x_m, pose.y_m}));
  for (const BeaconBearing& bearing : stand.bearings) {
    shifts_.emplace(bearing.beacon, Eigen::Vector3d::Zero());
    survey_sigma_m_.emplace(bearing.beacon, bearing.position_sigma_m);
  }
}

std::size_t Adjustment::place_of(const Eigen::Vector2d& position) {
  for (std::size_t i = 0; i < place_centres_.size(); ++i)
    if ((position - place_centres_[i]).norm() < params_.same_place_m) return i;
  place_centres_.push_back(position);
  return place_centres_.size() - 1;
}

void Adjustment::add_bearings(std::size_t stand) {
  for (const BeaconBearing& bearing : stands_[stand].bearings) {
    const BearingTerm term{bearing.position_map, whitened_tangent(bearing, params_.bearing_sigma_rad),
                           params_.T_base_camera.linear(), params_.T_base_camera.translation()};
    problem_.AddResidualBlock(cost<BearingTerm, 2, 6, 5, 3, 3>(term), nullptr, mount_.data(), at_[stand].data(),
                              places_[place_[stand]].data(), shifts_.at(bearing.beacon).data());
  }
}

void Adjustment::add_displacement(std::size_t from) {
  const Stand &a = stands_[from], &b = stands_[from + 1];
  const Eigen::Rotation2Dd to_mean_heading(-0.5 * (a.yaw_odom_rad + b.yaw_odom_rad));
  const double along_m = std::hypot(params_.odometry_sigma_m, params_.odometry_scale_sigma * b.path_m);
  const double across_m = std::hypot(params_.odometry_sigma_m, params_.odometry_slip_sigma * b.path_m);
  const Eigen::Matrix2d whitening = Eigen::Vector2d(1 / along_m, 1 / across_m).asDiagonal();
  problem_.AddResidualBlock(
      cost<DisplacementTerm, 2, 5, 5>({to_mean_heading * (b.position_odom_m - a.position_odom_m), whitening}), nullptr,
      at_[from].data(), at_[from + 1].data());
}

void Adjustment::add_priors() {
  MountUnknowns mount;
  mount << 0, 0, 0, Eigen::Vector3d::Constant(params_.mount_sigma_m);
  add_prior<6>(mount, mount_.data());
  StandUnknowns stand;
  stand << 0, 0, 0, params_.roughness_sigma_rad, params_.roughness_sigma_rad;
  for (StandUnknowns& at : at_) add_prior<5>(stand, at.data());
  const PlaceUnknowns place(params_.floor_sigma_rad, params_.floor_sigma_rad, params_.floor_sigma_m);
  for (PlaceUnknowns& floor : places_) add_prior<3>(place, floor.data());
  for (auto& [beacon, shift] : shifts_)
    add_prior<3>(Eigen::Vector3d::Constant(survey_sigma_m_.at(beacon)), shift.data());
}

double Adjustment::one_way() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const StandUnknowns& at : at_) sum += Eigen::Vector2d(std::cos(at[2]), std::sin(at[2]));
  return sum.norm() / static_cast<double>(at_.size());
}

Result<MountCalibration, std::string> Adjustment::run() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);

  ceres::Covariance covariance(ceres::Covariance::Options{});
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> P;
  if (!covariance.Compute(std::vector<const double*>{mount_.data()}, &problem_) ||
      !covariance.GetCovarianceBlock(mount_.data(), mount_.data(), P.data()))
    return std::string(
        "the stands leave a part of the mount open: stand at more headings, and at two places a few metres apart");
  return result(2 * summary.final_cost, P);
}

MountCalibration Adjustment::result(double chi2, const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>& P) const {
  MountCalibration result;
  result.T_base_camera = params_.T_base_camera;
  result.T_base_camera.rotate(so3_exp(mount_.head<3>()));
  result.angles = roll_pitch_yaw(result.T_base_camera.linear());
  const Eigen::Matrix3d J = angles_by_turn(result.angles) * result.T_base_camera.linear();
  const Eigen::Vector3d sigma = (J * P.topLeftCorner<3, 3>() * J.transpose()).diagonal().cwiseSqrt();
  result.sigma = {sigma.x(), sigma.y(), sigma.z()};
  result.stands = static_cast<int>(stands_.size());
  result.places = static_cast<int>(places_.size());
  int bearings = 0;
  for (const Stand& stand : stands_)
    for (const BeaconBearing& bearing : stand.bearings) {
      ++bearings;
      result.beacon_height_m += bearing.position_map.z() - params_.T_base_camera.translation().z();
    }
  result.beacon_height_m /= bearings;
  result.chi2 = chi2;
  // A prior of no sigma is a residual that says nothing: three of the mount, three of each stand.
  result.degrees_of_freedom = problem_.NumResiduals() - problem_.NumParameters() - 3 - 3 * result.stands;
  return result;
}

}  // namespace

double straight_leg_m(const MountCalibration& found, const MountCalibrationParams& params, double limit_rad) {
  const double now_rad = found.sigma.yaw_rad;
  if (now_rad <= limit_rad) return 0;
  const double leg_rad2 = 1 / (std::pow(limit_rad, -2) - std::pow(now_rad, -2));  // what the leg alone has to tell
  const double tilt_m = params.floor_sigma_rad * found.beacon_height_m;           // shifts a stand by so much
  const double across_m2 = 2 * tilt_m * tilt_m + std::pow(params.odometry_sigma_m, 2);
  return std::sqrt(across_m2 / (leg_rad2 - std::pow(params.odometry_slip_sigma, 2)));
}

Result<MountCalibration, std::string> calibrate_mount(const std::vector<Stand>& all,
                                                      const MountCalibrationParams& params) {
  std::vector<Stand> stands;
  double path_m = 0;
  for (const Stand& stand : all) {
    path_m += stand.path_m;
    if (stand.bearings.size() < kFewestBearings) continue;
    stands.push_back(stand);
    stands.back().path_m = path_m;
    path_m = 0;
  }
  if (stands.size() < kFewestStands)
    return "the truck stood " + std::to_string(stands.size()) + " times with " + std::to_string(kFewestBearings) +
           " named beacons in view, at least " + std::to_string(kFewestStands) + " are needed, 8 are good";

  constexpr double kTurnedTooLittle = 0.8;
  if (Adjustment(stands, params).one_way() > kTurnedTooLittle)
    return std::string(
        "the truck stood at nearly one heading: a sloping floor and a tilted mount look alike so; turn it");

  // Twice: the turn of the second from its guess is nothing, so that its covariance is that of the angles.
  const auto first = Adjustment(stands, params).run();
  if (!first) return first;
  MountCalibrationParams second = params;
  second.T_base_camera = first->T_base_camera;
  auto found = Adjustment(stands, second).run();
  if (found && found->chi2 > chi_square_quantile(0.99999, found->degrees_of_freedom))
    return "the bearings fit no mount: chi2 is " + std::to_string(found->chi2) + " with " +
           std::to_string(found->degrees_of_freedom) +
           " degrees of freedom; check the lens's calibration, the survey and the mount's position";
  return found;
}

}  // namespace lodestar
