// Grips: rigid clamps that hold nodes of the ply and move them, as the jaws of a test machine do.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/state.hpp"

namespace drapeplan {

class Model;
struct Workspace;

/// Positions and directors of the nodes are held; the whole clamp translates.
struct Grip {
  std::string name;
  std::vector<int> nodes;
  Eigen::Vector3d velocity{0, 0,
                           0};  ///< reached at the end of the ramp, world frame [m/s] of the schedule's clock
  double ramp = 0.1;            ///< from rest to `velocity`, with continuous acceleration at both ends [s]
};

/// Displacement since the start at time `t` of the schedule's clock [m].
Eigen::Vector3d grip_displacement(const Grip& grip, double t);

/// Gives the nodes of all grips the velocities that take them to their places at the end of the step,
/// and books the work that the grips do on the ply. After the kick of the free nodes (the nodes have no mass
/// there), before book_work.
void move_grips(const Model& model, State& state, Workspace& work);

/// Force that each grip exerts on the ply, the opposite of all terms' forces on its nodes [N].
std::vector<Eigen::Vector3d> grip_forces(const Model& model, const State& state);

}  // namespace drapeplan
