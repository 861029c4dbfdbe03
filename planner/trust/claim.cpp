#include "planner/trust/claim.hpp"

#include <fmt/format.h>

#include <cmath>

#include "planner/search/finalists.hpp"
#include "planner/trust/setting_runs.hpp"

namespace drapeplan {

namespace {

/// "The optimised sequence beats the baselines" is taken back; what else the message said stays.
void take_back(const std::string& claim, StagedResult& search) {
  const size_t rest = search.message.find("; ");
  search.message = claim + (rest == std::string::npos ? "" : search.message.substr(rest));
  search.beats_baselines = false;
}

std::string winner(const StagedResult& search) {
  return fmt::format("the optimised sequence (candidate \"{}\")", search.best.name);
}

}  // namespace

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
  take_back(fmt::format("{} is no better than the baselines within the error of {:.1f} %: its objective of "
                        "{:.4g} is {:.1f} % "
                        "below the better one's {:.4g}",
                        winner(search), 1e2 * error, best, 1e2 * gain, baseline),
            search);
}

void claim_confirmed(const Confirmation& confirmation, StagedResult& search) {
  if (!search.beats_baselines || confirmation.confirmed() || confirmation.undecided()) return;
  if (confirmation.ran() && confirmation.gain() <= 0) return;
  const std::string setting = setting_text(confirmation.options);
  std::string claim;
  if (!confirmation.finer.valid) {
    claim = fmt::format("{} is not confirmed to be better than the baselines: with {} it fails: {}",
                        winner(search), setting, confirmation.finer.reason);
  } else if (confirmation.reported.followed && !confirmation.finer.followed) {
    claim = fmt::format("{} is not confirmed: with {} the rig does not follow it within the tolerance of lag",
                        winner(search), setting);
  } else {
    claim = fmt::format(
        "{} is no better than the baselines as far as a finer run shows: its objective is {:.4g} against "
        "{:.4g}, but {:.4g} against {:.4g} with {}",
        winner(search), confirmation.reported.objective, confirmation.reported_baseline.objective,
        confirmation.finer.objective, confirmation.finer_baseline.objective, setting);
  }
  take_back(claim, search);
}

}  // namespace drapeplan
