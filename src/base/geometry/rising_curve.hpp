#pragma once

#include <cmath>

namespace lodestar {

/// A curve at one argument.
struct CurvePoint {
  double value, slope;
};

/// Slopes below this count as flat: the inverse would be worthless.
constexpr double kLeastSlope = 1e-6;

/// Largest argument in [0, limit] up to which `margin(argument)` stays above kLeastSlope; `limit` where it always does.
/// The scan is fine enough that a margin with a curvature below 500 cannot reach zero unseen between two steps.
template <class Margin>
double rising_limit(Margin margin, double limit) {
  constexpr int kSteps = 32768;
  double good = 0;
  for (int i = 1; i <= kSteps; ++i) {
    double bad = limit * i / kSteps;
    if (margin(bad) > kLeastSlope) {
      good = bad;
      continue;
    }
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (good + bad);
      (margin(middle) > kLeastSlope ? good : bad) = middle;
    }
    return good;
  }
  return limit;
}

/// The argument in [0, limit] at which a rising curve through the origin reaches `value`, which it must reach there.
/// Newton, kept inside the bracket by bisection, which also helps where Newton creeps (next to a pole).
template <class Curve>
double invert_rising(Curve curve, double value, double limit) {
  double low = 0, high = limit, argument = std::fmin(value, limit);
  double best = argument, least = INFINITY, before = INFINITY;
  for (int i = 0; i < 100 && least > 0; ++i) {
    const CurvePoint at = curve(argument);
    const double excess = at.value - value, size = std::abs(excess);
    (excess > 0 ? high : low) = argument;
    if (size < least) {
      best = argument;
      least = size;
    }
    double next = argument - excess / at.slope;
    if (std::abs(next - argument) <= 1e-16 * argument && size <= 1e-12 * value) break;
    if (!(next >= low && next <= high) || size > 0.5 * before) next = 0.5 * (low + high);
    before = size;
    argument = next;
  }
  return best;
}

}  // namespace lodestar
