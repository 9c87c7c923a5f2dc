#include "lodestar/planning/colouring.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <queue>
#include <random>
#include <tuple>

namespace lodestar {

namespace {

/// The first colour that no neighbour has. `taken_by` is room for it: for each colour the last node that met it; as
/// many as there are nodes are enough.
int first_free(const ConflictGraph& graph, int node, const std::vector<int>& colours, std::vector<int>& taken_by) {
  for (const int other : graph[static_cast<std::size_t>(node)]) {
    const int colour = colours[static_cast<std::size_t>(other)];
    if (colour >= 0) taken_by[static_cast<std::size_t>(colour)] = node;
  }
  int colour = 0;
  while (taken_by[static_cast<std::size_t>(colour)] == node) ++colour;
  return colour;
}

/// The node with the most colours around it first.
Colouring dsatur(const ConflictGraph& graph) {
  const std::size_t nodes = graph.size();
  std::vector<std::vector<bool>> around(nodes);
  std::vector<int> saturation(nodes, 0);
  std::vector<int> taken_by(nodes, -1);
  Colouring out{std::vector<int>(nodes, -1), 0};

  using Entry = std::tuple<int, std::size_t, int>;  // saturation, degree, -node; an outdated one is passed over
  std::priority_queue<Entry> queue;
  for (std::size_t i = 0; i < nodes; ++i) queue.emplace(0, graph[i].size(), -static_cast<int>(i));
  while (!queue.empty()) {
    const auto [seen, degree, minus_node] = queue.top();
    queue.pop();
    const auto node = static_cast<std::size_t>(-minus_node);
    if (out.colours[node] >= 0 || seen != saturation[node]) continue;
    const int colour = first_free(graph, -minus_node, out.colours, taken_by);
    out.colours[node] = colour;
    out.count = std::max(out.count, colour + 1);
    for (const int neighbour : graph[node]) {
      const auto other = static_cast<std::size_t>(neighbour);
      auto& known = around[other];
      if (out.colours[other] >= 0) continue;
      if (known.size() <= static_cast<std::size_t>(colour)) known.resize(static_cast<std::size_t>(colour) + 1, false);
      if (known[static_cast<std::size_t>(colour)]) continue;
      known[static_cast<std::size_t>(colour)] = true;
      queue.emplace(++saturation[other], graph[other].size(), -neighbour);
    }
  }
  return out;
}

/// First fit, one colour's nodes after the other's, the colours in a new order.
Colouring refit(const ConflictGraph& graph, const Colouring& before, const std::vector<int>& rank) {
  std::vector<int> order(graph.size());
  std::iota(order.begin(), order.end(), 0);
  const auto rank_of = [&](int node) {
    return rank[static_cast<std::size_t>(before.colours[static_cast<std::size_t>(node)])];
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank_of(a) < rank_of(b); });

  Colouring out{std::vector<int>(graph.size(), -1), 0};
  std::vector<int> taken_by(graph.size(), -1);
  for (const int node : order) {
    const int colour = first_free(graph, node, out.colours, taken_by);
    out.colours[static_cast<std::size_t>(node)] = colour;
    out.count = std::max(out.count, colour + 1);
  }
  return out;
}

}  // namespace

Colouring colour(const ConflictGraph& graph, int enough, int passes) {
  Colouring out = dsatur(graph);
  std::mt19937 random(1);
  for (int pass = 0; pass < passes && out.count > enough; ++pass) {
    std::vector<int> rank;
    for (int colour = 0; colour < out.count; ++colour) rank.push_back(colour);
    if (pass % 2 == 0) {
      std::reverse(rank.begin(), rank.end());
    } else {
      for (std::size_t i = rank.size() - 1; i > 0; --i) std::swap(rank[i], rank[random() % (i + 1)]);
    }
    out = refit(graph, out, rank);
  }
  return out;
}

}  // namespace lodestar
