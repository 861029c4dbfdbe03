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
    values.push_back(outcome.score.valid ? outcome.score.objective
                                         : std::numeric_limits<double>::quiet_NaN());
  return values;
}

std::string setting_text(const FemOptions& options) {
  return fmt::format("{:.3g} mm cells, time x {:.3g}, step x {:g}{}", 1e3 * options.mesh_size,
                     options.time_scaling, options.fibre_mass_scaling, options.rates ? ", rates" : "");
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

double objective_difference(const SettingRuns& a, const SettingRuns& b) {
  if (!a.valid() || !b.valid()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (size_t k = 0; k < std::min(a.outcomes.size(), b.outcomes.size()); ++k) {
    const double one = a.outcomes[k].score.objective, other = b.outcomes[k].score.objective;
    if (one != other) largest = std::max(largest, std::abs(one - other) / std::abs(other));
  }
  return largest;
}

SettingRunner::SettingRunner(const Case& definition, EvaluationLog& log, int threads,
                             std::function<bool()> stop, std::function<void(const Progress&)> progress)
    : case_(definition),
      log_(log),
      threads_(threads),
      stop_(std::move(stop)),
      progress_(std::move(progress)) {}

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
  const auto count = double(schedules.size());
  for (size_t k = 0; k < schedules.size(); ++k) {
    const Outcome& outcome = runs.outcomes[k];
    // A case that cannot be built at this setting has no model to ask.
    const double updates =
        outcome.summary.steps > 0
            ? double(problem.model(name).scene().mesh.element_count()) * double(outcome.summary.steps)
            : 0;
    runs.updates += updates / count;
    runs.seconds += outcome.wall_seconds / count;
    elapsed_ = std::max(elapsed_, outcome.elapsed);
    if (counted_.emplace(name, schedule_hash(schedules[k])).second) updates_ += updates;
  }
  double best = std::numeric_limits<double>::infinity();
  for (const Outcome& outcome : runs.outcomes) best = std::min(best, value_of(outcome));
  if (progress_)
    progress_({.stage = "settings",
               .done = this->runs(),
               .best = best,
               .seconds_left = std::numeric_limits<double>::quiet_NaN()});
  return runs;
}

}  // namespace drapeplan
