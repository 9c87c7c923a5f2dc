#pragma once

#include <vector>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/estimation/fusion/error_state.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"
#include "lodestar/estimation/fusion/rig.hpp"

namespace lodestar {

/// How far one beacon is from where it is said to be, as the filter sees it.
struct BeaconCheck {
  BeaconId beacon;
  double distance2 =
      0;  ///< of its estimated offset from its prior, squared and normalised: chi-square of 3 if it is true
  double offset_m = 0;  ///< the estimated offset's length
  int gated = 0;        ///< bearings to it that were refused, in a row
  bool excluded = false;
};

namespace fusion {

/// What the risk means for the tests and for the level, worked out once.
struct IntegrityFactors {
  explicit IntegrityFactors(const PoseFilterParams& params);
  double chi2_beacon, chi2_time;  ///< beyond it, a beacon (the camera's clock) lies
  double free;                    ///< sigmas of the position while nothing lies
  double missed;                  ///< sigmas beyond a test's threshold that a lie stays unnoticed with
  double beside;                  ///< sigmas of the position beside an unnoticed lie
};

/// Sets the time offset free to be estimated: the camera's clock may be wrong by anything.
void doubt_clock(FilterState& state);

/// Tests each beacon's offset, and the camera's time offset, against its prior. The beacon that fits worst, if beyond
/// the threshold, is excluded, and what its surveyed place has told the state is taken back; then the rest is tested
/// again. A time offset beyond its threshold is set free.
void exclude_liars(FilterState& state, const IntegrityFactors& factors);

/// Radius about base_link in which the truth lies but for the risk: the larger of the radius while all beacons are true
/// and of the radius with the one lie that shifts the position most among those that the tests may miss (m).
/// Source: R. Brown, A Baseline GPS RAIM Scheme, Navigation 39 (1992), slope method, with the state's offsets in the
/// place of residuals.
double protection_level_m(const FilterState& state, const Rig& rig, const IntegrityFactors& factors);

std::vector<BeaconCheck> check_beacons(const FilterState& state);

}  // namespace fusion
}  // namespace lodestar
