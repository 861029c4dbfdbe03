// Where the edge of a drape is farthest from its boundary, and whether the grippers or the ply put it there.
#pragma once

#include <Eigen/Core>
#include <string>

#include "planner/drape/problem.hpp"

namespace drapeplan {

struct EdgeMiss {
  Eigen::Vector2d at{0, 0};  ///< of the ply's edge in the flat ply (u, v) [m]
  double offset = 0;         ///< distance from the boundary [m]
  bool short_of = false;     ///< the edge lies inside the boundary; false: beyond it
  int gripper = 0;           ///< the nearest
  double margin = 0;         ///< how far that one is from `at`, in the flat ply [m]
  double pad_offset = 0;     ///< how far its pad is from where the mapping wants it, along the offset [m]

  /// The nearest gripper is off by more than half as much, to the same side: it is the rig that misplaces the
  /// edge, else the ply between gripper and edge.
  [[nodiscard]] bool by_gripper() const { return pad_offset > 0.5 * offset; }
};

/// @param drape  of this problem at this fidelity; it ran to its end.
EdgeMiss edge_miss_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity);

}  // namespace drapeplan
