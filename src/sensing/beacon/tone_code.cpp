#include "lodestar/sensing/beacon/tone_code.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lodestar {

ToneMargins::ToneMargins(const ToneCodeParams& params)
    : balance(std::pow(10.0, -params.balance_db / 10.0)), margin(std::pow(10.0, -params.margin_db / 10.0)) {}

ToneSet decide_code(const TonePowers& power, const ToneMargins& margins) {
  std::array<int, ToneSet::kMaxTones> order;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.begin() + power.size(), [&](int a, int b) { return power[a] > power[b]; });
  const auto ranked = [&](Eigen::Index rank) {
    return rank < power.size() ? static_cast<double>(power[order[static_cast<std::size_t>(rank)]]) : 0.0;
  };

  ToneSet code;
  for (Eigen::Index n = 0; n < std::min<Eigen::Index>(kMaxTonesPerCode, power.size()); ++n) {
    if (ranked(n) <= 0 || ranked(n) < margins.balance * ranked(0)) return {};
    code.insert(order[static_cast<std::size_t>(n)]);
    if (ranked(n + 1) <= margins.margin * ranked(n)) return code;
  }
  return {};
}

}  // namespace lodestar
