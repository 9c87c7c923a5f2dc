#include "lodestar/sensing/beacon/tone_bank.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {

ToneBank::ToneBank(int slots, const std::vector<double>& tones_hz)
    : tones_hz_(tones_hz),
      waves_(Basis::Zero(2 * static_cast<Eigen::Index>(tones_hz.size()), slots)),
      basis_(waves_),
      gram_(Basis::Identity(basis_.rows(), basis_.rows())),
      spans_(Eigen::Matrix2Xf::Zero(2, basis_.rows())) {}

ToneBank::ToneBank(const std::vector<Stamp>& stamps, const std::vector<double>& tones_hz)
    : ToneBank(static_cast<int>(stamps.size()), tones_hz) {
  for (std::size_t i = 0; i < stamps.size(); ++i) set(static_cast<int>(i), stamps[i]);
  update();
}

void ToneBank::set(int slot, Stamp stamp) {
  if (!started_) epoch_ = stamp;
  started_ = true;
  const double time_s = seconds(stamp - epoch_);
  for (std::size_t k = 0; k < tones_hz_.size(); ++k) {
    const double phase = 2.0 * kPi * tones_hz_[k] * time_s;
    waves_(2 * static_cast<Eigen::Index>(k), slot) = static_cast<float>(std::cos(phase));
    waves_(2 * static_cast<Eigen::Index>(k) + 1, slot) = static_cast<float>(std::sin(phase));
  }
}

void ToneBank::update() {
  // A tone that the stamps cannot tell from a constant (an alias of 0 Hz) leaves nothing: zero, so its power is zero.
  const float least = 1e-6f * static_cast<float>(slots());
  const auto normalize_or_clear = [least](auto&& row) {
    const float square = row.squaredNorm();
    const float scale = square > least ? 1.0f / std::sqrt(square) : 0.0f;
    row *= scale;
    return scale;
  };
  for (Eigen::Index k = 0; k < basis_.rows(); k += 2) {
    auto cosine = basis_.row(k), sine = basis_.row(k + 1);
    cosine.array() = waves_.row(k).array() - waves_.row(k).mean();
    const float cosine_scale = normalize_or_clear(cosine);
    sine.array() = waves_.row(k + 1).array() - waves_.row(k + 1).mean();
    const float common = cosine.dot(sine);
    sine -= common * cosine;
    const float sine_scale = normalize_or_clear(sine);
    spans_.middleCols<2>(k) << cosine_scale, -common * sine_scale * cosine_scale, 0, sine_scale;
  }
  gram_.noalias() = basis_ * basis_.transpose();
}

bool ToneBank::is_one_rhythm(const ToneSet& code) const {
  constexpr double kOff = 0.01;  // of the lowest tone
  double lowest_hz = std::numeric_limits<double>::infinity();
  for (int k = 0; k < tones(); ++k)
    if (code.contains(k)) lowest_hz = std::min(lowest_hz, tones_hz_[static_cast<std::size_t>(k)]);
  for (int k = 0; k < tones(); ++k) {
    if (!code.contains(k)) continue;
    const double beside_hz = std::remainder(tones_hz_[static_cast<std::size_t>(k)], lowest_hz);
    if (std::abs(beside_hz) > kOff * lowest_hz) return false;
  }
  return true;
}

}  // namespace lodestar
