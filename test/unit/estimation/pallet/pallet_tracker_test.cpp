#include "lodestar/estimation/pallet/pallet_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/pallet_truck.hpp"

namespace lodestar {
namespace {

using test::PalletTruck;

double yaw_of(const Pallet& pallet) { return roll_pitch_yaw(pallet.T_map_pallet.linear()).yaw_rad; }

TEST(PalletTracker, picks_and_drops_by_pose) {
  PalletTruck truck;
  truck.stand(5, 3, radians(90));
  const auto picked = truck.lift(PalletTruck::sscc(7));
  ASSERT_EQ(picked.size(), 1u);
  EXPECT_EQ(picked[0].sequence, 1u);
  EXPECT_EQ(picked[0].kind, PalletChangeKind::kPick);
  EXPECT_EQ(picked[0].pallet.state, PalletState::kOnFork);
  EXPECT_EQ(picked[0].pallet.id, "id1");
  EXPECT_EQ(picked[0].pallet.sscc, PalletTruck::sscc(7));
  EXPECT_EQ(picked[0].pallet.type, "epal");
  truck.stand(8, 4, radians(-30));
  const auto dropped = truck.lower();
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].sequence, 2u);
  EXPECT_EQ(dropped[0].kind, PalletChangeKind::kDrop);
  const Pallet& pallet = dropped[0].pallet;
  EXPECT_EQ(pallet.state, PalletState::kStanding);
  EXPECT_NEAR((pallet.T_map_pallet.translation() - Eigen::Vector3d(8, 4, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(yaw_of(pallet), radians(-30), 1e-9);
  EXPECT_EQ(pallet.level, 0);
  EXPECT_FALSE(pallet.coasting);
  EXPECT_GT(pallet.covariance(0, 0), 2e-4) << "the truck's 10 mm and the seat's";
}

TEST(PalletTracker, knows_a_pallet_by_where_it_stands) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0.9, PalletTruck::sscc(2));
  truck.stand(0.01, 0.91);
  const auto changes = truck.lift();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].pallet.id, "id2");
  EXPECT_EQ(changes[0].pallet.sscc, PalletTruck::sscc(2));
}

TEST(PalletTracker, finds_a_pallet_again_from_its_other_sides) {
  for (const double yaw_deg : {180.0, 90.0, -90.0}) {
    PalletTruck truck;
    truck.bring(0, 0, PalletTruck::sscc(1));
    // Across the tines its middle is 0.4 m from their roots and not 0.6 m.
    const double back = std::abs(yaw_deg) == 90 ? 0.2 : 0;
    truck.stand(back * std::cos(radians(yaw_deg)), back * std::sin(radians(yaw_deg)), radians(yaw_deg));
    EXPECT_EQ(truck.lift().at(0).pallet.id, "id1") << yaw_deg;
    truck.stand(20, 0, radians(yaw_deg));
    const Pallet pallet = truck.lower().at(0).pallet;
    EXPECT_NEAR(yaw_of(pallet), 0, 1e-6) << "it was not turned, only seen from elsewhere";
  }
}

TEST(PalletTracker, asks_where_two_may_be_meant_and_takes_the_answer) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0.9, PalletTruck::sscc(2));
  truck.set_sigma(0.4);
  truck.stand(0, 0.5);
  const auto changes = truck.lift();
  ASSERT_EQ(changes.size(), 3u);
  EXPECT_EQ(changes[0].pallet.state, PalletState::kUncertain);
  EXPECT_EQ(changes[0].pallet.id, "id3");
  EXPECT_EQ(changes[0].candidates, (std::vector<std::string>{"id2", "id1"}));
  EXPECT_EQ(changes[1].kind, PalletChangeKind::kCorrection);
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kUncertain);
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kUncertain);
  for (const Pallet* pallet : truck.tracker.pallets().standing())
    EXPECT_NE(pallet->id, "id3") << "what is on the fork stands nowhere, whatever it is";
  truck.set_sigma(0.01);
  truck.stand(50, 0);
  EXPECT_EQ(truck.lower().at(0).pallet.state, PalletState::kUncertain) << "setting it down answers nothing";

  PalletCorrection answer;
  answer.stamp = truck.now;
  answer.id = "id3";
  answer.same_as = "id1";
  answer.reason = "I looked";
  const auto corrected = truck.tracker.correct(answer);
  ASSERT_TRUE(corrected.ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding);
  EXPECT_NEAR(truck.pallet("id1").T_map_pallet.translation().x(), 50, 1e-6);
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kStanding);
  EXPECT_NEAR(truck.pallet("id2").T_map_pallet.translation().y(), 0.9, 1e-6);
  EXPECT_EQ(truck.pallet("id3").state, PalletState::kGone);
  EXPECT_EQ(corrected->at(0).pallet.id, "id1");
  EXPECT_EQ(corrected->at(0).reason, "I looked");
  EXPECT_EQ(corrected->at(0).corrects, 8u) << "the drop of id3";
}

