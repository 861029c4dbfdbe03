// What a search may still spend, in time or in evaluations, and what its user is told meanwhile.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "planner/case/case.hpp"
#include "planner/search/evaluation_log.hpp"

namespace drapeplan {

struct Progress {
  std::string stage;
  int done = 0;
  int planned = 0;          ///< evaluations, an upper bound; 0: the budget is a time
  double best = 0;          ///< lowest valid objective at the stage's fidelity; infinite if there is none
  double seconds_left = 0;  ///< with the finalists; NaN before anything is known
};

/// Counts evaluations. Time is read from the log's clock through the outcomes, never from the machine's: a
/// search that is served from a log takes the turns that it took when the log was written.
class Budget {
 public:
  Budget(const OptimiseOptions& options, std::function<void(const Progress&)> progress);

  /// Takes note of a batch; reports of baselines and finalists do not count in a budget of evaluations.
  void count(const std::string& stage, const std::string& fidelity, const std::vector<Outcome>& outcomes,
             bool report = false);
  /// Takes time off a budget of time, for what comes after the search [s].
  void keep(double seconds) { options_.budget -= seconds; }
  /// Keeps time for what comes at the end, `runs` reports, so many at a time.
  void reserve(int runs, int at_a_time);
  /// There is time for so many more reports, side by side; always true for a budget of evaluations.
  [[nodiscard]] bool holds(int reports) const;
  /// Share of the budget that is spent, from 0; 1 or more: nothing is left.
  [[nodiscard]] double spent() const;
  /// How many evaluations a share of the whole budget pays for at this fidelity; at least 0.
  [[nodiscard]] int affords(double share, const std::string& fidelity) const;

 private:
  struct Kind {
    int runs = 0;
    double seconds = 0;   ///< of these, each on its own core
    double duration = 0;  ///< sum over their schedules [s]
    double best = 0;
  };
  [[nodiscard]] Progress progress(const std::string& stage, const Kind& kind) const;
  [[nodiscard]] double limit() const;  ///< [s]
  [[nodiscard]] double rate() const;   ///< elapsed time per second of evaluations: one over the cores in use
  [[nodiscard]] double time_of_reports(int count) const;  ///< [s]
  [[nodiscard]] double reports_to_come() const;           ///< [s]

  OptimiseOptions options_;
  std::function<void(const Progress&)> progress_;
  std::map<std::string, Kind> kinds_;  ///< per fidelity
  int searched_ = 0, reported_ = 0, reserved_ = 0, at_a_time_ = 1;
  double longest_ = 0;  ///< of the schedules of the last batch [s]
  double elapsed_ = 0;  ///< on the log's clock [s]
  double begin_ = 0;    ///< of the first evaluation that is counted, on the same clock [s]
};

}  // namespace drapeplan
