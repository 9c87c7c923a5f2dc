#include "lodestar/calibration/lens_calibration.hpp"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "board_pose.hpp"
#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

constexpr std::size_t kFewestViews = 4;

using Lens = std::array<double, 8>;        // fx fy cx cy k1 k2 k3 k4
using BoardPlace = std::array<double, 6>;  // rotation vector and translation of T_camera_board

CameraIntrinsics intrinsics_of(const Lens& lens, int width_px, int height_px) {
  CameraIntrinsics intrinsics;
  intrinsics.width_px = width_px;
  intrinsics.height_px = height_px;
  intrinsics.fx_px = lens[0];
  intrinsics.fy_px = lens[1];
  intrinsics.cx_px = lens[2];
  intrinsics.cy_px = lens[3];
  std::copy(lens.begin() + 4, lens.end(), intrinsics.coefficients.begin());
  return intrinsics;
}

/// Kannala and Brandt, "A generic camera model and calibration method", PAMI 2006, eq. 6, as OpenCV's fisheye has it.
struct Reprojection {
  BoardPoint point;

  template <class T>
  bool operator()(const T* lens, const T* place, T* residual) const {
    const T on_board[3] = {T(point.board_m.x()), T(point.board_m.y()), T(0)};
    T p[3];
    ceres::AngleAxisRotatePoint(place, on_board, p);
    for (int i = 0; i < 3; ++i) p[i] += place[3 + i];
    const T r = ceres::sqrt(p[0] * p[0] + p[1] * p[1] + T(1e-20));
    const T theta = ceres::atan2(r, p[2]), theta2 = theta * theta;
    const T distorted =
        theta * (T(1) + theta2 * (lens[4] + theta2 * (lens[5] + theta2 * (lens[6] + theta2 * lens[7]))));
    residual[0] = T(point.pixel.x()) - (lens[0] * distorted * p[0] / r + lens[2]);
    residual[1] = T(point.pixel.y()) - (lens[1] * distorted * p[1] / r + lens[3]);
    return true;
  }
};

/// One set of unknowns on its way to the least squares.
struct Trial {
  Lens lens{};
  std::vector<BoardPlace> places;
  double rms_px = 0;
};

/// A plain equidistant lens of this focal length, the boards where it sees them; none when it cannot see one.
std::optional<Trial> first_guess(const std::vector<BoardView>& views, int width_px, int height_px, double focal_px) {
  Trial trial;
  trial.lens = {focal_px, focal_px, (width_px - 1) / 2.0, (height_px - 1) / 2.0, 0, 0, 0, 0};
  const auto camera = CameraModel::create(intrinsics_of(trial.lens, width_px, height_px));
  for (const BoardView& view : views) {
    const auto T_camera_board = camera ? board_pose(view, **camera) : std::nullopt;
    if (!T_camera_board) return std::nullopt;
    const Eigen::Vector3d turn = so3_log(T_camera_board->linear()), t = T_camera_board->translation();
    trial.places.push_back({turn.x(), turn.y(), turn.z(), t.x(), t.y(), t.z()});
  }
  return trial;
}

class Adjustment {
 public:
  /// @param doubtful_px residuals beyond it pull less and less; 0: all pull alike
  Adjustment(const std::vector<BoardView>& views, Trial& trial, double doubtful_px = 0) : trial_(trial) {
    ceres::LossFunction* const loss = doubtful_px > 0 ? new ceres::CauchyLoss(doubtful_px) : nullptr;
    for (std::size_t i = 0; i < views.size(); ++i) {
      for (const BoardPoint& point : views[i]) {
        using Cost = ceres::AutoDiffCostFunction<Reprojection, 2, 8, 6>;
        problem_.AddResidualBlock(new Cost(new Reprojection{point}), loss, trial_.lens.data(), trial_.places[i].data());
        ++points_;
      }
    }
  }
  void minimize(int iterations) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = iterations;
    options.function_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    trial_.rms_px = std::sqrt(summary.final_cost / points_);
  }
  /// Of the lens; none where the views leave a part of it open.
  std::optional<Eigen::Matrix<double, 8, 8, Eigen::RowMajor>> lens_covariance() {
    ceres::Covariance covariance(ceres::Covariance::Options{});
    const double* const lens = trial_.lens.data();
    if (!covariance.Compute(std::vector<const double*>{lens}, &problem_)) return std::nullopt;
    Eigen::Matrix<double, 8, 8, Eigen::RowMajor> P;
    covariance.GetCovarianceBlock(lens, lens, P.data());
    const double unknowns = 8 + 6.0 * static_cast<double>(trial_.places.size());
    const double freedom = std::max(1.0, 2.0 * points_ - unknowns);
    return P * trial_.rms_px * trial_.rms_px * 2 * points_ / freedom;
  }

 private:
  Trial& trial_;
  ceres::Problem problem_;
  int points_ = 0;
};

