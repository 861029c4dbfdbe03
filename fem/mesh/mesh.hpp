// The ply as a mesh of quadrilaterals in its flat rest shape.
#pragma once

#include <Eigen/Core>
#include <array>
#include <tuple>
#include <vector>

#include "mapping/polygon.hpp"

namespace drapeplan {

/// Quadrilateral mesh in the ply frame (u along the warp, v along the weft) [m].
struct Mesh {
  std::vector<Eigen::Vector2d> rest;      ///< node positions (u, v) [m]
  std::vector<std::array<int, 4>> quads;  ///< corner nodes, counter-clockwise; a triangle repeats one node
  std::vector<int> outline;  ///< nodes of the ply's edge, counter-clockwise, not repeated at the end

  [[nodiscard]] int node_count() const { return int(rest.size()); }
  [[nodiscard]] int element_count() const { return int(quads.size()); }
};

inline auto fields_of(const Mesh& of) {
  const auto& [rest, quads, outline] = of;
  return std::tie(rest, quads, outline);
}

/// Mesh of a width-by-height rectangle centred at the origin, aligned with the fibres, edges at most
/// `mesh_size`. The outline starts at corner (-,-).
/// @throws WrongInput if a length is not positive.
Mesh rectangle_mesh(double width, double height, double mesh_size);

/// The same with mesh lines through given places (pads must cover the same piece of ply on every mesh): equal
/// cells between them, at most `mesh_size`. A margin outside them narrower than 0.75 of the cell beside
/// it joins that cell, so that no sliver sets the step; such a cell is then up to 0.75 of a cell wider.
/// @param u, v  increasing places inside the ply [m]; empty: equal cells over the whole length.
Mesh rectangle_mesh(double width, double height, double mesh_size, const std::vector<double>& u,
                    const std::vector<double>& v);

/// Mesh of a simple polygon, aligned with the fibres; how: see outline.cpp. Cells are at most
/// `mesh_size` inside, stretched to twice of it at most along the outline; every element is convex, and the
/// stable step is at least 0.3 (typically 0.45 to 0.65) of that of full cells. Every corner that turns by
/// more than 20 degrees is met by a node; flatter ones are a curve that the mesh follows to second order.
/// Lines go through the given places and, where there is room, through corners. The outline starts at the
/// node nearest to the polygon's first corner.
/// @throws WrongInput with the place where the mesh size is too large for the outline, or if the
/// polygon is not simple.
Mesh outline_mesh(const Polygon& outline, double mesh_size, const std::vector<double>& u = {},
                  const std::vector<double>& v = {});

/// Rest area that belongs to each node [m^2]: a quarter of each quadrilateral, a third of each triangle.
std::vector<double> nodal_areas(const Mesh& mesh);

}  // namespace drapeplan
