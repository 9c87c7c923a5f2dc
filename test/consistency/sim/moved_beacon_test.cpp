// A beacon hangs half a metre from where the site file has it: it is found out, left out, and used again once somebody
// has looked after it, whether it says so itself or not.

#include <gtest/gtest.h>

#include "lodestar/sim/line_run.hpp"

namespace lodestar {
namespace {

const BeaconId kMoved{13};

class MovedBeacon : public testing::Test {
 protected:
  void SetUp() override {
    auto loaded = sim::load_scenario(std::string(LODESTAR_SOURCE_DIR) + "/test/ros/scenario.yaml");
    ASSERT_TRUE(loaded.ok());
    told_ = *loaded;
    told_.duration_s = 80;
    told_.route.waypoints.back().stop_s = 100;
    add_beacons(told_.site);
    sim::Scenario hung = told_;
    hang(hung.site);
    simulation_ = std::make_unique<sim::Simulation>(hung);
    line_ = std::make_unique<LocalizationLine>(sim::make_line(told_));
  }

  virtual void add_beacons(Site&) const {}
  virtual void hang(Site& site) const {
    for (Beacon& beacon : site.beacons)
      if (beacon.id == kMoved) beacon.position_map += Eigen::Vector3d(-0.3, 0.4, 0);
  }

  /// Until `stop` says so, at most to the end of the drive. No pose may be further off than it admits.
  template <class Stop>
  bool drive(bool beacon_admits_it, Stop&& stop) {
    while (const auto event = simulation_->next()) {
      sim::Event heard = *event;
      if (auto* frame = std::get_if<RawIrFrame>(&heard.data); frame && !beacon_admits_it) say_as_told(*frame);
      const auto outcome = sim::feed(*line_, heard);
      if (!outcome || !outcome->estimate) continue;
      now_ = outcome->sightings.stamp;
      check(*outcome);
      if (stop()) return true;
    }
    return false;
  }

  bool in_force() const {
    const auto beacons = line_->fusion().trusted();
    return std::any_of(beacons.begin(), beacons.end(), [](const Beacon& b) { return b.id == kMoved; });
  }
  /// Bearings to it correct the pose.
  bool used() const {
    for (const BeaconCheck& check : line_->fusion().filter().beacon_checks())
      if (check.beacon == kMoved) return !check.excluded && check.gated == 0;
    return false;
  }
  double worst_m() const { return worst_m_; }

  std::unique_ptr<LocalizationLine> line_;
  Stamp now_;

 private:
  void say_as_told(RawIrFrame& frame) const {
    const IrFrameDecoder decoder(told_.site.link, static_cast<int>(told_.site.tone_table_hz.size()));
    const auto decoded = decoder.decode(frame);
    if (!decoded) return;
    Announcement said = *decoded;
    for (const Beacon& beacon : told_.site.beacons)
      if (beacon.id == decoded->beacon) said.position_map = beacon.position_map;
    frame.octets = encode_ir_frame(said, told_.site.link);
  }
  void check(const LocalizationLine::Outcome& outcome) {
    const double time_s = seconds(outcome.sightings.stamp - told_.start);
    const Eigen::Vector2d off =
        (outcome.estimate->T_map_base.translation() - simulation_->truck().motion(time_s).T_map_base.translation())
            .head<2>();
    worst_m_ = std::max(worst_m_, off.norm());
  }

  sim::Scenario told_;
  std::unique_ptr<sim::Simulation> simulation_;
  double worst_m_ = 0;
};

TEST_F(MovedBeacon, that_says_so_itself_is_left_out_until_it_is_confirmed) {
  ASSERT_TRUE(drive(true, [&] { return !in_force(); }));
  int images = 0;
  EXPECT_FALSE(drive(true, [&] { return in_force() || ++images == 100; }) && in_force());
  EXPECT_TRUE(line_->beacon_table().entries().at(kMoved).conflict);
  EXPECT_LT(worst_m(), 0.1);

  ASSERT_TRUE(line_->confirm(kMoved, now_));
  EXPECT_TRUE(drive(true, [&] { return used(); }));
  EXPECT_LT(worst_m(), 0.1);
}

TEST_F(MovedBeacon, that_does_not_know_it_is_found_out_by_the_others) {
  ASSERT_TRUE(drive(false, [&] { return line_->fusion().distrusted().count(kMoved) > 0; }));
  EXPECT_EQ(line_->fusion().distrusted().size(), 1u);
  EXPECT_FALSE(in_force());
  EXPECT_FALSE(line_->beacon_table().entries().at(kMoved).conflict) << "it says what the site file says";
  EXPECT_LT(worst_m(), 0.1);

  // It learns where it hangs, and somebody says that this is right.
  ASSERT_TRUE(drive(true, [&] { return line_->beacon_table().entries().at(kMoved).conflict; }));
  ASSERT_TRUE(line_->confirm(kMoved, now_));
  EXPECT_TRUE(drive(true, [&] { return used(); }));
  EXPECT_LT(worst_m(), 0.1);
}

/// Each of two beacons hangs where the site file has the other, and says so.
class SwappedBeacons : public MovedBeacon {
 protected:
  static constexpr BeaconId kOther{14};

  void hang(Site& site) const override {
    const auto at = [&](BeaconId id) {
      return std::find_if(site.beacons.begin(), site.beacons.end(), [&](const Beacon& b) { return b.id == id; });
    };
    std::swap(at(kMoved)->position_map, at(kOther)->position_map);
  }
  bool conflicts(BeaconId id) const { return line_->beacon_table().entries().at(id).conflict; }
};

TEST_F(SwappedBeacons, that_say_so_are_both_left_out_until_they_are_confirmed) {
  ASSERT_TRUE(drive(true, [&] { return conflicts(kMoved) && conflicts(kOther); }));
  EXPECT_EQ(line_->beacon_table().beacons().size(), 2u) << "the others";
  int images = 0;
  drive(true, [&] { return ++images == 100; });
  EXPECT_FALSE(in_force());
  EXPECT_LT(worst_m(), 0.1);

  for (const BeaconId id : {kMoved, kOther}) ASSERT_TRUE(line_->confirm(id, now_));
  EXPECT_TRUE(drive(true, [&] { return used(); }));
  EXPECT_EQ(line_->beacon_table().beacons().size(), 4u);
  EXPECT_LT(worst_m(), 0.1);
}

/// ... under three others: more have to agree than disagree.
class SwappedOfFive : public SwappedBeacons {
 protected:
  void add_beacons(Site& site) const override {
    Beacon fifth = site.beacons.front();
    fifth.id = BeaconId{15};
    fifth.position_map = {2.5, 2.2, 5};
    fifth.tones = ToneSet({1, 3});
    fifth.slot = 1;
    site.beacons.push_back(fifth);
  }
};

TEST_F(SwappedOfFive, that_do_not_know_it_are_both_found_out_by_the_others) {
  const auto& distrusted = line_->fusion().distrusted();
  ASSERT_TRUE(drive(false, [&] { return distrusted.size() == 2; }));
  EXPECT_EQ(distrusted.count(kMoved), 1u);
  EXPECT_EQ(distrusted.count(kOther), 1u);
  EXPECT_LT(worst_m(), 0.1);
}

}  // namespace
}  // namespace lodestar
