#include "planner/search/finalists.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/drape/problem.hpp"

namespace drapeplan {
namespace {

/// Finalists but the first lag by at most this share of what the first one lags by.
constexpr double kLessLag = 0.75;

bool outcome_ranks_before(const Outcome& a, const Outcome& b) {
  return ranks_before(Standing{value_of(a), a.score.followed}, Standing{value_of(b), b.score.followed});
}

}  // namespace

bool ranks_before(const Standing& a, const Standing& b) {
  if (std::isfinite(a.objective) != std::isfinite(b.objective)) return std::isfinite(a.objective);
  return a.followed != b.followed ? a.followed : a.objective < b.objective;
}

std::vector<Trial> pick_finalists(const SequenceFrame& frame,
                                  const std::vector<const std::vector<Trial>*>& lists,
                                  std::vector<Schedule> known, int count) {
  std::vector<Trial> finalists;
  const auto add_if_new = [&](const Trial& trial) {
    Schedule schedule = to_schedule(frame, trial.strokes);
    const bool seen = std::any_of(known.begin(), known.end(), [&](const Schedule& other) {
      return nearly_equal(other, schedule);
    });
    if (seen) return;
    finalists.push_back(trial);
    known.push_back(std::move(schedule));
  };
  for (const std::vector<Trial>* list : lists) {
    std::vector<const Trial*> sorted;
    for (const Trial& trial : *list) sorted.push_back(&trial);
    std::stable_sort(sorted.begin(), sorted.end(), [](const Trial* a, const Trial* b) {
      return ranks_before(a->standing, b->standing);
    });
    const auto add_all = [&](double lag) {
      for (const Trial* trial : sorted) {
        if (int(finalists.size()) >= count || !trial->ran()) break;
        if (finalists.empty() || trial->lag <= lag) add_if_new(*trial);
      }
    };
    add_all(sorted.empty() ? 0 : kLessLag * sorted.front()->lag);
    add_all(std::numeric_limits<double>::infinity());
  }
  return finalists;
}

const Candidate& better_baseline(const StagedResult& result) {
  return outcome_ranks_before(result.wave.outcome, result.uniform.outcome) ? result.wave : result.uniform;
}

void conclude(StagedResult& result) {
  std::stable_sort(result.finalists.begin(), result.finalists.end(),
                   [](const Candidate& a, const Candidate& b) { return outcome_ranks_before(a.outcome, b.outcome); });
  declare_best(result, result.finalists.front());
}

void declare_best(StagedResult& result, const Candidate& winner) {
  result.best = winner;
  result.best_fidelity = kReport;
  const Outcome& to_beat = better_baseline(result).outcome;
  const double baseline = value_of(to_beat), best = value_of(result.best.outcome);
  result.beats_baselines = outcome_ranks_before(result.best.outcome, to_beat);
  const std::string& name = result.best.name;
  if (!std::isfinite(best)) {
    result.message = fmt::format("no schedule could be evaluated at fidelity \"{}\"", kReport);
  } else if (!std::isfinite(baseline)) {
    result.message =
        fmt::format("both baselines failed; the best schedule, {}, has an objective of {:.6g}", name, best);
  } else if (result.beats_baselines && best >= baseline) {
    result.message = fmt::format(
        "the optimised sequence (candidate \"{}\") has an objective of {:.4g}; the rig does not follow the "
        "baselines, of which the better one has {:.4g}",
        name, best, baseline);
  } else if (result.beats_baselines) {
    result.message = fmt::format(
        "the optimised sequence (candidate \"{}\") has an objective of {:.4g}, {:.1f} % below the better "
        "baseline's {:.4g}",
        name, best, 100 * (baseline - best) / std::abs(baseline), baseline);
  } else {
    result.message = fmt::format(
        "nothing found beats the baselines at the reporting fidelity: {} stays the best, objective {:.6g}",
        name, best);
  }
  if (std::isfinite(best) && !result.best.outcome.score.followed)
    result.message += "; no schedule was followed by the rig within the tolerance of lag";
}

std::vector<const Candidate*> unbeaten(const std::vector<Candidate>& candidates) {
  const auto good = [](const Candidate& c) { return c.outcome.score.valid && c.outcome.score.followed; };
  const auto figures = [](const Candidate& c) {
    const Score& s = c.outcome.score;
    return std::array{s.max_gap, s.max_boundary_offset, s.duration};
  };
  std::vector<const Candidate*> front;
  for (const Candidate& one : candidates) {
    const bool beaten = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& other) {
      const auto a = figures(other), b = figures(one);
      const bool as_good = a[0] <= b[0] && a[1] <= b[1] && a[2] <= b[2];
      return good(other) && as_good && (a != b || &other < &one);
    });
    if (good(one) && !beaten) front.push_back(&one);
  }
  std::stable_sort(front.begin(), front.end(),
                   [&](const Candidate* a, const Candidate* b) { return figures(*a) < figures(*b); });
  return front;
}

}  // namespace drapeplan
