#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/site/zone.hpp"
#include "lodestar/estimation/pallet/association.hpp"
#include "lodestar/estimation/pallet/correction.hpp"
#include "lodestar/estimation/pallet/load_watch.hpp"
#include "lodestar/estimation/pallet/pallet_ledger.hpp"
#include "lodestar/estimation/pallet/pose_track.hpp"

namespace lodestar {

struct PalletTrackerParams {
  std::vector<PalletSize> sizes = {
      PalletSize{"epal"}};  ///< one at least; the first is what a new pallet is, where its zone has no other
  std::vector<Zone> zones;
  ForkSigmas sigmas;
  LoadWatchParams load;
  AssociationParams association;
  double pose_kept_s = 5;
  double pose_age_max_s = 0.2;       ///< between a pick or drop and the pose that it is placed by
  double forget_gone_s = 7 * 86400;  ///< pallets that left the site are kept so long
  std::string life;                  ///< UUID of this run, another at each start
};

/// Why a sample was not used, or what it lacked.
enum class PalletDrop {
  kLatePose,       ///< a pose that is not newer than the last one
  kLateLoad,       ///< a load sample that is not newer than the last one
  kLabel,          ///< a label that is no SSCC
  kLabelConflict,  ///< a second label for a pallet whose label was read
  kNoPose,         ///< a pick or drop without a pose, or before it is known where the fork is
  kSilence,        ///< a pick or drop at an unknown instant: no load samples came
  kCount
};
const char* name(PalletDrop reason);

/// One pallet on the fork and how it sits there.
struct CarriedPallet {
  std::string id;
  Seat seat;
};

/// Every pallet by its pose: picks and drops from the load sensor, poses from the truck's, identity by label or place
/// (docs/math/pallet_tracking.md). Time arrives in the data and ids from outside. Each change of a pallet is one
/// PalletChange, in the order of their sequence numbers.
class PalletTracker {
 public:
  using Changes = PalletLedger::Changes;

  /// @param new_id gives an id that no pallet had before
  PalletTracker(const PalletTrackerParams& params, std::function<std::string()> new_id);

  /// Where the fork sits at its lowest; until then picks and drops have no pose.
  void set_fork(const RigidTransform& T_base_fork) { T_base_fork_ = T_base_fork; }
  /// Takes up what an earlier tracker knew: its ledger().kept(), and what was on the fork, from below.
  void restore(const Changes& kept, const std::vector<CarriedPallet>& carried);

  std::optional<PalletDrop> add_pose(const PoseEstimate& pose);
  /// Whether localization has beacons from this instant on; a pose without a word of the last pose_age_max_s coasts.
  void add_integrity(Stamp stamp, bool tracking) { poses_.add_word(stamp, tracking); }
  Changes add_load(const LoadSample& sample);
  Result<Changes, CorrectionFault> correct(const PalletCorrection& correction);

  const PalletLedger& ledger() const { return ledger_; }
  const PalletMap& pallets() const { return ledger_.map(); }
  /// All pallets, ascending by id: those on the fork where the newest pose has them now, and not where they were
  /// lifted.
  std::vector<Pallet> now() const;
  const std::vector<CarriedPallet>& carried() const { return carried_; }
  const DropCounts<PalletDrop>& drops() const { return drops_; }
  /// Forgets poses and load samples; pallets stay (time went backwards).
  void reset_time();

 private:
  /// The fork at the instant of a pick or drop.
  struct Moment {
    Fork fork;
    bool coasting = false;
  };

  std::optional<Moment> moment(const LoadChange& change);
  bool is_riders(const std::string& label, const Fork& fork) const;
  Association identify(const std::string& label, const std::optional<Moment>& at) const;
  std::string new_type(const std::optional<Moment>& at) const;
  Seat seat_of(const Pallet& pallet, bool known, const std::optional<Moment>& at) const;
  void pick(const LoadChange& change);
  void pick_riders(const PalletPose& below, const std::string& type, const LoadChange& change, const Moment& at);
  void drop(const LoadChange& change);
  void set_down(const CarriedPallet& carried, Stamp stamp, const std::optional<Moment>& at);
  void doubt_in_the_way(const Pallet& pallet, Stamp stamp, const std::string& reason);
  void read_late(const LoadSample& sample);
  void carry(const std::vector<CarriedPallet>& carried);
  void rename_carried(const std::string& id, const std::string& same);

  PalletTrackerParams params_;
  std::function<std::string()> new_id_;
  std::optional<RigidTransform> T_base_fork_;
  PalletLedger ledger_;
  LoadWatch load_;
  PoseTrack poses_;
  double fork_height_m_ = 0;            ///< of the newest load sample
  std::vector<CarriedPallet> carried_;  ///< from below
  DropCounts<PalletDrop> drops_;
};

}  // namespace lodestar
