#pragma once

#include <Eigen/Core>
#include <string>

namespace lodestar {

/// One kind of pallet that a truck carries.
struct PalletSize {
  std::string type;
  Eigen::Vector2d size_m = {1.2, 0.8};  ///< length (along its x) and width
  double deck_m = 0.1;                  ///< from its underside up to where the fork bears it
};

}  // namespace lodestar
