// Where the edge of a drape is farthest from its boundary, and whether the grippers or the ply put it there.
#pragma once

#include <Eigen/Core>
#include <string>

#include "planner/drape/problem.hpp"

namespace drapeplan {

enum class EdgeSide { short_of, beyond, above };  ///< of the boundary, or over it

struct EdgeMiss {
  Eigen::Vector2d at{0, 0};  ///< of the ply's edge in the flat ply (u, v) [m]
  double offset = 0;         ///< distance from the boundary [m]
  EdgeSide side = EdgeSide::short_of;
  int gripper = 0;        ///< the nearest
  double margin = 0;      ///< how far that one is from `at`, in the flat ply [m]
  double pad_offset = 0;  ///< how far its pad is from where the mapping wants it, along the offset [m]

  /// Share of the offset from which on the nearest gripper has to do with it.
  static constexpr double kShare = 0.5;
  /// The nearest gripper is off to the same side: it is the rig that misplaces the edge.
  [[nodiscard]] bool by_gripper() const { return pad_offset > kShare * offset; }
  /// It is off to the other side.
  [[nodiscard]] bool against_gripper() const { return pad_offset < -kShare * offset; }
};

/// @param drape  of this problem at this fidelity; it ran to its end.
EdgeMiss edge_miss_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity);

}  // namespace drapeplan
