// Watches a run: books, finiteness, strains; turns what it saw into the report.
#pragma once

#include "fem/report.hpp"
#include "fem/simulate.hpp"
#include "fem/workspace.hpp"

namespace drapeplan {

class Monitor {
 public:
  explicit Monitor(const Model& model) : model_(model) {}

  /// Looks at a state. Returns false, with the reason in the result, if the run cannot go on.
  bool look(const State& state, RunResult& result);

  /// Kinetic over internal energy of the state counts for the report from now on.
  void note_kinetic_ratio(const State& state, RunResult& result) const;

  /// Stored hourglass energy and contact state of the end.
  void close(const State& state, RunResult& result) const;

 private:
  static bool fail(const State& state, const std::string& what, RunResult& result);

  const Model& model_;
  double largest_balance_ = 0;
};

/// Energies of a state, without the figures that need a history.
Energies energies(const Model& model, const State& state);

Snapshot take_snapshot(const Model& model, const State& state, const RigDrive& drive);

}  // namespace drapeplan