/// Nothing is known of the lens but that it is some fisheye: several focal lengths are tried, the best goes on.
std::optional<Trial> best_start(const std::vector<BoardView>& views, int width_px, int height_px) {
  constexpr int kIterations = 10;
  std::optional<Trial> best;
  for (const double field_rad : {1.0, 1.5, 2.0, 2.5, 3.0, 3.5}) {
    auto trial = first_guess(views, width_px, height_px, std::hypot(width_px, height_px) / field_rad);
    if (!trial) continue;
    Adjustment(views, *trial).minimize(kIterations);
    if (!best || trial->rms_px < best->rms_px) best = trial;
  }
  return best;
}

Eigen::Vector2d residual_px(const Trial& trial, std::size_t view, const BoardPoint& point) {
  Eigen::Vector2d residual;
  Reprojection{point}(trial.lens.data(), trial.places[view].data(), residual.data());
  return residual;
}

double median_off_px(const std::vector<BoardView>& views, const Trial& trial) {
  std::vector<double> off_px;
  for (std::size_t i = 0; i < views.size(); ++i)
    for (const BoardPoint& point : views[i]) off_px.push_back(residual_px(trial, i, point).norm());
  const auto middle = off_px.begin() + static_cast<std::ptrdiff_t>(off_px.size() / 2);
  std::nth_element(off_px.begin(), middle, off_px.end());
  return *middle;
}

/// Leaves out marks that are off by several times the median; how many.
int drop_outliers(std::vector<BoardView>& views, const Trial& trial) {
  constexpr double kMedians = 6;  // of normal errors' length: seven sigma
  const double limit_px = kMedians * median_off_px(views, trial);
  int dropped = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto is_off = [&](const BoardPoint& point) { return residual_px(trial, i, point).norm() > limit_px; };
    const auto kept = std::remove_if(views[i].begin(), views[i].end(), is_off);
    dropped += static_cast<int>(views[i].end() - kept);
    views[i].erase(kept, views[i].end());
  }
  return dropped;
}

void add_residuals(const std::vector<BoardView>& views, const Trial& trial, LensCalibration& calibration) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    double sum = 0;
    for (const BoardPoint& point : views[i]) {
      calibration.marks.push_back({point.pixel, residual_px(trial, i, point)});
      sum += calibration.marks.back().residual_px.squaredNorm();
    }
    calibration.view_rms_px.push_back(
        std::sqrt(sum / (2.0 * std::max<double>(1, static_cast<double>(views[i].size())))));
  }
}

}  // namespace

Result<LensCalibration, std::string> calibrate_lens(std::vector<BoardView> views, int width_px, int height_px) {
  constexpr int kIterations = 100;
  if (views.size() < kFewestViews)
    return "the board is seen in " + std::to_string(views.size()) + " images, at least " +
           std::to_string(kFewestViews) + " are needed, 20 are good";
  auto trial = best_start(views, width_px, height_px);
  if (!trial) return std::string("the board's place cannot be told from a view: its marks lie in a line");
  Adjustment(views, *trial).minimize(kIterations);
  // In a view of few marks one that is far off would pull the board's place, and make outliers of all the others.
  Adjustment(views, *trial, 2 * median_off_px(views, *trial)).minimize(kIterations);
  LensCalibration calibration;
  calibration.outliers = drop_outliers(views, *trial);
  Adjustment adjustment(views, *trial);
  adjustment.minimize(kIterations);

  calibration.intrinsics = intrinsics_of(trial->lens, width_px, height_px);
  calibration.rms_px = trial->rms_px;
  const auto camera = CameraModel::create(calibration.intrinsics);
  const auto P = adjustment.lens_covariance();
  if (!camera || !P)
    return std::string("the views do not fix the lens: show the board tilted, and in all parts of the image");
  calibration.focal_sigma_px = std::sqrt(std::max((*P)(0, 0), (*P)(1, 1)));
  calibration.centre_sigma_px = std::sqrt(std::max((*P)(2, 2), (*P)(3, 3)));
  add_residuals(views, *trial, calibration);
  return calibration;
}

Coverage coverage(const std::vector<BoardView>& views, int width_px, int height_px) {
  constexpr int n = Coverage::kCells;
  std::array<bool, n * n> seen{};
  const auto cell = [](double pixel, int size_px) {
    return std::clamp(static_cast<int>((pixel + 0.5) * n / size_px), 0, n - 1);
  };
  for (const BoardView& view : views)
    for (const BoardPoint& point : view)
      seen[static_cast<std::size_t>(cell(point.pixel.y(), height_px) * n + cell(point.pixel.x(), width_px))] = true;

  // A corner is two cells each way: marks cannot come nearer to the edge than the board's own rim.
  Coverage coverage;
  const auto empty = [&](int row, int column) {
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (seen[static_cast<std::size_t>((row + i) * n + column + j)]) return false;
    return true;
  };
  if (empty(0, 0)) coverage.empty_corners.emplace_back("upper left");
  if (empty(0, n - 2)) coverage.empty_corners.emplace_back("upper right");
  if (empty(n - 2, 0)) coverage.empty_corners.emplace_back("lower left");
  if (empty(n - 2, n - 2)) coverage.empty_corners.emplace_back("lower right");
  coverage.covered = static_cast<double>(std::count(seen.begin(), seen.end(), true)) / (n * n);
  return coverage;
}

}  // namespace lodestar