/// From a place where either of two may be meant, without a label; set down at (50, 0).
void lift_one_of_two(PalletTruck& truck, double y_m, double height_m = 0) {
  truck.set_sigma(0.4);
  truck.stand(0, y_m);
  ASSERT_GE(truck.lift("", height_m).at(0).candidates.size(), 2u);
  truck.set_sigma(0.01);
  truck.stand(50, 0);
  truck.lower();
}

/// They are `id1` and `id2`; what was lifted is `id3`.
void lift_one_of_two_labelled(PalletTruck& truck) {
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0.9, PalletTruck::sscc(2));
  lift_one_of_two(truck, 0.5);
}

PalletCorrection is_the_same(const PalletTruck& truck, const std::string& id, const std::string& same) {
  PalletCorrection answer;
  answer.stamp = truck.now;
  answer.id = id;
  answer.same_as = same;
  return answer;
}

TEST(PalletTracker, an_answer_ends_no_doubt_of_another_cause) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0, PalletTruck::sscc(2));
  ASSERT_EQ(truck.pallet("id1").state, PalletState::kUncertain) << "another was set down where it stood";
  truck.bring(0, 0.9, PalletTruck::sscc(3));
  lift_one_of_two(truck, 0.5);
  ASSERT_TRUE(truck.tracker.correct(is_the_same(truck, "id4", "id3")).ok());
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kStanding);
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kUncertain) << "two are not in one place";
}

TEST(PalletTracker, an_answer_sets_nothing_down_that_the_fork_carries) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0, PalletTruck::sscc(2), 1.0);
  truck.bring(0, 0.9, PalletTruck::sscc(3), 1.0);
  lift_one_of_two(truck, 0.45, 1.0);
  truck.stand(0, 0);
  truck.lift(PalletTruck::sscc(1));
  ASSERT_EQ(truck.tracker.carried().size(), 2u) << "id2, that may have gone, rides on id1";
  ASSERT_TRUE(truck.tracker.correct(is_the_same(truck, "id4", "id3")).ok());
  EXPECT_NE(truck.pallet("id2").state, PalletState::kStanding);
}

TEST(PalletTracker, a_label_read_at_the_next_lift_ends_the_doubt) {
  PalletTruck truck;
  lift_one_of_two_labelled(truck);
  truck.stand(50, 0);
  const auto changes = truck.lift(PalletTruck::sscc(9));
  EXPECT_EQ(changes.at(0).pallet.state, PalletState::kOnFork);
  EXPECT_TRUE(changes.at(0).candidates.empty()) << "those have other labels";
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding);
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kStanding);
}

TEST(PalletTracker, a_candidate_in_whose_place_another_is_set_down_stays_in_doubt) {
  PalletTruck truck;
  lift_one_of_two_labelled(truck);
  truck.bring(0, 0, PalletTruck::sscc(7));
  ASSERT_TRUE(truck.tracker.correct(is_the_same(truck, "id3", "id2")).ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kUncertain);
}

TEST(PalletTracker, a_label_clears_the_candidates_that_have_another) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0.9);
  lift_one_of_two(truck, 0.5);
  truck.stand(50, 0);
  EXPECT_EQ(truck.lift(PalletTruck::sscc(9)).at(0).candidates, std::vector<std::string>{"id2"});
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding);
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kUncertain) << "it may be that one still";
}

