#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/tone_set.hpp"

namespace lodestar {

/// A blob in the image that flashes in a code.
struct Sighting {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();           ///< px, centre of the upper left pixel is (0, 0)
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< px^2
  ToneSet tones;
  double snr_db = 0;               ///< power of the weakest tone of the code over the noise, after the window
  bool saturated = false;          ///< a pixel of the blob clipped within the window
  std::optional<BeaconId> beacon;  ///< empty: not named
};

/// All blobs of one window, valid for the instant `stamp`.
struct Sightings {
  Stamp stamp;
  std::vector<Sighting> sightings;
};

}  // namespace lodestar
