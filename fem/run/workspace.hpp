// Scratch of one run: may be thrown away at any step without changing a bit.
#pragma once

#include <array>
#include <vector>

#include "fem/model/model.hpp"

namespace drapeplan {

/// Of stable_step().
struct StepScratch {
  StepScratch() = default;  ///< of a run that never chooses its step anew
  explicit StepScratch(const Model& model);

  NodalStiffness others{0}, sum{0};  ///< of all terms but the ply; of all
  std::vector<double> sections;      ///< see Shell::look_at_sections
};

inline constexpr size_t kMostEntries = 8;  ///< of forces: a scene has one or two per term

struct Workspace {
  explicit Workspace(const Model& model);

  std::vector<Forces> entries;               ///< of all terms, in order
  std::vector<size_t> first;                 ///< entry of each term
  std::vector<size_t> turning;               ///< entries with moments, but for the shell's
  std::array<double, kMostEntries> power{};  ///< of entries on free nodes [W]
  double damping = 0;                        ///< power that mass damping takes from free nodes [W]
  VectorField mean_v, mean_w;                ///< means of the half-step velocities of guided nodes, if any
  std::vector<size_t> guided;                ///< first nodes of lanes where the mean velocities are not zero
  std::vector<char> has_tied;                ///< by lanes of nodes: some belong to a pad; empty without pads
  /// Of all entries, and of added mass; where has_tied, or everywhere with fibre inertia.
  VectorField force, moment;
  double added_power = 0;  ///< of added mass on free nodes [W]
  FibreInertiaScratch inertia;
  StepScratch step;
  RigScratch rig;
};

/// Forces of all terms at the state's positions.
void compute_forces(const Model& model, State& state, Workspace& work);

/// The last part of compute_forces: their sums, with what fibre inertia makes of them.
void add_inertia(const Model& model, const State& state, Workspace& work);

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
