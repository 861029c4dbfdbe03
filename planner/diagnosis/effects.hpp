// Which strokes of a schedule matter: what the objective is where one of them is a little different.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/drape/problem.hpp"
#include "planner/search/batch_evaluate.hpp"
#include "planner/search/evaluation_log.hpp"

namespace drapeplan {

/// Steps of one height and one start: what a rig may be off by, and more than a drape's noise.
inline constexpr double kHeightStep = 0.005;  // [m]
inline constexpr double kStartStep = 0.5;     // [s]
/// Share of a budget of time that these runs may take.
inline constexpr double kEffectsShare = 0.05;

/// One value of one gripper's stroke.
struct StrokeEffect {
  int gripper = 0;
  bool height = false;  ///< of the preshape, above the target; false: the start of the stroke
  double value = 0;     ///< in the schedule [m] or [s]
  /// Changes of the objective, one step up and one step down; NaN where that fails or the rig refuses it.
  double more = 0, less = 0;

  /// The larger change of both: what it costs, or brings, to change this value alone.
  [[nodiscard]] double size() const;
};

struct StrokeEffects {
  std::string fidelity;
  std::vector<StrokeEffect>
      values;  ///< of largest effect first: all heights, and all starts where there was time
};

/// Runs the schedule with each height, then with each start, one step up and down, through the log: two runs
/// per value. Nothing where the time is not enough for all heights, or the schedule itself fails at this
/// fidelity.
/// @throws Interrupted once `stop` says so; what has run is in the log.
std::optional<StrokeEffects> stroke_effects(const DrapeProblem& problem, const Strokes& strokes,
                                            const std::string& fidelity, const SideRuns& runs,
                                            EvaluationLog& log);

}  // namespace drapeplan
