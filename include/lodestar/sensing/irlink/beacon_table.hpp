#pragma once

#include <map>
#include <optional>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// What is known of each beacon: from the site file, from its own announcements, or both.
class BeaconTable {
 public:
  struct Entry {
    Beacon beacon;
    bool in_site_file = false;
    bool conflict = false;               ///< site file and announcement disagree by more than 3 sigma: not used
    std::optional<Announcement> last;    ///< empty: never heard
    std::uint64_t heard = 0;
  };

  explicit BeaconTable(const Site& site);

  /// Takes an announcement in, or says why not; counts either way. A conflict takes the beacon out of force.
  std::optional<IrDrop> accept(const Announcement& announcement);

  /// Counts a frame that the decoder refused.
  void count(IrDrop reason) { drops_.add(reason); }

  /// The beacons in force: all that are known and not in conflict.
  std::vector<Beacon> beacons() const;
  /// Grows with each change of beacons().
  std::uint64_t revision() const { return revision_; }

  const std::map<BeaconId, Entry>& entries() const { return entries_; }
  const DropCounts<IrDrop>& drops() const { return drops_; }
  std::uint64_t accepted() const { return accepted_; }

  /// Forgets superframe phase and ages, keeps positions (time went backwards).
  void reset_time();

 private:
  std::map<BeaconId, Entry> entries_;
  DropCounts<IrDrop> drops_;
  std::uint64_t accepted_ = 0, revision_ = 0;
  Link link_;
};

}  // namespace lodestar
