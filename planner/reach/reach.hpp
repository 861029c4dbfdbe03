// How close the rig can come to its targets at all, whatever the schedule.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/rig/rig.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// Pads lie on the mold; joints stand `ply_thickness + joint_offset` above it along its normal at the pad's
/// centre; interlinks keep their length between joints; the fixed joint keeps its place; no pad tilts beyond
/// its limit. Only the rig's geometry is asked: fabric forces, friction and actuator limits can make the
/// outcome worse only.
struct ReachProblem {
  RigOptions rig;
  Mold mold;
  std::vector<Eigen::Vector3d>
      targets;                        ///< mapped places of the pad centres on the mold [m], one per gripper
  Eigen::Vector2d fixed_place{0, 0};  ///< x-y of the fixed joint, used where rig.fixed is set [m]
  double ply_thickness = 0;           ///< between mold and pad [m]
};

/// The floor again with one part of the rig changed: it shows what causes the floor.
struct ReachCauses {
  double rms_flush = 0;     ///< floor_rms with all joints on the mold's surface (offset and thickness 0) [m]
  double rms_unfixed = 0;   ///< floor_rms if no joint were fixed in-plane [m]
  double rms_rescaled = 0;  ///< floor_rms if all interlinks had the best common length [m]
  double link_scale = 1;    ///< that length over the spacing
  double shortest_link = 0,
         longest_link = 0;  ///< of the interlinks that would put every pad on its target [m]
};

/// Floors (and causes) are NaN where no solution was found; positions then are those that break the rig's
/// constraints least.
struct ReachResult {
  bool converged = false;
  std::string status;                      ///< why the solver ended, in words
  std::vector<Eigen::Vector3d> positions;  ///< reachable pad centres on the mold, rms-optimal [m]
  std::vector<Eigen::Vector3d> joints;     ///< their joints [m]
  std::vector<double> per_gripper;         ///< distance of each reachable place to its target [m]
  double floor_rms = 0;                    ///< smallest possible r.m.s. distance [m]
  double floor_max = 0;                    ///< smallest possible largest distance (a solve of its own) [m]
  double link_violation = 0;               ///< largest error of an interlink's length, beyond its stops [m]
  double start_spread = 0;                 ///< largest difference of floor_rms between the starts [m]
  double start_spread_max = 0;             ///< the same of floor_max [m]
  ReachCauses causes;
  double wall_seconds = 0;
};

/// Solves the reach problem with Ipopt and exact derivatives, from the targets and `random_starts` perturbed
/// starts; the best of them counts. Never throws for a geometry that cannot be satisfied: `converged` is
/// false then. Calls from several threads are served one after the other (see ipopt_mutex).
ReachResult solve_reach(const ReachProblem& problem, int random_starts = 2, unsigned seed = 1);

/// What the floor means, for a process engineer, in a few sentences.
std::string explain_reach(const ReachProblem& problem, const ReachResult& result);

}  // namespace drapeplan