TEST(PalletTracker, a_reason_brings_nothing_back) {
  PalletTruck truck;
  lift_one_of_two_labelled(truck);
  PalletCorrection gone;
  gone.stamp = truck.now;
  gone.id = "id1";
  gone.gone = true;
  gone.reason = truck.tracker.pallets().find("id1")->reason;
  ASSERT_TRUE(truck.tracker.correct(gone).ok());
  ASSERT_TRUE(truck.tracker.correct(is_the_same(truck, "id3", "id2")).ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kGone);
}

TEST(PalletTracker, an_answer_about_the_one_that_asks_ends_its_question) {
  PalletTruck truck;
  lift_one_of_two_labelled(truck);
  truck.bring(30, 0);
  ASSERT_TRUE(truck.tracker.correct(is_the_same(truck, "id4", "id3")).ok());
  EXPECT_EQ(truck.pallet("id3").state, PalletState::kStanding);
  for (const char* id : {"id1", "id2"}) EXPECT_EQ(truck.pallet(id).state, PalletState::kStanding) << id;
}

TEST(PalletTracker, an_answer_that_is_told_again_changes_nothing) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(5, 0);
  ASSERT_TRUE(truck.tracker.correct(is_the_same(truck, "id2", "id1")).ok());
  EXPECT_EQ(truck.tracker.correct(is_the_same(truck, "id2", "id1")).error(), CorrectionFault::kSeenSince);
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding);
}

TEST(PalletTracker, a_correction_that_cannot_be_meant_changes_nothing) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(9, 9, PalletTruck::sscc(2));
  PalletCorrection answer = is_the_same(truck, "id1", "id2");
  EXPECT_EQ(truck.tracker.correct(answer).error(), CorrectionFault::kTwoLabels);
  answer.sscc = PalletTruck::sscc(2);
  EXPECT_TRUE(truck.tracker.correct(answer).ok()) << "the first was misread";
  answer = PalletCorrection();
  answer.stamp = truck.now;
  answer.id = "id2";
  answer.reason = std::string(kLongestReason + 1, 'x');
  EXPECT_EQ(truck.tracker.correct(answer).error(), CorrectionFault::kReason);
  answer.reason = "fallen over";
  answer.pose = pose_of(truck.pallet("id2"));
  answer.pose->T_map_pallet.rotate(Eigen::AngleAxisd(radians(90), Eigen::Vector3d::UnitX()));
  EXPECT_EQ(truck.tracker.correct(answer).error(), CorrectionFault::kPose);
}

TEST(PalletTracker, what_left_by_a_dock_stays_gone_whatever_it_proves_to_be) {
  PalletTrackerParams params;
  Zone dock;
  dock.code = "D";
  dock.kind = ZoneKind::kDock;
  dock.polygon_map = rectangle({50, 0}, 0, {4, 4});
  params.zones = {dock};
  PalletTruck truck(params);
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0.9, PalletTruck::sscc(2));
  truck.set_sigma(0.4);
  truck.stand(0, 0.5);
  ASSERT_EQ(truck.lift().at(0).candidates.size(), 2u);
  truck.set_sigma(0.01);
  truck.stand(50, 0);
  ASSERT_EQ(truck.lower().at(0).pallet.state, PalletState::kGone);

  PalletCorrection answer;
  answer.stamp = truck.now;
  answer.id = "id3";
  answer.same_as = "id1";
  ASSERT_TRUE(truck.tracker.correct(answer).ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kGone);
  EXPECT_EQ(truck.pallet("id1").zone, "D");
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kStanding);

  PalletCorrection moved;
  moved.stamp = truck.now;
  moved.id = "id1";
  moved.pose = PalletPose();
  ASSERT_TRUE(truck.tracker.correct(moved).ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding) << "told to stand elsewhere it is back";
  moved.pose->T_map_pallet.translation().x() = 50;
  ASSERT_TRUE(truck.tracker.correct(moved).ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kGone) << "as if it had been set down there";
}

