// One run of a model: explicit central differences from the flat ply to the end of the schedule.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "fem/core/run_summary.hpp"
#include "fem/core/snapshot.hpp"
#include "fem/model/model.hpp"
#include "fem/rig/schedule.hpp"

namespace drapeplan {

struct RunRequest {
  const Schedule* schedule = nullptr;  ///< needed with a rig: all joints start at the same height
  /// Of the schedule's clock; 0: until the schedule ends [s]. A press comes after it.
  double duration = 0;
  bool press = true;                   ///< false: the run ends where pressing would begin
  const State* from = nullptr;         ///< goes on from here instead of the flat start
  /// Stops at the first step at or after it, to be continued; 0: never [s, schedule's clock].
  double pause = 0;
  std::int64_t steps = 0;  ///< stops after so many of its own, to be continued; 0: no limit
  int frames = 0;          ///< snapshots handed to `observe`, equally spaced in time, the start included
  std::function<void(const Snapshot&)> observe = nullptr;
  int samples = 0;  ///< the same for `sample`, at instants of its own: a history needs more of them
  std::function<void(const Snapshot&)> sample = nullptr;
};

struct RunResult {
  RunSummary summary;
  Snapshot final;  ///< the last state, also of a diverged run, to look at
  State state;     ///< the same, to go on from; its `record` has the extremes of the run
  /// Where the scene has a press: the ply when pressing began, without pads; `state.unpressed_record` has the
  /// extremes until then. Absent if the run ended before.
  std::optional<Snapshot> unpressed;
};

/// Height at which the flat ply of a run starts [m]: the scene's, or the one at which a rig's joints stand.
/// @param schedule  that the rig plays; null without a rig.
/// @throws WrongInput if there is a rig and no schedule, or one that does not fit the rig.
double start_height(const Model& model, const Schedule* schedule);

/// Runs the model. A run that diverges is a result, never an exception.
/// A run that pauses and goes on from its state has the same bits as one that never did.
/// @throws WrongInput if the schedule does not fit the rig, or neither schedule nor duration is
/// given.
RunResult simulate(const Model& model, const RunRequest& request);

}  // namespace drapeplan
