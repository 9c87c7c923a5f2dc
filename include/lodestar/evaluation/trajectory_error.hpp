#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/evaluation/estimate_csv.hpp"
#include "lodestar/evaluation/nees_band.hpp"
#include "lodestar/evaluation/truth_track.hpp"

namespace lodestar {

/// What errors come to. Quantiles interpolate between the ordered samples. All NaN when there is no sample.
struct ErrorStatistics {
  double mean = 0, rmse = 0, median = 0, p95 = 0, max = 0;
};
ErrorStatistics error_statistics(std::vector<double> magnitudes);

struct TrajectoryErrorParams {
  double moving_above_m_s = 0.05;
  double stale_after_s = 0.1;  ///< an estimate that is older does not count as available
  double relative_interval_s = 1.0;
};

/// An estimate against the truth, without any alignment.
struct TrajectoryError {
  /// One row of the estimate.
  struct Sample {
    Stamp stamp;
    double position_m = 0;  ///< horizontal
    double yaw_rad = 0;     ///< signed
    double z_m = 0;         ///< signed
    double speed_m_s = 0;   ///< of the truth
    double sigma_position_m = 0, sigma_yaw_rad = 0;
    std::optional<Eigen::Vector3d> normalized;  ///< errors of x, y, yaw over their sigmas; none when a sigma is 0
  };
  /// Normalised error squared, 3 degrees of freedom.
  struct Nees {
    double mean = 0;
    double draws = 0;  ///< independent ones that the samples are worth
    NeesBand band;     ///< 95 %, of the mean over so many
  };
  struct Part {
    std::size_t samples = 0;
    ErrorStatistics position_m, yaw_rad, z_m;
    std::optional<Nees> nees;
  };
  struct Relative {
    std::size_t samples = 0;
    double interval_s = 0;
    ErrorStatistics position_m, yaw_rad;
  };

  Part all, standing, moving;
  /// Of the truth's time from the first estimate to the end: the share that has an estimate not older than
  /// stale_after_s. 0 without an estimate.
  double availability = 0;
  std::optional<double> time_to_first_fix_s;  ///< first truth to first estimate
  Relative relative;                          ///< error of the motion over an interval, seen from its start
  std::size_t outside_truth = 0;              ///< rows that the truth says nothing about; not in any sum
  std::vector<Sample> samples;
};

/// Errors of position are horizontal. The normalised error squared takes x, y and yaw as independent, since an estimate
/// file holds their sigmas and no correlations.
TrajectoryError trajectory_error(const TruthTrack& truth, const std::vector<EstimateRow>& estimate,
                                 const TrajectoryErrorParams& params = {});

/// As the interfaces page has it, with `z`, `relative`, `rows_outside_truth` and `nees_dof` beside; what has no sample
/// is null.
std::string to_json(const TrajectoryError& error);

}  // namespace lodestar
