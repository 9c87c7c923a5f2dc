#include "lodestar/planning/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace lodestar {

namespace {

/// Between two rows there is more room than this share of the mean spacing.
constexpr double kGap = 0.25;

/// The number of each beacon's row, counted along one axis: a new one begins where `gap_m` holds no beacon.
std::vector<int> rows(const std::vector<Lit>& beacons, int axis, double gap_m) {
  std::vector<std::size_t> order(beacons.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto along = [&](std::size_t i) { return beacons[i].position_map[axis]; };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return along(a) < along(b); });
  std::vector<int> out(beacons.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i)
    out[order[i]] = out[order[i - 1]] + (along(order[i]) - along(order[i - 1]) > gap_m ? 1 : 0);
  return out;
}

double mean_spacing_m(const std::vector<Lit>& beacons) {
  Eigen::Vector2d low = beacons.front().position_map.head<2>(), high = low;
  for (const Lit& beacon : beacons) {
    low = low.cwiseMin(beacon.position_map.head<2>());
    high = high.cwiseMax(beacon.position_map.head<2>());
  }
  const Eigen::Vector2d size = high - low;
  const auto count = static_cast<double>(beacons.size());
  return std::max(std::sqrt(size.x() * size.y() / count), size.maxCoeff() / count);
}

using Difference = std::pair<int, int>;  // in rows, in columns

/// By how much beacons in conflict differ, each difference once; { {0, 0} } as soon as two fall on one place.
std::vector<Difference> conflicting_differences(const ConflictGraph& graph, const std::vector<int>& row,
                                                const std::vector<int>& column) {
  const int rows = *std::max_element(row.begin(), row.end()), columns = *std::max_element(column.begin(), column.end());
  const auto width = static_cast<std::size_t>(2 * columns + 1);
  std::vector<bool> met(static_cast<std::size_t>(rows + 1) * width, false);
  std::vector<Difference> out;
  for (std::size_t i = 0; i < graph.size(); ++i)
    for (const int other : graph[i]) {
      const auto j = static_cast<std::size_t>(other);
      const Difference d{row[i] - row[j], column[i] - column[j]};
      if (d == Difference{0, 0}) return {d};
      if (d.first < 0) continue;  // the other way round it is not
      const std::size_t cell = static_cast<std::size_t>(d.first) * width + static_cast<std::size_t>(d.second + columns);
      if (!met[cell]) out.push_back(d);
      met[cell] = true;
    }
  return out;
}

int wrap(int value, int count) { return (value % count + count) % count; }

}  // namespace

std::optional<Colouring> lattice_colouring(const std::vector<Lit>& beacons, const ConflictGraph& graph, int most) {
  if (beacons.empty()) return std::nullopt;
  const double gap_m = kGap * mean_spacing_m(beacons);
  const std::vector<int> row = rows(beacons, 1, gap_m), column = rows(beacons, 0, gap_m);

  const auto differences = conflicting_differences(graph, row, column);
  if (differences.empty() || differences.front() == Difference{0, 0}) return std::nullopt;

  for (int count = 1; count <= most; ++count)
    for (int b = 0; b < count; ++b) {
      const auto clashes = [&](const Difference& d) { return wrap(d.first + b * d.second, count) == 0; };
      if (std::any_of(differences.begin(), differences.end(), clashes)) continue;
      Colouring out{{}, count};
      for (std::size_t i = 0; i < beacons.size(); ++i) out.colours.push_back(wrap(row[i] + b * column[i], count));
      return out;
    }
  return std::nullopt;
}

}  // namespace lodestar
