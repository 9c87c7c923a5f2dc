#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/fusion/error_state.hpp"

namespace lodestar::fusion {

using Event = std::variant<ImuSample, OdometrySample, BeaconBearings, Fix>;

inline bool is_motion(const Event& event) { return event.index() < 2; }

/// What was measured in the last seconds, in the order of the stamps, each with the state after it. Memory of states is
/// used again.
class StateBuffer {
 public:
  struct Entry {
    Stamp stamp;
    Event event;
    std::unique_ptr<FilterState> state;  ///< null: before the start
  };

  std::size_t size() const { return entries_.size(); }
  bool empty() const { return entries_.empty(); }
  const Entry& operator[](std::size_t i) const { return entries_[i]; }
  const Entry& back() const { return entries_.back(); }

  /// Whether an event of this kind (Event::index) has this very stamp.
  bool contains(Stamp stamp, std::size_t kind) const;

  /// The number of entries with a stamp not after this one.
  std::size_t count_until(Stamp stamp) const;

  /// Puts an event behind those of the same and of earlier stamps; returns where.
  std::size_t insert(Stamp stamp, Event event);

  /// The entry's state, made where there is none.
  FilterState& state(std::size_t i);

  /// The first sample of this kind at or after entry i. Null: none.
  template <class Sample>
  const Sample* next(std::size_t i) const {
    for (; i < entries_.size(); ++i)
      if (const auto* sample = std::get_if<Sample>(&entries_[i].event)) return sample;
    return nullptr;
  }

  std::optional<std::size_t> newest_motion() const;

  /// Lets go of what is older, but for the newest entry among it, from whose state the rest starts.
  void drop_before(Stamp oldest);

  void forget_states();
  void clear();

 private:
  void recycle(Entry& entry);

  std::deque<Entry> entries_;
  std::vector<std::unique_ptr<FilterState>> spare_;
};

}  // namespace lodestar::fusion
