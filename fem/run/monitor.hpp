// Watches a run: books, finiteness, strains; turns what it saw into the summary.
#pragma once

#include <string>
#include <vector>

#include "fem/core/run_summary.hpp"
#include "fem/run/simulate.hpp"
#include "fem/run/workspace.hpp"

namespace drapeplan {

class Monitor {
 public:
  /// @param drive  what the rig plays; without a rig it is not asked.
  explicit Monitor(const Model& model, const RigDrive& drive = {});

  /// Looks at a state and notes the worst in its record. Returns false, with the reason in the summary, if
  /// the run cannot go on.
  bool look(State& state, RunSummary& summary);

  /// Kinetic and hourglass energy against internal energy, into the state's record.
  void compare_energies(State& state) const;

  /// What only the end tells, and the record.
  void close(State& state, RunSummary& summary) const;

 private:
  // What is wrong with a state, in words; empty if nothing is.
  std::string fault_of_books(State& state);
  [[nodiscard]] std::string fault_of_nodes(const State& state) const;
  std::string fault_of_strains(State& state);
  std::string fault_on_mold(State& state);

  void note_penetration(State& state);
  void note_rig(State& state) const;
  bool holds_more(const State& state, double limit);

  const Model& model_;
  RigDrive drive_;
  std::vector<std::vector<int>> tied_;  ///< nodes of each pad
  std::vector<double> above_;           ///< of each node's underside over the mold at the last look [m]
  double overhang_ = 0;                 ///< of the flat start over the mold's edge [m]
  double area_ = 0;                     ///< of the ply [m^2]
  double slid_ = 0;                     ///< of nodes that touch at the last look, over it [m]
  State half_;                          ///< half a step before what is looked at; kept like strains_
  Snapshot strains_;                    ///< kept, so that looking allocates nothing after the first time
};

/// Energies of a state, without the figures that need a history.
Energies energies(const Model& model, const State& state);

Snapshot take_snapshot(const Model& model, const State& state, const RigDrive& drive);

}  // namespace drapeplan
