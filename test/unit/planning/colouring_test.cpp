#include "lodestar/planning/colouring.hpp"

#include <gtest/gtest.h>

#include <random>

#include "lodestar/planning/lattice.hpp"

namespace lodestar {
namespace {

void connect(ConflictGraph& graph, int a, int b) {
  graph[static_cast<std::size_t>(a)].push_back(b);
  graph[static_cast<std::size_t>(b)].push_back(a);
}

void expect_proper(const ConflictGraph& graph, const Colouring& colouring) {
  ASSERT_EQ(colouring.colours.size(), graph.size());
  for (std::size_t node = 0; node < graph.size(); ++node) {
    EXPECT_GE(colouring.colours[node], 0);
    EXPECT_LT(colouring.colours[node], colouring.count);
    for (const int other : graph[node])
      EXPECT_NE(colouring.colours[node], colouring.colours[static_cast<std::size_t>(other)]);
  }
}

TEST(Colouring, of_small_graphs_is_exact) {
  EXPECT_EQ(colour({}, 1, 100).count, 0);
  EXPECT_EQ(colour(ConflictGraph(5), 1, 100).count, 1);
  ConflictGraph complete(6), ring(7);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j) connect(complete, i, j);
  for (int i = 0; i < 7; ++i) connect(ring, i, (i + 1) % 7);
  for (const ConflictGraph& graph : {complete, ring}) expect_proper(graph, colour(graph, 1, 100));
  EXPECT_EQ(colour(complete, 1, 100).count, 6);
  EXPECT_EQ(colour(ring, 1, 100).count, 3);
}

TEST(Colouring, of_random_graphs_is_proper_and_search_gives_colours_up) {
  int given_up = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    ConflictGraph graph(120);
    for (int i = 0; i < 120; ++i)
      for (int j = 0; j < i; ++j)
        if (random() % 2 == 0) connect(graph, i, j);
    const Colouring greedy = colour(graph, 1, 0), searched = colour(graph, 1, 3000);
    expect_proper(graph, greedy);
    expect_proper(graph, searched);
    EXPECT_LE(searched.count, greedy.count);
    EXPECT_EQ(searched.colours, colour(graph, 1, 3000).colours);
    given_up += greedy.count - searched.count;
  }
  EXPECT_GE(given_up, 20);
}

TEST(Lattice, colours_rows_and_columns_of_any_pitch) {
  std::vector<Lit> beacons;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 9; ++j) beacons.push_back({{9.0 * i + (i % 2), 11.0 * j + 0.3 * (i % 3), 8}, 15});
  const ConflictGraph graph = conflicts(beacons, 1);
  const auto lattice = lattice_colouring(beacons, graph, 30);
  ASSERT_TRUE(lattice);
  expect_proper(graph, *lattice);
  EXPECT_LE(lattice->count, colour(graph, 1, 1000).count);
  EXPECT_FALSE(lattice_colouring(beacons, graph, 5));
}

TEST(Lattice, knows_where_there_is_none) {
  const std::vector<Lit> twins = {{{0, 0, 8}, 15}, {{0, 0, 9}, 15}, {{10, 0, 8}, 15}};
  EXPECT_FALSE(lattice_colouring(twins, conflicts(twins, 1), 10));
}

}  // namespace
}  // namespace lodestar
