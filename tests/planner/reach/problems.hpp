// Rigs and their targets that the tests of reach share.
#pragma once

#include "planner/reach/reach.hpp"
#include "tests/mapping/molds.hpp"

namespace drapeplan {

inline RigOptions grid(int columns, int rows, double spacing, double offset) {
  RigOptions rig;
  rig.columns = columns;
  rig.rows = rows;
  rig.spacing = spacing;
  rig.joint_offset = offset;
  return rig;
}

/// Targets straight above the flat places, drawn together by `shrink`: near a draped ply, and never
/// reachable.
inline ReachProblem article_problem(double offset = 0.005, double shrink = 0.96) {
  RigOptions rig = grid(5, 5, 0.1, offset);
  rig.fixed = {3, 3};
  const Eigen::Vector2d middle(0.225, 0.225);
  ReachProblem problem{rig, article_mold(), {}, middle};
  for (int k = 0; k < rig.count(); ++k) {
    const Eigen::Vector2d place = middle + shrink * rig.place(k);
    problem.targets.push_back(problem.mold.point(place.x(), place.y()));
  }
  return problem;
}

}  // namespace drapeplan
