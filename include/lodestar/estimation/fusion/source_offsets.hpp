#pragma once

#include <optional>

#include "lodestar/estimation/fusion/error_state.hpp"

namespace lodestar::fusion {

/// The index of a source's offset, or none.
std::optional<int> find_offset(const FilterState& state, std::uint64_t source);

/// Opens an offset with value 0 and covariance `prior`, uncorrelated with all else. When there is no room, the offset
/// that has not been seen for longest makes room, but none seen less than `keep_s` ago; then there is none.
std::optional<int> open_offset(FilterState& state, std::uint64_t source, const Eigen::Matrix3d& prior, double keep_s);

/// Puts an offset back to value 0 and covariance `prior`, uncorrelated with all else.
void restart_offset(FilterState& state, int index, const Eigen::Matrix3d& prior);

/// One step of a first-order Gauss-Markov process with stationary covariance `prior`: the offset keeps `keep` (0 .. 1)
/// of itself.
void relax_offset(FilterState& state, int index, double keep, const Eigen::Matrix3d& prior);

}  // namespace lodestar::fusion
