// Meshes of rows and columns, whatever the places of their nodes.
#pragma once

#include <functional>

#include "fem/mesh/mesh.hpp"

namespace drapeplan {

/// nu by nv quadrilaterals over given nodes: node (i, j) is j (nu + 1) + i. The outline starts at node (0,
/// 0).
/// @param rest  (nu + 1) (nv + 1) places [m].
Mesh grid_mesh(int nu, int nv, std::vector<Eigen::Vector2d> rest);

/// The same with node (i, j) at place(i / nu, j / nv).
Mesh grid_mesh(int nu, int nv, const std::function<Eigen::Vector2d(double, double)>& place);

}  // namespace drapeplan
