#pragma once

#include <vector>

namespace lodestar {

/// For each node the nodes that must not have its colour, both ways.
using ConflictGraph = std::vector<std::vector<int>>;

/// One colour for each node, no two alike in conflict.
struct Colouring {
  std::vector<int> colours;  ///< from 0
  int count = 0;             ///< of colours, 0 to count - 1
};

/// Few colours: DSATUR (D. Brelaz, Comm. ACM 22, 1979), then one colour after the other is given up by tabu search
/// (A. Hertz, D. de Werra, Computing 39, 1987) until `enough` are left or `moves` do not do for one. The same input
/// gives the same colours.
Colouring colour(const ConflictGraph& graph, int enough, int moves);

}  // namespace lodestar
