#include "lodestar/sensing/beacon/blob_track.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kStillPx = 0.5;           ///< paths shorter than this are points
constexpr double kStraightPx = 6.0;        ///< shorter deviations are lines, longer ones parabolas
constexpr double kMinElevationSine = 0.1;  ///< below it the ceiling is too far away to be a plane
constexpr double kOutlierPx = 1.5;
constexpr double kMinCentreSigmaPx = 0.03;  ///< of one frame's centroid

/// Polynomial over time, one column an axis, fitted to the deviations twice: the second time without outliers.
struct DeviationFit {
  Eigen::Matrix<double, Eigen::Dynamic, 2> coefficients;
  Eigen::Matrix2d newest_covariance = Eigen::Matrix2d::Zero();

  Eigen::Vector2d at(double time_s) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double power = 1;
    for (Eigen::Index i = 0; i < coefficients.rows(); ++i, power *= time_s)
      sum += power * coefficients.row(i).transpose();
    return sum;
  }
};

struct Deviation {
  double time_s;
  Eigen::Vector2d value_px;
};

DeviationFit fit(const std::vector<Deviation>& points, int order) {
  const auto rows = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd powers(rows, order + 1);
  Eigen::Matrix<double, Eigen::Dynamic, 2> values(rows, 2);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const Deviation& point = points[static_cast<std::size_t>(r)];
    for (int c = 0; c <= order; ++c) powers(r, c) = std::pow(point.time_s, c);
    values.row(r) = point.value_px.transpose();
  }
  DeviationFit result;
  const auto qr = powers.colPivHouseholderQr();
  result.coefficients = qr.solve(values);
  const double variance = (values - powers * result.coefficients).squaredNorm() /
                          std::max<double>(1.0, 2.0 * static_cast<double>(rows - order - 1));
  const Eigen::MatrixXd information = powers.transpose() * powers;
  const double leverage = information.ldlt().solve(Eigen::VectorXd::Unit(order + 1, 0))[0];
  result.newest_covariance =
      Eigen::Matrix2d::Identity() * leverage * std::max(variance, kMinCentreSigmaPx * kMinCentreSigmaPx);
  return result;
}

DeviationFit robust_fit(std::vector<Deviation> points, int order) {
  const auto keeps = static_cast<std::size_t>(order + 2);
  DeviationFit result = fit(points, order);
  points.erase(
      std::remove_if(points.begin(), points.end(),
                     [&](const Deviation& p) { return (p.value_px - result.at(p.time_s)).norm() > kOutlierPx; }),
      points.end());
  return points.size() >= keeps ? fit(points, order) : result;
}

}  // namespace

std::optional<Eigen::Vector3d> WindowMotion::point(const Eigen::Vector2d& pixel) const {
  const auto bearing = camera->bearing(pixel);
  if (!bearing) return std::nullopt;
  return bearing->direction * (plane_height_m / std::max(kMinElevationSine, bearing->direction.z()));
}

std::optional<Eigen::Vector2d> WindowMotion::pixel_then(const Eigen::Vector2d& pixel, std::size_t i) const {
  const auto X = point(pixel);
  if (!X) return std::nullopt;
  const auto projection = camera->project(T_then_now[i] * *X);
  if (!projection) return std::nullopt;
  return projection->pixel;
}

std::optional<Eigen::Vector2d> WindowMotion::pixel_now(const Eigen::Vector2d& pixel_before) const {
  const auto X = point(pixel_before);
  if (!X) return std::nullopt;
  const auto projection = camera->project(T_then_now[T_then_now.size() - 2].inverse() * *X);
  if (!projection) return std::nullopt;
  return projection->pixel;
}

bool BlobTrack::predict(const WindowMotion& motion) {
  const auto moved = motion.pixel_now(pixel_);
  if (!moved) return false;
  step_px_ = (*moved - pixel_).norm();
  const auto newest = motion.stamps.end() - 1;
  pixel_ = *moved + deviation_px_s_ * seconds(*newest - *(newest - 1));
  return true;
}

