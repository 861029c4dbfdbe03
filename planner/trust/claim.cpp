#include "planner/trust/claim.hpp"

#include <fmt/format.h>

#include <cmath>

#include "planner/search/finalists.hpp"

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

}  // namespace drapeplan
