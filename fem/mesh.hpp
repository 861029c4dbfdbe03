// The ply as a mesh of quadrilaterals in its flat rest shape.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace drapeplan {

/// Quadrilateral mesh in the ply frame (u along the warp, v along the weft) [m].
struct Mesh {
  std::vector<Eigen::Vector2d> rest;      ///< node positions (u, v) [m]
  std::vector<std::array<int, 4>> quads;  ///< corner nodes, counter-clockwise
  std::vector<int> outline;               ///< nodes of the ply's edge, counter-clockwise, not repeated at the end

  [[nodiscard]] int node_count() const { return int(rest.size()); }
  [[nodiscard]] int element_count() const { return int(quads.size()); }
};

/// Mesh of a width-by-height rectangle centred at the origin, aligned with the fibres, edges at most `mesh_size`.
/// The outline starts at corner (-,-).
/// @throws std::invalid_argument if a length is not positive.
Mesh rectangle_mesh(double width, double height, double mesh_size);

/// Rest area that belongs to each node [m^2]: a quarter of each element around it.
std::vector<double> nodal_areas(const Mesh& mesh);

}  // namespace drapeplan
