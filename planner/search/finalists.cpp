#include "planner/search/finalists.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/drape/problem.hpp"

namespace drapeplan {
namespace {

/// Of candidates that may win: first those that ran to their end, of these those whose commands were
/// followed.
bool ranks_before(const Outcome& a, const Outcome& b) {
  const double of_a = value_of(a), of_b = value_of(b);
  if (std::isfinite(of_a) != std::isfinite(of_b)) return std::isfinite(of_a);
  return a.score.followed != b.score.followed ? a.score.followed : of_a < of_b;
}

}  // namespace

void conclude(StagedResult& result) {
  std::stable_sort(result.finalists.begin(), result.finalists.end(),
                   [](const Candidate& a, const Candidate& b) { return ranks_before(a.outcome, b.outcome); });
  result.best = result.finalists.front();
  result.best_fidelity = kReport;
  const Outcome& better_baseline = ranks_before(result.wave.outcome, result.uniform.outcome)
                                       ? result.wave.outcome
                                       : result.uniform.outcome;
  const double baseline = value_of(better_baseline), best = value_of(result.best.outcome);
  result.beats_baselines = ranks_before(result.best.outcome, better_baseline);
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
