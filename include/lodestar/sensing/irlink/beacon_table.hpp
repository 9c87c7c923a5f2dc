#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"
#include "lodestar/sensing/irlink/superframe_clock.hpp"

namespace lodestar {

/// What is known of each beacon: from the site file, from its own announcements, or both.
///
/// - In the site file: without a key an announcement from another slot is dropped (kSlot). One that differs by more
/// than
///   3 sigma on any axis of map (sigma: the file's sigma_m with the rounding to mm), in its tones or, on a site with a
///   key, in its slot, which is then the beacon's own word, is a conflict: it is dropped
///   and takes the beacon out of force until somebody confirms it, for a beacon that was moved or swapped once may hang
///   anywhere. The file's position is the one in use. On a site with a key a conflict that a recording made, heard
///   before the first true frame, is taken back with that frame; one that a true frame made stays.
/// - Not in the site file: the first announcement puts the beacon in force where it says, with sigma_m 0.01 when it
///   calls itself surveyed and 0.10 when not, and later ones within 3 sigma keep it up to date. One that jumps or
///   changes tones is a conflict and takes it out of force; the third in a row that agree with one another is believed.
///   What a recording may have made of it is forgotten likewise, with the first true frame of any beacon.
class BeaconTable {
 public:
  static constexpr double kSurveyedSigma_m = 0.01;
  static constexpr double kUnsurveyedSigma_m = 0.10;
  static constexpr int kRepeatsToBelieve = 3;
  static constexpr std::size_t kMostBeacons = 4096;  ///< beyond it unknown beacons are dropped (kFull)

  struct Entry {
    Beacon beacon;
    bool in_site_file = false;
    bool conflict = false;                      ///< with the site file or with its own earlier word: not used
    bool left_out = false;                      ///< by another table's word: not used
    std::optional<Announcement> contradiction;  ///< that made the conflict; empty: time went backwards since
    std::optional<Announcement> last;           ///< heard in time, agreeing or not; empty: never heard
    std::uint64_t heard = 0;
    int repeats = 0;  ///< announcements in a row that agree with one another

    bool in_force() const { return !conflict && !left_out; }
  };

  explicit BeaconTable(const Site& site);

  /// Takes an announcement in, or says why not; counts either way. A conflict takes the beacon out of force.
  std::optional<IrDrop> accept(const Announcement& announcement);

  /// An earlier run left a beacon of the site file out for what it said then: so does this one, if it still
  /// contradicts.
  void distrust(const Announcement& contradiction);

  /// Takes these beacons out of force, and none else by this word, as a table that has heard more does.
  void leave_out(const std::set<BeaconId>& ids);

  /// Somebody has looked after the beacon: what it last said of itself is right. Whether it has said anything.
  bool confirm(BeaconId id);
  /// The same, with what it said.
  void confirm(const Announcement& announcement);

  /// Counts a frame that the decoder refused.
  void count(IrDrop reason) { drops_.add(reason); }

  /// The beacons in force: all that are known but those in conflict or left out. Ascending by id.
  std::vector<Beacon> beacons() const;
  /// Grows with each change of beacons().
  std::uint64_t revision() const { return revision_; }

  /// The beacons in force with an announcement at most `max_age` from `now`, before or after. Ascending.
  std::vector<BeaconId> heard(Stamp now, Duration max_age) const;

  const std::map<BeaconId, Entry>& entries() const { return entries_; }
  const DropCounts<IrDrop>& drops() const { return drops_; }
  std::uint64_t accepted() const { return accepted_; }
  /// How often what was accepted before was found to be late: a recording.
  int corrections() const { return clock_.corrections(); }

  /// Forgets superframe phase and ages, keeps positions (time went backwards).
  void reset_time();

 private:
  std::optional<IrDrop> judge(const Announcement& announcement);
  std::optional<IrDrop> compare_with_site(Entry& entry, const Announcement& announcement);
  std::optional<IrDrop> compare_with_past(Entry& entry, const Announcement& announcement);
  void forget_recordings(const Announcement& frame);
  void contradict(Entry& entry, const Announcement& announcement);
  void set_conflict(Entry& entry, bool conflict);
  void learn(Entry& entry, const Announcement& announcement);

  std::map<BeaconId, Entry> entries_;
  DropCounts<IrDrop> drops_;
  std::uint64_t accepted_ = 0, revision_ = 0;
  bool has_key_;
  SuperframeClock clock_;
};

}  // namespace lodestar
