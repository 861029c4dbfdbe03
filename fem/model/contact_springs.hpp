// How stiff the mold is to each node.
#pragma once

#include <memory>

#include "fem/core/term.hpp"
#include "fem/model/masses.hpp"
#include "fem/model/step_bounds.hpp"
#include "fem/shell/shell.hpp"

namespace drapeplan {

/// The contact of a scene with its mold. Its springs are shares of the ply's stiffness by its slowest curves:
/// rates would make them needlessly stiff. Under pads they are as stiff as the step allows.
/// @param inertial_rate  highest rate of a node with fibre inertia [1/s]; 0 without.
std::unique_ptr<Term> make_scene_contact(const Scene& scene, const Shell& shell, const NodalMasses& masses,
                                         const StepBounds& bounds, double inertial_rate);

/// Least rate of a node with fibre inertia that carries the contact springs which a press needs [1/s]. Added
/// mass is not seen by pads: on springs of a higher rate they would take energy from it.
double rate_for_press(const Scene& scene, const NodalMasses& masses, const StepBounds& bounds);

}  // namespace drapeplan