TEST(PalletTracker, asks_where_one_stands_that_is_not_quite_there) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.stand(0, 0.3);
  const auto changes = truck.lift();
  ASSERT_FALSE(changes.empty());
  EXPECT_EQ(changes[0].pallet.state, PalletState::kUncertain);
  EXPECT_EQ(changes[0].candidates, std::vector<std::string>{"id1"});
}

TEST(PalletTracker, a_label_read_late_settles_what_was_asked) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0.9, PalletTruck::sscc(2));
  truck.set_sigma(0.4);
  truck.stand(0, 0.5);
  truck.lift();
  const auto changes = truck.load(true, PalletTruck::sscc(1));
  ASSERT_FALSE(changes.empty());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kOnFork);
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kStanding);
  EXPECT_EQ(truck.pallet("id3").state, PalletState::kGone);
  truck.set_sigma(0.01);
  truck.stand(30, 0);
  EXPECT_EQ(truck.lower().at(0).pallet.id, "id1");
}

TEST(PalletTracker, a_label_that_nobody_has_leaves_those_without_one) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(0, 0.9);
  truck.set_sigma(0.4);
  truck.stand(0, 0.5);
  ASSERT_EQ(truck.lift().at(0).candidates.size(), 2u);
  const auto changes = truck.load(true, PalletTruck::sscc(4));
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].pallet.id, "id3");
  EXPECT_EQ(changes[0].pallet.sscc, PalletTruck::sscc(4));
  EXPECT_EQ(changes[0].candidates, std::vector<std::string>{"id2"});
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding) << "it bears another";
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kUncertain);
}

TEST(PalletTracker, a_label_outweighs_the_map) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(5, 0, PalletTruck::sscc(2));
  truck.stand(0, 0);
  const auto changes = truck.lift(PalletTruck::sscc(2));
  EXPECT_EQ(changes.at(0).pallet.id, "id2");
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kUncertain) << "another was lifted where it stood";
}

TEST(PalletTracker, a_label_names_the_nameless_that_stands_there) {
  PalletTruck truck;
  truck.bring(0, 0);
  truck.stand(0, 0);
  const auto changes = truck.lift(PalletTruck::sscc(4));
  EXPECT_EQ(changes.at(0).pallet.id, "id1");
  EXPECT_EQ(changes.at(0).pallet.sscc, PalletTruck::sscc(4));
}

TEST(PalletTracker, stacks_and_carries_two_at_once) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  EXPECT_EQ(truck.bring(0.02, 0.01, PalletTruck::sscc(2), 1.1).at(0).pallet.level, 1);
  truck.stand(0, 0);
  // The reader may see the label of the upper one.
  const auto picked = truck.lift(PalletTruck::sscc(2));
  ASSERT_EQ(picked.size(), 2u);
  EXPECT_EQ(picked[0].pallet.id, "id1");
  EXPECT_EQ(picked[1].pallet.id, "id2");
  truck.stand(10, 0);
  const auto dropped = truck.lower();
  ASSERT_EQ(dropped.size(), 2u);
  EXPECT_EQ(dropped[0].pallet.level, 0);
  EXPECT_EQ(dropped[1].pallet.level, 1);
  EXPECT_NEAR(dropped[1].pallet.T_map_pallet.translation().x(), 10.02, 0.01);
  EXPECT_NEAR(dropped[1].pallet.T_map_pallet.translation().z(), 1.1, 0.01);
  truck.stand(10.02, 0.01);
  const auto upper = truck.lift("", 1.1);
  ASSERT_EQ(upper.size(), 1u);
  EXPECT_EQ(upper[0].pallet.id, "id2");
}

TEST(PalletTracker, tells_racks_docks_and_who_stood_there) {
  PalletTrackerParams params;
  Zone rack, dock;
  rack.code = "R";
  rack.polygon_map = rectangle({0, 0}, 0, {4, 4});
  rack.levels_m = {0, 1.6, 3.2};
  dock.code = "D";
  dock.kind = ZoneKind::kDock;
  dock.polygon_map = rectangle({10, 0}, 0, {4, 4});
  params.zones = {rack, dock};
  PalletTruck truck(params);
  const Pallet high = truck.bring(0, 0, "", 3.22).at(0).pallet;
  EXPECT_EQ(high.level, 2);
  EXPECT_EQ(high.zone, "R");
  EXPECT_EQ(truck.bring(10, 0).at(0).pallet.state, PalletState::kGone);
  truck.bring(0, 0.05, "", 3.2);
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kUncertain) << "another was set down where it stood";
}

