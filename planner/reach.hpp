// How close the rig can come to its targets at all, whatever the schedule.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/rig.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// Pads lie on the mold (their underside is the ply's upper face), joints stand `joint_offset` above the ply along
/// the pad's normal, interlinks keep their length between joints, the fixed joint keeps its place.
struct ReachProblem {
  RigOptions rig;
  Mold mold;
  std::vector<Eigen::Vector3d> targets;  ///< mapped places of the pad centres on the mold [m], one per gripper
  Eigen::Vector2d fixed_place{0, 0};     ///< x-y of the fixed joint, used where rig.fixed is set [m]
};

struct ReachResult {
  bool converged = false;
  std::string status;                      ///< why the solver ended, in words
  std::vector<Eigen::Vector3d> positions;  ///< reachable pad centres on the mold, rms-optimal [m]
  std::vector<Eigen::Vector3d> joints;     ///< their joints [m]
  std::vector<double> per_gripper;         ///< distance of each reachable place to its target [m]
  double floor_rms = 0;                    ///< smallest possible r.m.s. distance [m]
  double floor_max = 0;                    ///< smallest possible largest distance (a solve of its own) [m]
  double link_violation = 0;               ///< largest |length - spacing| over both solutions [m]
  double start_spread = 0;                 ///< largest difference of floor_rms between the starts [m]
  double wall_seconds = 0;
};

/// Solves the reach problem with Ipopt and exact derivatives, from the targets and `random_starts` perturbed starts;
/// the best of them counts. Serialised by a mutex: Debian's Ipopt with MUMPS is not thread-safe.
ReachResult solve_reach(const ReachProblem& problem, int random_starts = 2, unsigned seed = 1);

/// What the floor means, for a process engineer, in one or two sentences.
std::string explain_reach(const ReachProblem& problem, const ReachResult& result);

}  // namespace drapeplan
