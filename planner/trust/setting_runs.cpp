#include "planner/trust/setting_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/search/batch_evaluate.hpp"

namespace drapeplan {

bool SettingRuns::valid() const {
  return std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return o.score.valid; });
}

std::vector<double> SettingRuns::objectives() const {
  std::vector<double> values;
  for (const Outcome& outcome : outcomes)
    values.push_back(outcome.score.valid ? outcome.score.objective : std::numeric_limits<double>::quiet_NaN());
  return values;
}

std::string setting_text(const FemOptions& options) {
  return fmt::format("{:.3g} mm cells, time x {:.3g}, step x {:g}{}", 1e3 * options.mesh_size, options.time_scaling,
                     options.fibre_mass_scaling, options.rates ? ", rates" : "");
}

double difference(const SettingRuns& a, const SettingRuns& b, const ScoreOptions& score) {
  if (!a.valid() || !b.valid()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (size_t k = 0; k < std::min(a.outcomes.size(), b.outcomes.size()); ++k) {
    const auto look = [&](double Score::*part, double target) {
      const double one = a.outcomes[k].score.*part, other = b.outcomes[k].score.*part;
      largest = std::max(largest, std::abs(one - other) / std::max(std::abs(other), target));
    };
    look(&Score::max_gap, score.target_gap);
    look(&Score::max_boundary_offset, score.target_boundary_offset);
  }
  return largest;
}

SettingRunner::SettingRunner(const Case& definition, EvaluationLog& log, int threads, std::function<bool()> stop,
               std::function<void(const Progress&)> progress)
    : case_(definition), log_(log), threads_(threads), stop_(std::move(stop)), progress_(std::move(progress)) {}

SettingRuns SettingRunner::run(const FemOptions& options, const std::vector<Schedule>& schedules) {
  const std::string name = setting_text(options);
  Case changed = case_;
  changed.fidelities = {{name, options}, {kReport, options}};
  const DrapeProblem problem(std::move(changed));
  const Evaluate evaluate = [&](const Schedule& schedule, const std::string& fidelity) {
    return outcome_of(problem.run_for_objective(schedule, fidelity));
  };
  SettingRuns runs{.options = options, .outcomes = {}};
  runs.outcomes = make_batch_evaluate(evaluate, log_, threads_, 0, stop_)(schedules, name, "settings");
  const auto elements = double(problem.model(name).scene().mesh.element_count());
  for (const Outcome& outcome : runs.outcomes) {
    runs.updates += elements * double(outcome.summary.steps) / double(schedules.size());
    runs.seconds += outcome.wall_seconds / double(schedules.size());
    elapsed_ = std::max(elapsed_, outcome.elapsed);
  }
  runs_ += int(schedules.size());
  updates_ += runs.updates * double(schedules.size());
  double best = std::numeric_limits<double>::infinity();
  for (const Outcome& outcome : runs.outcomes) best = std::min(best, value_of(outcome));
  if (progress_)
    progress_({.stage = "settings",
               .done = runs_,
               .best = best,
               .seconds_left = std::numeric_limits<double>::quiet_NaN()});
  return runs;
}

}  // namespace drapeplan