TEST(PalletTracker, marks_what_was_set_down_while_localization_coasts) {
  PalletTruck truck;
  truck.bring(0, 0);
  EXPECT_FALSE(truck.pallet("id1").coasting);
  truck.coasting = true;
  truck.set_sigma(0.3);
  const Pallet pallet = truck.bring(5, 0).at(0).pallet;
  EXPECT_TRUE(pallet.coasting);
  EXPECT_GT(std::sqrt(pallet.covariance(0, 0)), 0.3);
  EXPECT_EQ(pallet.state, PalletState::kStanding);
}

/// A load counts as set down 0.3 s after it was: what localization says by then is another pose's.
TEST(PalletTracker, coasting_is_that_of_the_instant) {
  PalletTruck truck;
  const auto set_down = [&](bool then, bool later) {
    truck.coasting = false;
    truck.stand(100, 0);
    truck.lift();
    truck.stand(0, 0);
    truck.coasting = then;
    truck.load(true);
    truck.load(false);
    truck.coasting = later;
    return truck.lower().at(0).pallet.coasting;
  };
  EXPECT_FALSE(set_down(false, true));
  EXPECT_TRUE(set_down(true, false));
  EXPECT_FALSE(set_down(false, false));
}

TEST(PalletTracker, coasts_where_localization_says_nothing) {
  PalletTruck truck;
  truck.has_integrity = false;
  truck.bring(0, 0);
  EXPECT_TRUE(truck.pallet("id1").coasting) << "what was said in the beginning is old";
  truck.has_integrity = true;
  truck.bring(5, 0);
  EXPECT_FALSE(truck.pallet("id2").coasting);
}

TEST(PalletTracker, loses_no_pallet_without_a_pose) {
  PalletTruck truck;
  truck.stand(0, 0);
  truck.lift(PalletTruck::sscc(1));
  truck.has_pose = false;
  truck.now += std::chrono::seconds(1);
  truck.load(true);
  const auto dropped = truck.lower();
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].pallet.state, PalletState::kUncertain);
  EXPECT_GE(dropped[0].pallet.covariance(0, 0), 1e6);
  EXPECT_EQ(truck.tracker.drops()[PalletDrop::kNoPose], 1u);
  truck.has_pose = true;
  truck.stand(3, 0);
  EXPECT_EQ(truck.lift().at(0).pallet.state, PalletState::kOnFork) << "one lost elsewhere is no candidate";
  truck.lower();
  truck.stand(30, 0);
  EXPECT_EQ(truck.lift(PalletTruck::sscc(1)).at(0).pallet.id, "id1") << "its label finds it";
}

TEST(PalletTracker, drops_and_counts_what_it_cannot_use) {
  PalletTruck truck;
  truck.stand(0, 0);
  const auto changes = truck.lift("376104250021234568");
  EXPECT_EQ(changes.at(0).pallet.sscc, "");
  EXPECT_GT(truck.tracker.drops()[PalletDrop::kLabel], 0u);
  EXPECT_TRUE(truck.tracker.add_load({truck.now - std::chrono::seconds(1), 0, false, ""}).empty());
  EXPECT_TRUE(truck.tracker.add_load({truck.now, 0, false, ""}).empty());
  EXPECT_EQ(truck.tracker.drops()[PalletDrop::kLateLoad], 2u);
  PoseEstimate late;
  late.stamp = truck.now - std::chrono::seconds(1);
  EXPECT_EQ(truck.tracker.add_pose(late), PalletDrop::kLatePose);
  truck.load(true, PalletTruck::sscc(1));
  truck.load(true, PalletTruck::sscc(2));
  EXPECT_EQ(truck.tracker.drops()[PalletDrop::kLabelConflict], 1u);
  EXPECT_EQ(truck.pallet("id1").sscc, PalletTruck::sscc(1));
}

