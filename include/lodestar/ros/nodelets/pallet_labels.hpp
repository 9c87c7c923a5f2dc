#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "lodestar/base/measurement/pallet.hpp"

namespace lodestar {

constexpr double kDrawnPallet_m = 0.144;  ///< height of what is drawn
constexpr double kDrawnGoods_m = 0.75;    ///< upon it; how high they really are is not known
constexpr double kLabelLine_m = 0.5;      ///< height of a line of text

/// What is written above the pallets that stand over one place of the floor, a line for the name and one for the age of
/// each, the uppermost first.
struct PalletLabel {
  Eigen::Vector3d position_map;  ///< of the text's middle
  std::string text;
};

/// One for each stack: those of its pallets would stand in each other. @param now to which the pallets' ages are
/// counted
std::vector<PalletLabel> pallet_labels(std::vector<Pallet> pallets, Stamp now);

}  // namespace lodestar
