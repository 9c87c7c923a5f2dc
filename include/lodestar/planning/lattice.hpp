#pragma once

#include <optional>
#include <vector>

#include "lodestar/planning/colouring.hpp"
#include "lodestar/planning/view.hpp"

namespace lodestar {

/// Colours that repeat as a lattice does: (row + b * column) mod count, for the least count that some b suits. What
/// hangs in rows and columns along x and y, evenly or not, is coloured with fewer colours so than by a search.
/// @return empty where rows and columns cannot be told (two beacons fall on one place), or `most` does not suffice
std::optional<Colouring> lattice_colouring(const std::vector<Lit>& beacons, const ConflictGraph& graph, int most);

}  // namespace lodestar
