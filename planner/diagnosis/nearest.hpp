// The node and the gripper that are nearest to a place of the flat ply.
#pragma once

#include <Eigen/Core>

#include "fem/mesh/mesh.hpp"
#include "fem/rig/rig.hpp"

namespace drapeplan {

/// @param at  (u, v) [m].
inline int nearest_node(const Mesh& mesh, const Eigen::Vector2d& at) {
  int nearest = 0;
  for (int n = 1; n < mesh.node_count(); ++n) {
    if ((mesh.rest[size_t(n)] - at).squaredNorm() < (mesh.rest[size_t(nearest)] - at).squaredNorm())
      nearest = n;
  }
  return nearest;
}

/// @param at  (u, v) [m].
inline int nearest_gripper(const RigOptions& rig, const Eigen::Vector2d& at) {
  int nearest = 0;
  for (int g = 1; g < rig.count(); ++g) {
    if ((rig.place(g) - at).squaredNorm() < (rig.place(nearest) - at).squaredNorm()) nearest = g;
  }
  return nearest;
}

}  // namespace drapeplan
