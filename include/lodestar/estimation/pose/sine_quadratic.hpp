#pragma once

#include <array>

#include "lodestar/estimation/pose/closed_form.hpp"

namespace lodestar {

/// The yaws (rad) that two beacons allow by the paper's route, for comparison only; nothing but tests and benchmarks
/// calls it. cos(yaw) is eliminated from equation 4, the quadratic in sin(yaw) solved, and the arcsine taken
/// (docs/math/closed_form.md, equation 16):
///     sin(yaw) = [-b c +- |a| sqrt(h^2 - c^2)] / h^2
/// [0] takes +sqrt, [1] takes -sqrt. NaN where rounding or noise carries the sine past 1 (about +-90 deg) or the
/// root's argument below 0. Every yaw beyond +-90 deg comes out mirrored.
/// Source: Heissmeyer, Overmeyer, Müller, "Indoor positioning of vehicles using an active optical infrastructure",
/// Logistics Journal 2013, in the notation of two_beacon_roots.
std::array<double, 2> sine_quadratic_yaws_rad(const LevelledBearing& first, const LevelledBearing& second);

}  // namespace lodestar
