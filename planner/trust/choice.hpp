// The numerical settings that a plan searches and reports at, where its case names none: chosen from what a
// few runs of the case itself show.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planner/search/budget.hpp"
#include "planner/trust/setting_runs.hpp"

namespace drapeplan {

/// Errors that are wanted of `report` and `search`, relative, of the largest gap and boundary offset. Two
/// meshes that are both fine differ by up to 4 % in the gap: folds beside pads jump from cell to cell
/// (tests/bench/study.md).
inline constexpr double kReportError = 0.05, kSearchError = 0.10;
/// Rank correlation with a careful setting that is wanted of `screen`, over kRanked schedules.
inline constexpr double kScreenRanks = 0.9;
inline constexpr int kRanked = 8;
/// Shares of a budget of time: for the choice, and at most for all runs at `report`.
inline constexpr double kChoiceShare = 0.1, kReportsShare = 0.4;

/// One knob of the numerics at one value, the others as in the base; against the most careful value that was
/// run.
struct Level {
  double FemOptions::*knob = nullptr;  ///< null: rates
  FemOptions options;
  double error = 0;  ///< relative, of gap and edge; of the most careful one what the one before it differs by
  double objective_error = 0;  ///< the same of the objective
  double updates = 0;          ///< element updates of a run
  double seconds = 0;          ///< of a run on one core [s]
  bool careful = false;        ///< the most careful one
};

struct ChosenFidelity {
  std::string name;
  FemOptions options;
  double error = 0, objective_error = 0;                    ///< estimated, relative: sums over the knobs
  double ranks = std::numeric_limits<double>::quiet_NaN();  ///< Spearman, where it was measured
  double seconds = 0;                                       ///< of a run on one core, estimated [s]
};

struct FidelityChoice {
  std::vector<Level> levels;           ///< by knob, each from the cheapest to the most careful
  std::vector<ChosenFidelity> chosen;  ///< cheapest first; `report` is the last
  std::string ranked_against;          ///< setting; empty: nothing was ranked
  int runs = 0;
  double seconds = 0;   ///< that the choice took on the log's clock [s]
  std::string message;  ///< what is missed of what is wanted, and why; empty: nothing
  [[nodiscard]] std::map<std::string, FemOptions> fidelities() const;
};

/// Plays the baselines at a coarse setting and with each knob (time scaling, fibre mass, cells, rates) turned
/// alone, from cheap to careful, as far as the share of a budget of time goes. What a combination is wrong by
/// is taken as the sum of what its knobs are. `report` is the cheapest combination within its wanted error
/// that the budget pays for, `search` likewise, and `screen` a cheaper one that ranks kRanked schedules as a
/// careful setting does; where none does, there is no `screen`. All runs go through the log: a plan that is
/// resumed chooses the same again, at no cost. With a budget of evaluations the choice depends on the case
/// alone; these runs do not count.
/// @param definition  of a case that `chooses_fidelities`; its fidelities are where it begins.
/// @throws Interrupted, and NotFinished if the baselines fail at every setting.
FidelityChoice choose_fidelities(const Case& definition, EvaluationLog& log, int threads = 0,
                                 const std::function<bool()>& stop = {},
                                 const std::function<void(const Progress&)>& progress = {});

/// A table of the settings, what they are wrong by and what they cost, for people.
std::string choice_table(const FidelityChoice& choice, const OptimiseOptions& optimise, int threads);
nlohmann::json choice_json(const FidelityChoice& choice);
/// What `choice_json` wrote, without the levels. @param fidelities  the chosen ones, of the resolved case.
/// @throws std::exception if it is no choice of these.
FidelityChoice choice_from(const nlohmann::json& value, const std::map<std::string, FemOptions>& fidelities);

}  // namespace drapeplan
