// Scratch of one run: may be thrown away at any step without changing a bit.
#pragma once

#include <vector>

#include "fem/model.hpp"

namespace drapeplan {

/// Of stable_step().
struct StepScratch {
  explicit StepScratch(const Model& model);

  NodalStiffness others, sum;     ///< of all terms but the ply; of all
  std::vector<double> sections;   ///< see Shell::look_at_sections
  std::vector<double> lightness;  ///< of nodes [padded]
};

struct Workspace {
  explicit Workspace(const Model& model);

  std::vector<Forces> entries;  ///< of all terms, in order
  std::vector<size_t> first;    ///< entry of each term
  VectorField mean_v, mean_w;   ///< means of the half-step velocities
  StepScratch step;
  RigScratch rig;
};

/// Forces of all terms at the state's positions.
void compute_forces(const Model& model, State& state, Workspace& work);

/// Velocities of free nodes from the half step before t to the one after it, and their means.
void kick_nodes(const Model& model, State& state, Workspace& work);

/// Velocities of pads and means of their nodes.
void kick_pads(const Model& model, State& state, const RigDrive& drive, Workspace& work);

/// Books the work of all terms and of mass damping with mean velocities.
void book_work(const Model& model, State& state, const Workspace& work);

/// Positions and directors from t to t + dt.
void drift_nodes(const Model& model, State& state);

/// Time and count of steps go on; the step is behind.
void advance_clock(State& state);

/// Kinetic energy of the ply's free nodes; of nodes and pads [J].
double ply_kinetic_energy(const Model& model, const State& state);
double kinetic_energy(const Model& model, const State& state);

}  // namespace drapeplan
