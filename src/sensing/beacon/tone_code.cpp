#include "lodestar/sensing/beacon/tone_code.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestar {

ToneSet decide_code(const std::vector<double>& power, const ToneCodeParams& params) {
  constexpr std::size_t kMaxTonesPerCode = 3;
  std::vector<int> order(power.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return power[static_cast<std::size_t>(a)] > power[static_cast<std::size_t>(b)]; });
  const auto ranked = [&](std::size_t rank) {
    return rank < order.size() ? power[static_cast<std::size_t>(order[rank])] : 0.0;
  };

  const double balance = std::pow(10.0, -params.balance_db / 10.0);
  const double margin = std::pow(10.0, -params.margin_db / 10.0);
  ToneSet code;
  for (std::size_t n = 0; n < std::min(kMaxTonesPerCode, order.size()); ++n) {
    if (ranked(n) <= 0 || ranked(n) < balance * ranked(0)) return {};
    code.insert(order[n]);
    if (ranked(n + 1) <= margin * ranked(n)) return code;
  }
  return {};
}

}  // namespace lodestar
