// Simple polygons in the plane: outlines of plies.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

namespace drapeplan {

/// Corners in order, the first one not repeated at the end [m].
using Polygon = std::vector<Eigen::Vector2d>;

/// Area, > 0 if the corners run counter-clockwise [m^2].
double signed_area(const Polygon& polygon);

/// The same polygon with its corners counter-clockwise, from the same first corner.
Polygon counter_clockwise(Polygon polygon);

/// Smallest convex polygon around the points, counter-clockwise; points on its edges are left out. Of less
/// than two different points: nothing.
Polygon convex_hull(std::vector<Eigen::Vector2d> points);

/// Smallest upright rectangle around the corners.
Eigen::AlignedBox2d bounding_box(const Polygon& polygon);

/// Point of the polygon's edges that is nearest to `point`.
Eigen::Vector2d nearest_on_edges(const Polygon& polygon, const Eigen::Vector2d& point);

/// Whether the point lies inside or at most `slack` [m] outside.
bool contains(const Polygon& polygon, const Eigen::Vector2d& point, double slack = 0);

/// Two edges (by their first corner) that meet beyond their common corner, or the same one twice if it has no
/// length; nothing for a simple polygon.
std::optional<std::array<size_t, 2>> crossing_edges(const Polygon& polygon);

}  // namespace drapeplan
