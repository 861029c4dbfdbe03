// Points of a mesh between its nodes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "fem/mesh/mesh.hpp"

namespace drapeplan {

/// A point of a cell: the weights of its corners, in the cell's own order; they sum up to 1.
struct Foot {
  size_t element = 0;
  std::array<double, 4> weight{};
};

/// The cells that cover a point of a plane, in the order of the mesh: one, two on a common edge, more where
/// the mesh is folded in this plane, none beside it. Newton's method for the bilinear coordinates of each.
/// @param place  of every node in the plane [m]: the flat ply itself, or the draped ply from above.
std::vector<Foot> feet_of(const Mesh& mesh, const std::vector<Eigen::Vector2d>& place,
                          const Eigen::Vector2d& at);

/// Point (u, v) of the flat ply [m]; nothing off the mesh.
std::optional<Foot> foot_of(const Mesh& mesh, const Eigen::Vector2d& at);

/// The same for a point that is known to lie on the ply: beside the mesh, by as much as it cuts off a curved
/// edge, its nearest node.
Foot nearest_foot(const Mesh& mesh, const Eigen::Vector2d& at);

/// Where the point is when the nodes are at `position` [m].
Eigen::Vector3d place_of(const Mesh& mesh, const Foot& foot, const std::vector<Eigen::Vector3d>& position);

}  // namespace drapeplan
