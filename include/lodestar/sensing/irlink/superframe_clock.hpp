#pragma once

#include <cstdint>
#include <map>
#include <optional>

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
/// - A clock that was set, or beacons that were started anew: five refused frames in a row that are in phase with one
///   another (none accepted in between) are the new phase; the fifth is accepted. On a site with a key the counter
///   must lie ahead of the newest, too: old frames cannot be replayed there, however many.
/// - On a site with a key a frame that comes before its time is true at once: a stranger can only send late what
/// beacons
///   have sent before. It was the phase that was late, as a stranger's first word made it.
///
/// The counter wraps around at 2^32.
class SuperframeClock {
 public:
  static constexpr int kFramesToLearn = 5;

  explicit SuperframeClock(const Link& link);

  /// Takes the frame's time as the newest, or says why not.
  std::optional<IrDrop> accept(const Announcement& announcement);

  /// How often the phase was found late: what was accepted before may have been a stranger's recording.
  int corrections() const { return corrections_; }

  /// Whether `before` came later than its counter says by more than a superframe, as the true frame counts. What comes
  /// late by less says no more than the beacon itself says then.
  bool is_recording(const Announcement& before, const Announcement& true_frame) const;

  /// Forgets everything: the next frame is believed.
  void reset();

 private:
  struct Instant {
    Stamp stamp;
    std::uint32_t superframe;
    int slot;
  };
  static Instant instant_of(const Announcement& announcement);
  double late_s(const Instant& reference, const Instant& instant) const;
  bool in_phase(const Instant& reference, const Instant& instant) const;
  bool advances(const Instant& instant, BeaconId beacon) const;
  bool learn(const Instant& instant);
  void take(const Instant& instant, BeaconId beacon);

  double slot_s_, superframe_s_;
  bool has_key_;
  std::optional<Instant> newest_;
  std::map<BeaconId, std::uint32_t> superframes_;  ///< the last of each beacon
  std::optional<Instant> refused_;                 ///< the last frame out of phase
  int refused_run_ = 0;                            ///< how many of those are in phase with one another
  int corrections_ = 0;
};

}  // namespace lodestar
