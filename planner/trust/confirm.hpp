// The winner of a plan, played once more one fidelity above the reporting one.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "planner/drape/problem.hpp"
#include "planner/search/batch_evaluate.hpp"
#include "planner/search/evaluation_log.hpp"
#include "planner/search/stages.hpp"

namespace drapeplan {

/// What is finer in a confirmation: edges of cells are so many times shorter, and the schedule is played at
/// so much less speed, never slower than it is.
inline constexpr double kFinerCells = 1.5, kFinerTime = 2;

/// The best schedule and the better baseline at both settings.
struct Confirmation {
  FemOptions options;  ///< of the finer one
  Score reported, reported_baseline;
  Score finer, finer_baseline;

  /// What a part of the best schedule's score is wrong by, as far as the finer run shows it.
  [[nodiscard]] double error(double Score::*part) const;
  /// By how much the best schedule's objective is below the baseline's, as reported and at the finer setting;
  /// and what the former is wrong by. Both schedules are wrong to the same side, so this is less than what
  /// each is wrong by.
  [[nodiscard]] double gain() const { return reported_baseline.objective - reported.objective; }
  [[nodiscard]] double finer_gain() const { return finer_baseline.objective - finer.objective; }
  [[nodiscard]] double gain_error() const;
  [[nodiscard]] bool ran() const { return finer.valid && finer_baseline.valid; }
  /// The winner, at the finer setting, does what it is told or never did, and is better than the baseline:
  /// that fails, or the finer gain is larger than what the gain is wrong by.
  [[nodiscard]] bool confirmed() const {
    if (!finer.valid || (reported.followed && !finer.followed)) return false;
    return !finer_baseline.valid || finer_gain() > gain_error();
  }
  /// Neither can be played at the finer setting: nothing is known.
  [[nodiscard]] bool undecided() const { return !finer.valid && !finer_baseline.valid; }
};

/// Cells and time finer, or what of it there is time for, cells first; nothing where there is time for
/// neither, or the search has no winner at the reporting fidelity.
/// @throws Interrupted once `stop` says so; what has run is in the log.
std::optional<Confirmation> confirm(const DrapeProblem& problem, const StagedResult& search,
                                    const SideRuns& runs, EvaluationLog& log);
/// What of `runs.seconds` it takes where a run at the reporting fidelity takes `each` [s]; 0 where there is
/// time for nothing that is finer.
double confirm_seconds(const FemOptions& report, double each, const SideRuns& runs);

/// "played again with 6.67 mm cells, ...: largest gap 9.8 mm (reported: 9.95), ...".
std::string confirmation_text(const Confirmation& confirmation);
nlohmann::json confirmation_json(const Confirmation& confirmation);
/// What `confirmation_json` wrote of a plan. @param report  its setting.
/// @param reported, reported_baseline  its scores at that setting.
/// @throws std::exception if it is no confirmation at this setting.
Confirmation confirmation_from(const nlohmann::json& value, const FemOptions& report, const Score& reported,
                               const Score& reported_baseline);

}  // namespace drapeplan
