// Grips in motion: they lead the nodes that they hold.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/run/workspace.hpp"

namespace drapeplan {

/// Displacement since the start at time `t` of the schedule's clock [m].
Eigen::Vector3d grip_displacement(const Grip& grip, double t);

/// Gives the nodes of all grips the velocities that take them to their places at the end of the step,
/// and books the work that the grips do on the ply. After the kick of the free nodes (the nodes have no mass
/// there), before book_work.
void move_grips(const Model& model, State& state, Workspace& work);

/// Force that each grip exerts on the ply, the opposite of all terms' forces on its nodes [N].
std::vector<Eigen::Vector3d> grip_forces(const Model& model, const State& state);

}  // namespace drapeplan