void BlobTrack::match(const std::optional<Eigen::Vector2d>& centre, std::size_t window_frames) {
  centres_.push_back(centre);
  if (centres_.size() > window_frames) centres_.pop_front();
  unseen_ = centre ? 0 : unseen_ + 1;
}

double BlobTrack::gate_px() const {
  constexpr double kGatePx = 2.5, kGrowthPx = 0.3, kMaxGatePx = 10;
  const double unknown = age_frames() < 4 ? 0.5 * step_px_ : 0.15 * step_px_;
  return std::min(kMaxGatePx, kGatePx + unknown + kGrowthPx * static_cast<double>(unseen_));
}

std::optional<BlobPath> BlobTrack::fit_path(const WindowMotion& motion) {
  const std::size_t frames = motion.stamps.size();
  BlobPath path;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto pixel = motion.pixel_then(pixel_, i);
    if (!pixel) return std::nullopt;
    path.pixels.push_back(*pixel);
  }

  std::vector<Deviation> deviations;
  for (std::size_t age = 0; age < std::min(centres_.size(), frames); ++age) {
    const auto& centre = centres_[centres_.size() - 1 - age];
    const std::size_t i = frames - 1 - age;
    if (centre) deviations.push_back({seconds(motion.stamps[i] - motion.stamps.back()), *centre - path.pixels[i]});
  }
  if (deviations.empty()) return path;

  const double travel = (path.pixels.front() - path.pixels.back()).norm();
  const double spread = (deviations.front().value_px - deviations.back().value_px).norm();
  path.still = travel + spread < kStillPx;
  const int wanted = path.still ? 0 : (spread + 0.1 * travel < kStraightPx ? 1 : 2);
  const int order = std::min<int>(wanted, std::max<int>(0, static_cast<int>(deviations.size()) / 4));
  const DeviationFit deviation = robust_fit(std::move(deviations), order);

  deviation_px_s_ = order > 0 ? Eigen::Vector2d(deviation.coefficients.row(1)) : Eigen::Vector2d::Zero();
  pixel_ += deviation.at(0);
  for (std::size_t i = 0; i < frames; ++i) {
    if (path.still) {
      path.pixels[i] = pixel_;
    } else {
      path.pixels[i] += deviation.at(seconds(motion.stamps[i] - motion.stamps.back()));
      path.newest_covariance = deviation.newest_covariance;
    }
  }
  return path;
}

void follow_spots(std::vector<BlobTrack>& tracks, const std::vector<Spot>& spots, const WindowMotion& motion,
                  std::size_t window_frames, std::size_t max_tracks) {
  tracks.erase(std::remove_if(
                   tracks.begin(), tracks.end(),
                   [&](BlobTrack& track) { return !track.predict(motion) || !motion.camera->contains(track.pixel()); }),
               tracks.end());

  struct Pair {
    double distance_px;
    std::size_t track, spot;
  };
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (std::size_t s = 0; s < spots.size(); ++s) {
      const double distance_px = (spots[s].centre_px - tracks[t].pixel()).norm();
      if (distance_px < tracks[t].gate_px()) pairs.push_back({distance_px, t, s});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance_px < b.distance_px; });

  std::vector<std::optional<Eigen::Vector2d>> matched(tracks.size());
  std::vector<bool> taken(spots.size(), false);
  for (const Pair& pair : pairs) {
    if (matched[pair.track] || taken[pair.spot]) continue;
    matched[pair.track] = spots[pair.spot].centre_px;
    taken[pair.spot] = true;
  }
  for (std::size_t t = 0; t < tracks.size(); ++t) tracks[t].match(matched[t], window_frames);
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const BlobTrack& track) { return 2 * track.unseen_frames() > window_frames; }),
               tracks.end());

  for (std::size_t s = 0; s < spots.size() && tracks.size() < max_tracks; ++s) {
    if (!taken[s]) tracks.emplace_back(spots[s].centre_px);
  }
}

}  // namespace lodestar