TEST(PalletTracker, goes_on_after_a_restart_with_its_load) {
  PalletTruck before;
  before.bring(0, 0, PalletTruck::sscc(1));
  before.stand(5, 0, radians(180));
  before.lift();

  PalletTruck after;
  after.tracker.restore(before.tracker.ledger().kept(), before.tracker.carried());
  after.stand(7, 1, radians(90));
  after.work(true, "", 0);
  const auto dropped = after.lower();
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].sequence, 4u);
  EXPECT_EQ(dropped[0].pallet.id, "id2");
  EXPECT_NEAR((dropped[0].pallet.T_map_pallet.translation() - Eigen::Vector3d(7, 1, 0)).norm(), 0, 1e-9);
}

TEST(PalletTracker, tells_again_what_somebody_missed_also_after_a_restart) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  const auto numbers = [](const PalletTracker::Changes& changes) {
    std::vector<std::uint64_t> out;
    for (const PalletChange& change : changes) out.push_back(change.sequence);
    return out;
  };
  truck.bring(5, 0);
  EXPECT_EQ(numbers(truck.tracker.ledger().after(2)), (std::vector<std::uint64_t>{3, 4}));
  EXPECT_TRUE(truck.tracker.ledger().after(4).empty());
  // One pallet goes to and fro until all else is older than what is told again; its last change is kept all the same.
  for (int i = 0; i < 260; ++i) {
    truck.lift();
    truck.lower();
  }
  PalletTruck later;
  later.tracker.restore(truck.tracker.ledger().kept(), truck.tracker.carried());
  for (const PalletTruck* each : {&truck, &later}) {
    const PalletLedger& ledger = each->tracker.ledger();
    EXPECT_EQ(ledger.last(), 524u);
    EXPECT_EQ(ledger.kept().size(), 501u);
    const auto told = numbers(ledger.after(0));
    ASSERT_EQ(told.size(), 500u);
    EXPECT_EQ(told.front(), 25u);
    EXPECT_EQ(told.back(), 524u);
    EXPECT_EQ(each->pallet("id1").sscc, PalletTruck::sscc(1));
    EXPECT_EQ(ledger.after(523).front().kind, PalletChangeKind::kDrop);
  }
}

TEST(PalletTracker, keeps_pallets_when_time_goes_backwards) {
  PalletTruck truck;
  truck.bring(0, 0);
  truck.now = Stamp(std::chrono::seconds(10));
  truck.tracker.reset_time();
  truck.load(false);
  truck.stand(0, 0);
  EXPECT_EQ(truck.lift().at(0).pallet.id, "id1");
}

TEST(PalletTracker, refuses_corrections_that_cannot_be) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(5, 0, PalletTruck::sscc(2));
  const auto fault = [&](auto&& change) {
    PalletCorrection correction;
    correction.stamp = truck.now;
    correction.id = "id1";
    change(correction);
    const auto result = truck.tracker.correct(correction);
    EXPECT_FALSE(result.ok());
    return result.ok() ? CorrectionFault::kType : result.error();
  };
  using C = PalletCorrection;
  EXPECT_EQ(fault([](C& c) { c.id = "id9"; }), CorrectionFault::kUnknownPallet);
  EXPECT_EQ(fault([](C& c) { c.same_as = "id1"; }), CorrectionFault::kUnknownSame);
  EXPECT_EQ(fault([](C& c) { c.sscc = "1"; }), CorrectionFault::kSscc);
  EXPECT_EQ(fault([](C& c) { c.sscc = PalletTruck::sscc(2); }), CorrectionFault::kSsccTaken);
  EXPECT_EQ(fault([](C& c) { c.type = "none"; }), CorrectionFault::kType);
  EXPECT_EQ(fault([](C& c) { c.pose.emplace().T_map_pallet.translation().x() = 1e5; }), CorrectionFault::kPose);
  EXPECT_EQ(fault([](C& c) { c.pose.emplace().covariance(0, 0) = INFINITY; }), CorrectionFault::kPose);
  truck.stand(0, 0);
  truck.lift();
  EXPECT_EQ(fault([](C& c) { c.gone = true; }), CorrectionFault::kOnFork);
  EXPECT_EQ(fault([](C& c) { c.pose = PalletPose(); }), CorrectionFault::kOnFork);
}

