#include "lodestar/sensing/beacon/tone_bank.hpp"

#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

/// Scales `v` to length one.
/// A tone that the stamps cannot tell from a constant (an alias of 0 Hz) leaves nothing: zero, so its power is zero.
void normalize_or_clear(Eigen::VectorXd& v) {
  const double length = v.norm();
  if (length > 1e-6 * std::sqrt(static_cast<double>(v.size()))) {
    v /= length;
  } else {
    v.setZero();
  }
}

}  // namespace

ToneBank::ToneBank(const std::vector<Stamp>& stamps, const std::vector<double>& tones_hz)
    : basis_(2 * static_cast<Eigen::Index>(tones_hz.size()), static_cast<Eigen::Index>(stamps.size())) {
  const auto frames = static_cast<Eigen::Index>(stamps.size());
  Eigen::VectorXd time_s(frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    time_s[i] = seconds(stamps[static_cast<std::size_t>(i)] - stamps.back());
  }
  for (std::size_t k = 0; k < tones_hz.size(); ++k) {
    const Eigen::ArrayXd phase = 2.0 * kPi * tones_hz[k] * time_s.array();
    Eigen::VectorXd cosine = phase.cos(), sine = phase.sin();
    cosine.array() -= cosine.mean();
    normalize_or_clear(cosine);
    sine.array() -= sine.mean();
    sine -= cosine.dot(sine) * cosine;
    normalize_or_clear(sine);
    basis_.row(2 * static_cast<Eigen::Index>(k)) = cosine.cast<float>();
    basis_.row(2 * static_cast<Eigen::Index>(k) + 1) = sine.cast<float>();
  }
}

}  // namespace lodestar
