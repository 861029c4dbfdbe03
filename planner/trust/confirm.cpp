#include "planner/trust/confirm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "planner/base/parallel.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/search/batch_evaluate.hpp"
#include "planner/search/finalists.hpp"
#include "planner/trust/setting_runs.hpp"

namespace drapeplan {
namespace {

/// How many times longer a run takes: there are more cells both ways, and steps are as much shorter.
double cost(bool cells, double time) {
  return (cells ? std::pow(kFinerCells, 3) : 1) * time;
}

struct FinerSetting {
  FemOptions options;
  double seconds;  ///< of both runs
};

/// @param time  so much less speed.
FemOptions finer_options(FemOptions report, bool cells, double time) {
  if (cells) report.mesh_size /= kFinerCells;
  report.time_scaling /= time;
  return report;
}

/// Cells and time of all finer settings, the finest first.
std::array<std::pair<bool, double>, 3> finer_ways(const FemOptions& report) {
  const double slower = std::clamp(report.time_scaling, 1.0, kFinerTime);  // 1 where it is played as it is
  return {{{true, slower}, {true, 1.0}, {false, slower}}};
}

/// The finest setting whose runs fit into the time; nothing if there is none that is finer.
std::optional<FinerSetting> finer_setting(const FemOptions& report, double seconds_each,
                                          const SideRuns& runs) {
  const double side_by_side = thread_count(runs.threads) > 1 ? 1 : 2;
  for (const auto& [cells, time] : finer_ways(report)) {
    if (!cells && !(time > 1)) continue;
    const double seconds = side_by_side * seconds_each * cost(cells, time);
    if (runs.seconds > 0 && seconds > runs.seconds) continue;
    return FinerSetting{finer_options(report, cells, time), seconds};
  }
  return std::nullopt;
}

}  // namespace

double Confirmation::error(double Score::*part) const {
  return std::abs(finer.*part - reported.*part);
}

double Confirmation::gain_error() const {
  return std::abs(finer_gain() - gain());
}

std::optional<Confirmation> confirm(const DrapeProblem& problem, const StagedResult& search,
                                    const SideRuns& runs, EvaluationLog& log) {
  const Candidate& baseline = better_baseline(search);
  if (search.best_fidelity != kReport || !search.best.outcome.score.valid || !baseline.outcome.score.valid)
    return std::nullopt;
  const double each = std::max(search.best.outcome.wall_seconds, baseline.outcome.wall_seconds);
  const std::optional<FinerSetting> finer =
      finer_setting(problem.definition().fidelities.at(kReport), each, runs);
  if (!finer) return std::nullopt;
  // A model that cannot be built is a failed run, as any other one.
  const Evaluate evaluate = [&](const Schedule& schedule, const std::string&) {
    return outcome_of(problem.run_on(model_of(problem.definition(), finer->options), schedule));
  };
  const std::vector<Outcome> outcomes = make_batch_evaluate(evaluate, log, runs)(
      {search.best.schedule, baseline.schedule}, setting_text(finer->options), "confirm");
  return Confirmation{.options = finer->options,
                      .reported = search.best.outcome.score,
                      .reported_baseline = baseline.outcome.score,
                      .finer = outcomes[0].score,
                      .finer_baseline = outcomes[1].score};
}

double confirm_seconds(const FemOptions& report, double each, const SideRuns& runs) {
  const std::optional<FinerSetting> finer = finer_setting(report, each, runs);
  return finer ? finer->seconds : 0;
}

std::string confirmation_text(const Confirmation& confirmation) {
  const std::string setting = setting_text(confirmation.options);
  if (!confirmation.finer.valid)
    return fmt::format("played again with {} it fails: {}", setting, confirmation.finer.reason);
  std::vector<std::string> parts;
  for (const ScorePart& part : kScoreParts) {
    if (!part.leads && part.value != &Score::objective) continue;
    parts.push_back(fmt::format("{} {}{}{} (reported: {})", part.label, value_text(part, confirmation.finer),
                                *part.unit == '\0' ? "" : " ", part.unit,
                                value_text(part, confirmation.reported)));
  }
  return fmt::format("played again with {}: {}", setting, fmt::join(parts, ", "));
}

nlohmann::json confirmation_json(const Confirmation& confirmation) {
  nlohmann::json errors;
  for (const ScorePart& part : kScoreParts) {
    if (part.compared)
      errors[part.key] =
          confirmation.finer.valid ? finite(confirmation.error(part.value)) : nlohmann::json(nullptr);
  }
  return {
      {"setting", setting_text(confirmation.options)},
      {"best", score_json(confirmation.finer)},
      {"baseline", score_json(confirmation.finer_baseline)},
      {"errors", std::move(errors)},
      {"gain", finite(confirmation.gain())},
      {"gain_confirmed", confirmation.ran() ? finite(confirmation.finer_gain()) : nlohmann::json(nullptr)},
      {"confirmed", confirmation.confirmed()}};
}

Confirmation confirmation_from(const nlohmann::json& value, const FemOptions& report, const Score& reported,
                               const Score& reported_baseline) {
  const std::string setting = value.at("setting").get<std::string>();
  for (const auto& [cells, time] : finer_ways(report)) {
    const FemOptions options = finer_options(report, cells, time);
    if (setting_text(options) != setting) continue;
    return {.options = options,
            .reported = reported,
            .reported_baseline = reported_baseline,
            .finer = score_from(value.at("best")),
            .finer_baseline = score_from(value.at("baseline"))};
  }
  throw std::invalid_argument(fmt::format("confirmation: \"{}\" is not finer than `report`", setting));
}

}  // namespace drapeplan
