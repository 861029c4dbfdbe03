// One run of a model: explicit central differences from the flat ply to the end of the schedule.
#pragma once

#include <functional>

#include "fem/model.hpp"
#include "fem/report.hpp"
#include "fem/schedule.hpp"
#include "fem/snapshot.hpp"

namespace drapeplan {

struct RunRequest {
  const Schedule* schedule = nullptr;  ///< needed with a rig: all joints start at the same height
  double duration = 0;                 ///< of the schedule's clock; 0: until the schedule ends [s]
  int frames = 0;  ///< snapshots handed to `observe`, equally spaced in time, the start included
  std::function<void(const Snapshot&)> observe = nullptr;
};

struct RunResult {
  RunReport report;
  Snapshot final;                        ///< the last state, also of a diverged run
  double largest_fibre_strain = 0;       ///< tension at mid-thickness, sampled over the run [-]
  double largest_fibre_compression = 0;  ///< the same in compression, magnitude [-]
  double largest_actuator_force = 0;     ///< [N]
};

/// Runs the model. A run that diverges is a result, never an exception.
/// @throws std::invalid_argument if the schedule does not fit the rig, or neither schedule nor duration is
/// given.
RunResult simulate(const Model& model, const RunRequest& request);

}  // namespace drapeplan
