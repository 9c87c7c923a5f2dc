#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// Whether a frame was sent in its slot and its superframe counter moves forward with time. Model: docs/math/irlink.md.
///
/// - In phase: between the newest accepted frame and this one, counter and slot tell the same time as the stamps, to
///   within a quarter of a slot and 200 ppm (the beacons' clock and the receiver's). Off by less than a superframe is
///   kSlot, by more kSuperframe.
/// - A beacon's own counter grows: the same frame twice is kSuperframe.
/// - A frame older than the newest by more than one superframe is kStamp.
/// - Frames out of phase make phases of their own, which *stand* with five frames within a minute. Without a key one
///   that stands before another frame is accepted is the new phase: a clock was set, or beacons were started anew.
/// - On a site with a key a stranger can only send late what beacons have sent before. So an earlier phase is true as
///   soon as it stands, and at once where the one in force does not; a later one only where it stands and the one in
///   force has not for a minute, as when beacons count from 0 again. Nobody's single recording does either.
///
/// The counter wraps around at 2^32.
class SuperframeClock {
 public:
  static constexpr std::size_t kFramesToStand = 5;
  static constexpr double kStands_s = 60;
  static constexpr std::size_t kMostPhases = 64;  ///< beyond it the one heard least lately is forgotten

  explicit SuperframeClock(const Link& link);

  /// Takes the frame's time as the newest, or says why not.
  std::optional<IrDrop> accept(const Announcement& announcement);

  /// How often the phase was found late: what was accepted before may have been a stranger's recording.
  int corrections() const { return corrections_; }

  /// Whether `before` came later than its counter says by more than a superframe, as an accepted frame counts. What
  /// comes late by less says no more than the beacon itself says then.
  bool is_recording(const Announcement& before, const Announcement& accepted) const;

  /// Forgets everything: the next frame is believed.
  void reset();

 private:
  struct Instant {
    Stamp stamp;
    std::uint32_t superframe;
    int slot;
  };
  /// Frames that are in phase with one another.
  struct Phase {
    Instant newest;
    std::deque<Stamp> heard;  ///< the newest of them, at most kFramesToStand

    void add(const Instant& instant);
    bool is_old(Stamp now) const;
    bool stands(Stamp now) const;
  };
  static Instant instant_of(const Announcement& announcement);
  double late_s(const Instant& reference, const Instant& instant) const;
  bool in_phase(const Instant& reference, const Instant& instant) const;
  bool advances(const Instant& instant, BeaconId beacon) const;
  Phase& other_phase(const Instant& instant);
  bool believes(const Phase& other, double late_s, Stamp now) const;
  void take(const Instant& instant, BeaconId beacon);

  double slot_s_, superframe_s_;
  bool has_key_;
  std::optional<Phase> in_force_;
  std::map<BeaconId, std::uint32_t> superframes_;  ///< the last of each beacon, in force
  std::vector<Phase> others_;                      ///< ascending by when they were heard
  int corrections_ = 0;
};

}  // namespace lodestar
