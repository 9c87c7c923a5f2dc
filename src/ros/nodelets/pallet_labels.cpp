#include "lodestar/ros/nodelets/pallet_labels.hpp"

#include <algorithm>
#include <cstdio>

namespace lodestar {
namespace {

constexpr double kAbove_m = 0.1;       // between the goods and the text
constexpr double kSamePlace_m = 0.35;  // less than half a pallet's width: two that stand side by side are farther apart

/// The end of the label where it was read, else the beginning of the id; then how long it has been so.
std::string lines_of(const Pallet& pallet, Stamp now) {
  const double age_s = std::max(0.0, seconds(now - pallet.changed));
  char age[32];
  if (age_s < 60) {
    std::snprintf(age, sizeof(age), "%.0f s", age_s);
  } else {
    std::snprintf(age, sizeof(age), "%.0f min", age_s / 60);
  }
  const std::string name = pallet.sscc.empty()
                               ? pallet.id.substr(0, 6)
                               : "..." + pallet.sscc.substr(std::max<std::size_t>(pallet.sscc.size(), 4) - 4);
  return name + (pallet.state == PalletState::kUncertain ? " ?" : "") + "\n" + age;
}

PalletLabel label_above(const Pallet& pallet, Stamp now) {
  const Eigen::Vector3d top_map = pallet.T_map_pallet * Eigen::Vector3d(0, 0, kDrawnPallet_m + kDrawnGoods_m);
  return {top_map + Eigen::Vector3d(0, 0, kAbove_m + kLabelLine_m), lines_of(pallet, now)};
}

}  // namespace

std::vector<PalletLabel> pallet_labels(std::vector<Pallet> pallets, Stamp now) {
  const auto height_m = [](const Pallet& pallet) { return pallet.T_map_pallet.translation().z(); };
  std::stable_sort(pallets.begin(), pallets.end(),
                   [&](const Pallet& a, const Pallet& b) { return height_m(a) > height_m(b); });
  std::vector<PalletLabel> labels;
  for (const Pallet& pallet : pallets) {
    const Eigen::Vector2d place = pallet.T_map_pallet.translation().head<2>();
    const auto above = std::find_if(labels.begin(), labels.end(), [&](const PalletLabel& label) {
      return (label.position_map.head<2>() - place).norm() < kSamePlace_m;
    });
    if (above == labels.end()) {
      labels.push_back(label_above(pallet, now));
    } else {
      above->text += "\n" + lines_of(pallet, now);
      above->position_map.z() += kLabelLine_m;  // two lines more, of which the middle is told
    }
  }
  return labels;
}

}  // namespace lodestar
