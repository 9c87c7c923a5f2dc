#include "lodestar/evaluation/truth_track.hpp"

#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DInterpolator.h>

#include <algorithm>

namespace lodestar {
namespace {

constexpr double kSpeedHalfWindow_s = 0.05;

/// MRPT's clock counts 100 ns from another epoch; only differences matter here, so the track's first stamp is its zero.
mrpt::Clock::time_point mrpt_time(Stamp stamp, Stamp zero) {
  return mrpt::Clock::time_point(std::chrono::duration_cast<mrpt::Clock::duration>(stamp - zero) +
                                 mrpt::Clock::duration(10'000'000));
}

}  // namespace

class TruthTrack::Interpolator {
 public:
  Interpolator() {
    track_.setInterpolationMethod(mrpt::poses::imLinearSlerp);
    track_.setMaxTimeInterpolation(
        std::chrono::duration_cast<mrpt::Clock::duration>(std::chrono::duration<double>(kMaxGap_s)));
  }
  void add(const Sample& sample, Stamp zero) {
    const mrpt::math::CMatrixDouble33 R(sample.T_map_base.linear().eval());
    const mrpt::math::CVectorFixedDouble<3> t(sample.T_map_base.translation().eval());
    track_.insert(mrpt_time(sample.stamp, zero), mrpt::poses::CPose3D::FromRotationAndTranslation(R, t));
  }
  std::optional<RigidTransform> at(Stamp stamp, Stamp zero) const {
    bool valid = false;
    mrpt::poses::CPose3D pose;
    track_.interpolate(mrpt_time(stamp, zero), pose, valid);
    if (!valid) return std::nullopt;
    RigidTransform T = RigidTransform::Identity();
    T.linear() = pose.getRotationMatrix().asEigen();
    T.translation() << pose.x(), pose.y(), pose.z();
    return T;
  }

 private:
  mrpt::poses::CPose3DInterpolator track_;
};

TruthTrack::TruthTrack() : interpolator_(std::make_unique<Interpolator>()) {}
TruthTrack::~TruthTrack() = default;
TruthTrack::TruthTrack(TruthTrack&&) noexcept = default;
TruthTrack& TruthTrack::operator=(TruthTrack&&) noexcept = default;

bool TruthTrack::add(const Sample& sample) {
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return false;
  samples_.push_back(sample);
  interpolator_->add(sample, begin());
  return true;
}

std::optional<RigidTransform> TruthTrack::at(Stamp stamp) const {
  if (empty() || stamp < begin() || stamp > end()) return std::nullopt;
  return interpolator_->at(stamp, begin());
}

std::optional<double> TruthTrack::speed_m_s(Stamp stamp) const {
  if (empty()) return std::nullopt;
  const Stamp from = std::max(begin(), stamp - from_seconds(kSpeedHalfWindow_s));
  const Stamp to = std::min(end(), stamp + from_seconds(kSpeedHalfWindow_s));
  const auto a = at(from), b = at(to);
  if (!a || !b || to <= from) return std::nullopt;
  return (b->translation() - a->translation()).head<2>().norm() / seconds(to - from);
}

}  // namespace lodestar