TEST(PalletTracker, a_new_pallet_is_what_its_zone_holds) {
  PalletTrackerParams params;
  params.sizes = {{"epal", {1.2, 0.8}}, {"half", {0.8, 0.6}}};
  Zone zone;
  zone.polygon_map = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  zone.pallet_type = "half";
  params.zones = {zone};
  PalletTruck truck(params);
  truck.stand(0, 0);
  const auto lifted = truck.lift();
  ASSERT_EQ(lifted.size(), 1u);
  EXPECT_EQ(lifted[0].pallet.type, "half");
  // Pushed on as far as it goes: half its own length ahead of the fork, which is 0.6 m before the zone's middle.
  EXPECT_NEAR(lifted[0].pallet.T_map_pallet.translation().x(), -0.2, 1e-9);
  truck.lower();
  truck.stand(5, 0);
  EXPECT_EQ(truck.lift()[0].pallet.type, "epal");
}

TEST(PalletTracker, takes_a_persons_word) {
  PalletTrackerParams params;
  params.sizes = {{"industrial", {1.2, 1.0}}, {"epal", {1.2, 0.8}}};
  PalletTruck truck(params);
  truck.bring(0, 0);
  PalletCorrection correction;
  correction.stamp = truck.now;
  correction.id = "id1";
  correction.sscc = PalletTruck::sscc(3);
  correction.pose = PalletPose();
  correction.pose->T_map_pallet.translation() << 2, 2, 0;
  ASSERT_TRUE(truck.tracker.correct(correction).ok());
  EXPECT_EQ(truck.pallet("id1").sscc, PalletTruck::sscc(3));
  EXPECT_EQ(truck.pallet("id1").T_map_pallet.translation().x(), 2);
  PalletCorrection type;
  type.stamp = truck.now;
  type.id = "id1";
  type.type = "epal";
  ASSERT_TRUE(truck.tracker.correct(type).ok());
  EXPECT_EQ(truck.pallet("id1").type, "epal");
  PalletCorrection gone;
  gone.stamp = truck.now;
  gone.id = "id1";
  gone.gone = true;
  ASSERT_TRUE(truck.tracker.correct(gone).ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kGone);
}

TEST(PalletTracker, where_a_person_says_that_one_stands_no_other_does) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(5, 0, PalletTruck::sscc(2));
  PalletCorrection correction;
  correction.stamp = truck.now;
  correction.id = "id1";
  correction.pose = pose_of(truck.pallet("id2"));
  correction.gone = true;
  ASSERT_TRUE(truck.tracker.correct(correction).ok());
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kStanding) << "what is gone is in nobody's way";
  correction.gone = false;
  const auto changes = truck.tracker.correct(correction);
  ASSERT_TRUE(changes.ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding);
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kUncertain);
  ASSERT_EQ(changes->size(), 2u);
  EXPECT_EQ(changes->at(1).reason, "another pallet was told to be where it stood");
  PalletCorrection confirmed;
  confirmed.stamp = truck.now;
  confirmed.id = "id2";
  ASSERT_TRUE(truck.tracker.correct(confirmed).ok());
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kStanding);
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kUncertain) << "not both of them";
}

TEST(PalletTracker, one_without_a_place_accuses_nobody) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(2));
  truck.lift();
  truck.has_pose = false;
  truck.now += std::chrono::seconds(1);
  truck.load(true);
  truck.lower();
  truck.has_pose = true;
  truck.bring(0, 0, PalletTruck::sscc(1));
  PalletCorrection confirmed;
  confirmed.stamp = truck.now;
  confirmed.id = "id1";
  ASSERT_TRUE(truck.tracker.correct(confirmed).ok());
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding) << "somewhere";
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kStanding) << "where the other was last";
}

}  // namespace
}  // namespace lodestar
