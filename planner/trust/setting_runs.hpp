// Runs of a few schedules at one numerical setting, and by how much settings differ.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "planner/drape/problem.hpp"
#include "planner/search/budget.hpp"
#include "planner/search/evaluation_log.hpp"

namespace drapeplan {

/// What the schedules gave at a setting.
struct SettingRuns {
  FemOptions options;
  std::vector<Outcome> outcomes;  ///< in the order of the schedules
  double updates = 0;             ///< element updates of a run, mean
  double seconds = 0;             ///< wall time of a run on one core, mean [s]

  /// All runs came to their end.
  [[nodiscard]] bool valid() const;
  /// Objectives of the runs; NaN where one failed.
  [[nodiscard]] std::vector<double> objectives() const;
};

/// "20.2 mm cells, time x 8, step x 6": what a setting changes of the defaults; names it in the log.
std::string setting_text(const FemOptions& options);

/// Largest relative difference of the runs at two settings in the leading parts of the score, over their
/// common schedules. Lengths below the case's targets count as these: a tenth of a gap that nobody sees is no
/// error of 10 %. Infinite if a run failed.
double difference(const SettingRuns& a, const SettingRuns& b, const ScoreOptions& score);

/// The same of the objective, relative to the second one's.
double objective_difference(const SettingRuns& a, const SettingRuns& b);

/// Runs a case at settings through the log of its plan: known ones are served from there.
class SettingRunner {
 public:
  /// @param definition  with grippers, mold and mapping.  @param log  outlives it.
  /// @param stop  asked before each run; may be empty.
  SettingRunner(const Case& definition, EvaluationLog& log, int threads, std::function<bool()> stop,
                std::function<void(const Progress&)> progress);

  /// @throws Interrupted once `stop` says so.
  SettingRuns run(const FemOptions& options, const std::vector<Schedule>& schedules);

  /// The log's clock at the last of its runs [s].
  [[nodiscard]] double elapsed() const { return elapsed_; }
  [[nodiscard]] int runs() const { return int(counted_.size()); }
  /// Of elements, in all of its runs.
  [[nodiscard]] double updates() const { return updates_; }

 private:
  const Case& case_;
  EvaluationLog& log_;
  int threads_;
  std::function<bool()> stop_;
  std::function<void(const Progress&)> progress_;
  double elapsed_ = 0, updates_ = 0;
  std::set<std::pair<std::string, std::uint64_t>> counted_;  ///< setting and schedule of each run
};

}  // namespace drapeplan
