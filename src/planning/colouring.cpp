#include "lodestar/planning/colouring.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <queue>
#include <random>
#include <set>
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

/// A search for a colouring with one colour less, over colourings that still have conflicts: in each move a node in
/// conflict takes the colour that its neighbours have least, and may not turn back for a while.
class Tabu {
 public:
  Tabu(const ConflictGraph& graph, const Colouring& start)
      : graph_(graph),
        count_(static_cast<std::size_t>(start.count) - 1),
        colours_(start.colours),
        around_(graph.size() * count_, 0),
        free_at_(graph.size() * count_, 0) {
    for (int& colour : colours_)
      if (colour == start.count - 1) colour = static_cast<int>(random_() % count_);
    for (std::size_t node = 0; node < graph.size(); ++node)
      for (const int other : graph[node]) ++around(other, colours_[node]);
    for (std::size_t node = 0; node < graph.size(); ++node) note(static_cast<int>(node));
  }

  /// False where `moves` did not suffice.
  bool search(int moves) {
    for (int move = 0; move < moves && !in_conflict_.empty(); ++move) step(move);
    return in_conflict_.empty();
  }

  Colouring colouring() const { return {colours_, static_cast<int>(count_)}; }

 private:
  std::size_t cell(int node, int colour) const {
    return static_cast<std::size_t>(node) * count_ + static_cast<std::size_t>(colour);
  }
  int& around(int node, int colour) { return around_[cell(node, colour)]; }
  int colour_of(int node) const { return colours_[static_cast<std::size_t>(node)]; }

  void note(int node) {
    if (around(node, colour_of(node)) > 0)
      in_conflict_.insert(node);
    else
      in_conflict_.erase(node);
  }

  void step(int move) {
    int best_node = -1, best_colour = 0, best = std::numeric_limits<int>::max(), ties = 0;
    for (const int node : in_conflict_)
      for (int colour = 0; colour < static_cast<int>(count_); ++colour) {
        const int change = around(node, colour) - around(node, colour_of(node));
        if (colour == colour_of(node) || change > best || free_at_[cell(node, colour)] > move) continue;
        ties = change < best ? 1 : ties + 1;
        best = change;
        if (random_() % static_cast<unsigned>(ties) != 0) continue;
        best_node = node;
        best_colour = colour;
      }
    if (best_node >= 0) take(best_node, best_colour, move);
  }

  void take(int node, int colour, int move) {
    const int before = colour_of(node);
    const int length =
        static_cast<int>(random_() % 10) + static_cast<int>(0.6 * static_cast<double>(in_conflict_.size()));
    free_at_[cell(node, before)] = move + 1 + length;
    colours_[static_cast<std::size_t>(node)] = colour;
    for (const int other : graph_[static_cast<std::size_t>(node)]) {
      --around(other, before);
      ++around(other, colour);
      if (colour_of(other) == before || colour_of(other) == colour) note(other);
    }
    note(node);
  }

  const ConflictGraph& graph_;
  std::size_t count_;
  std::vector<int> colours_;
  std::vector<int> around_;   ///< for each node and colour: neighbours that have it
  std::vector<int> free_at_;  ///< for each node and colour: the move from which on it may be taken again
  std::set<int> in_conflict_;
  std::mt19937 random_{1};
};

}  // namespace

Colouring colour(const ConflictGraph& graph, int enough, int moves) {
  Colouring out = dsatur(graph);
  while (out.count > std::max(enough, 1)) {
    Tabu tabu(graph, out);
    if (!tabu.search(moves)) break;
    out = tabu.colouring();
  }
  return out;
}

}  // namespace lodestar
