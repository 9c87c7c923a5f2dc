#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// Where base_link really was (/ground_truth/pose), interpolated: linear in position, slerp in orientation.
class TruthTrack {
 public:
  struct Sample {
    Stamp stamp;
    RigidTransform T_map_base = RigidTransform::Identity();
  };

  /// No word of the truth is believed across a longer gap.
  static constexpr double kMaxGap_s = 0.2;

  TruthTrack();
  ~TruthTrack();
  TruthTrack(TruthTrack&&) noexcept;
  TruthTrack& operator=(TruthTrack&&) noexcept;

  /// @return false, and left out: not later than the sample before
  bool add(const Sample& sample);

  bool empty() const { return samples_.empty(); }
  const std::vector<Sample>& samples() const { return samples_; }
  Stamp begin() const { return samples_.front().stamp; }
  Stamp end() const { return samples_.back().stamp; }

  /// None outside [begin, end] and in a gap.
  std::optional<RigidTransform> at(Stamp stamp) const;
  /// Horizontal speed in m/s, over 0.1 s about the stamp (less at either end). None where at() has none.
  std::optional<double> speed_m_s(Stamp stamp) const;

 private:
  class Interpolator;
  std::vector<Sample> samples_;
  std::unique_ptr<Interpolator> interpolator_;
};

}  // namespace lodestar
