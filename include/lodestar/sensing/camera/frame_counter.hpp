#pragma once

#include <cstdint>
#include <optional>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// Frames that never arrived, by the gaps of their ids, and how evenly the others come.
class FrameCounter {
 public:
  /// @param id_bits ids wrap around at 2^id_bits; GigE Vision leaves 0 out
  explicit FrameCounter(int id_bits);

  void add(std::uint64_t id, Stamp stamp);

  std::uint64_t frames() const { return frames_; }
  std::uint64_t dropped() const { return dropped_; }
  double period_s() const { return period_s_; }  ///< mean of some fifty intervals, by one frame each; 0: unknown
  double jitter_s() const;                       ///< rms of the intervals about their mean, of some fifty intervals

 private:
  std::uint64_t mask_;
  std::optional<std::uint64_t> last_id_;
  Stamp last_stamp_;
  std::uint64_t frames_ = 0, dropped_ = 0;
  double period_s_ = 0, variance_s2_ = 0;
  int intervals_ = 0;
};

}  // namespace lodestar
