#include "planner/trust/claim.hpp"

#include <fmt/format.h>

#include <cmath>

#include "planner/search/finalists.hpp"
#include "planner/trust/setting_runs.hpp"

namespace drapeplan {

void claim_beyond(double error, StagedResult& search) {
  const double best = value_of(search.best.outcome);
  const double baseline = value_of(better_baseline(search).outcome);
  if (!search.beats_baselines || !std::isfinite(best) || !std::isfinite(baseline)) return;
  const double gain = (baseline - best) / std::abs(baseline);
  const bool lag = gain <= 0;  // it wins since the rig does not follow the baselines: no matter of figures
  if (lag || gain > error) {
    search.message += fmt::format("; objectives may be off by {:.1f} %", 1e2 * error);
    return;
  }
  search.beats_baselines = false;
  search.message = fmt::format(
      "the optimised sequence (candidate \"{}\") is no better than the baselines within the error of {:.1f} "
      "%: "
      "its objective of {:.4g} is {:.1f} % below the better one's {:.4g}",
      search.best.name, 1e2 * error, best, 1e2 * gain, baseline);
  if (!search.best.outcome.score.followed)
    search.message += "; the rig does not follow it within the tolerance of lag";
}

void claim_confirmed(const Confirmation& confirmation, StagedResult& search) {
  if (!search.beats_baselines || confirmation.confirmed()) return;
  // It wins since the rig does not follow the baselines: no matter of figures.
  if (confirmation.ran() && confirmation.gain() <= 0) return;
  search.beats_baselines = false;
  const std::string who = fmt::format("the optimised sequence (candidate \"{}\")", search.best.name);
  const std::string setting = setting_text(confirmation.options);
  if (!confirmation.ran()) {
    const bool best = !confirmation.finer.valid;
    search.message = fmt::format("{} is not confirmed to be better than the baselines: with {} {} fails: {}",
                                 who, setting, best ? "it" : "the better one",
                                 best ? confirmation.finer.reason : confirmation.finer_baseline.reason);
    return;
  }
  search.message = fmt::format(
      "{} is no better than the baselines as far as a finer run shows: its objective is {:.4g} "
      "against {:.4g}, but {:.4g} against {:.4g} with {}",
      who, confirmation.reported.objective, confirmation.reported_baseline.objective,
      confirmation.finer.objective, confirmation.finer_baseline.objective, setting);
}

}  // namespace drapeplan
