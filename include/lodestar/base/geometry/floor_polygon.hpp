#pragma once

#include <Eigen/Core>
#include <vector>

namespace lodestar {

/// A polygon on the floor: its corners in order, either way round, the last joined to the first (m).
using FloorPolygon = std::vector<Eigen::Vector2d>;

/// @param size_m along its own x and y
FloorPolygon rectangle(const Eigen::Vector2d& centre_m, double yaw_rad, const Eigen::Vector2d& size_m);

/// Whether it has at least three corners, an area, and no side that crosses or touches another.
bool is_simple(const FloorPolygon& polygon);

/// Whether the point lies in the polygon or on its edge.
bool contains(const FloorPolygon& polygon, const Eigen::Vector2d& point_m);

/// Whether no part of `inner` lies outside of `outer`. Both are simple.
bool contains(const FloorPolygon& outer, const FloorPolygon& inner);

/// The area that both cover (m^2). Both are simple.
double shared_area_m2(const FloorPolygon& a, const FloorPolygon& b);

}  // namespace lodestar
