#include "planner/diagnosis/effects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/error.hpp"
#include "planner/base/parallel.hpp"
#include "planner/schedule/check.hpp"
#include "planner/search/batch_evaluate.hpp"

namespace drapeplan {

double StrokeEffect::size() const {
  return std::fmax(std::abs(more), std::abs(less));  // of NaN and a number the number
}

std::optional<StrokeEffects> stroke_effects(const DrapeProblem& problem, const Strokes& strokes,
                                            const std::string& fidelity, const SideRuns& runs,
                                            EvaluationLog& log) {
  const auto run = make_batch_evaluate(
      [&](const Schedule& schedule, const std::string& at) {
        require_playable(schedule, *problem.definition().grippers);
        return outcome_of(problem.run_for_objective(schedule, at));
      },
      log, runs);
  const auto evaluate = [&](const std::vector<Strokes>& list) {
    std::vector<Schedule> schedules;
    for (const Strokes& one : list) schedules.push_back(to_schedule(problem.frame(), one));
    return run(schedules, fidelity, "effects");
  };
  const Outcome here = evaluate({strokes}).front();
  if (!here.score.valid) return std::nullopt;
  const double all =
      2 * double(strokes.size()) * here.wall_seconds / thread_count(runs.threads);  // of one kind
  StrokeEffects effects{fidelity, {}};
  int kinds = 0;
  for (const auto& [value, step] : {std::pair{&Stroke::height, kHeightStep}, {&Stroke::start, kStartStep}}) {
    if (runs.seconds > 0 && ++kinds * all > runs.seconds) break;
    std::vector<Strokes> list;
    for (size_t g = 0; g < strokes.size(); ++g) {
      for (const double sign : {1.0, -1.0}) {
        list.push_back(strokes);
        list.back()[g].*value += sign * step;
        shift_to_gauge(list.back());
      }
    }
    const std::vector<Outcome> outcomes = evaluate(list);
    const auto change = [&](size_t k) {
      return outcomes[k].score.valid ? outcomes[k].score.objective - here.score.objective
                                     : std::numeric_limits<double>::quiet_NaN();
    };
    for (size_t g = 0; g < strokes.size(); ++g)
      effects.values.push_back({.gripper = int(g),
                                .height = value == &Stroke::height,
                                .value = strokes[g].*value,
                                .more = change(2 * g),
                                .less = change(2 * g + 1)});
  }
  if (effects.values.empty()) return std::nullopt;
  // Where both changes fail nothing is known: these come last.
  const auto key = [](const StrokeEffect& effect) { return std::isnan(effect.size()) ? -1 : effect.size(); };
  std::stable_sort(effects.values.begin(), effects.values.end(),
                   [&](const StrokeEffect& a, const StrokeEffect& b) { return key(a) > key(b); });
  return effects;
}

}  // namespace drapeplan
