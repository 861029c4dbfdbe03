// How large a step may be: the bound that a run plays, and the true limit to judge it by.
#pragma once

#include "fem/run/workspace.hpp"

namespace drapeplan {

/// Stable step at a state [s]: summed bounds of all terms, with the slopes that their laws have at and near
/// the state. The bound of an element is spread over its corners; every call takes from nodes that govern and
/// gives to those with slack (state.lightness), at step 0 in several rounds. At least Model::stable_dt().
double stable_step(const Model& model, State& state, StepScratch& scratch);

/// True stable step of the linearised system at a state [s]: 2 / largest frequency by Arnoldi's method, with
/// the stiffness by central differences of all forces. Pads and clamped nodes are held, those that pads have
/// let go are free. Costs about a hundred evaluations of all forces: for tests and studies. From above: the
/// largest frequency is approached from below, to 0.1 % or better.
double true_stable_step(const Model& model, const State& state);

}  // namespace drapeplan
