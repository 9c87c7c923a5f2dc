#include "lodestar/ros/nodelets/pallet_labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/pallet_changes.hpp"

namespace lodestar {
namespace {

Pallet pallet(const std::string& id, double x_m, double z_m, double age_s = 5) {
  Pallet out;
  out.id = id;
  out.changed = test::at(1000 - age_s);
  out.T_map_pallet.translation() << x_m, 2, z_m;
  return out;
}

std::vector<PalletLabel> labels(const std::vector<Pallet>& pallets) { return pallet_labels(pallets, test::at(1000)); }

double lower_edge_m(const PalletLabel& label) {
  const auto lines = 1 + std::count(label.text.begin(), label.text.end(), '\n');
  return label.position_map.z() - 0.5 * kLabelLine_m * static_cast<double>(lines);
}

TEST(PalletLabels, EachPlaceOfTheFloorHasItsOwn) {
  const auto all = labels({pallet("aaaaaaaa", 1, 0), pallet("bbbbbbbb", 1.9, 0)});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].text, "aaaaaa\n5 s");
  EXPECT_EQ(all[1].text, "bbbbbb\n5 s");
  EXPECT_DOUBLE_EQ(all[1].position_map.x(), 1.9);
  EXPECT_DOUBLE_EQ(all[1].position_map.y(), 2);
}

TEST(PalletLabels, AStackHasOneAboveItsGoods) {
  const double top_m = 1.8 + kDrawnPallet_m + kDrawnGoods_m;
  for (const bool upper_first : {false, true}) {
    std::vector<Pallet> stack = {pallet("lower", 1, 0), pallet("middle", 1.05, 0.9, 600), pallet("upper", 0.95, 1.8)};
    if (upper_first) std::reverse(stack.begin(), stack.end());
    const auto all = labels(stack);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].text, "upper\n5 s\nmiddle\n10 min\nlower\n5 s");
    EXPECT_NEAR(lower_edge_m(all[0]), top_m + 0.1, 1e-9);
  }
  EXPECT_NEAR(lower_edge_m(labels({pallet("upper", 1, 1.8)})[0]), top_m + 0.1, 1e-9);
}

TEST(PalletLabels, TellWhatIsKnown) {
  Pallet doubtful = pallet("aaaaaaaa", 1, 0);
  doubtful.state = PalletState::kUncertain;
  Pallet read = pallet("bbbbbbbb", 3, 0, -1);
  read.sscc = "106141412345678908";
  Pallet odd = pallet("cccccccc", 5, 0);
  odd.sscc = "12";
  const auto all = labels({doubtful, read, odd});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].text, "aaaaaa ?\n5 s");
  EXPECT_EQ(all[1].text, "...8908\n0 s") << "told a little before it happened";
  EXPECT_EQ(all[2].text, "...12\n5 s");
}

}  // namespace
}  // namespace lodestar
