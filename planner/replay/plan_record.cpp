#include "planner/replay/plan_record.hpp"

#include <limits>

#include "planner/drape/result_fields.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<HistoryEntry> history_from(const json& list) {
  std::vector<HistoryEntry> history;
  for (const json& one : list)
    history.push_back({.number = one.at("evaluation").get<int>(),
                       .stage = one.at("stage").get<std::string>(),
                       .fidelity = one.at("fidelity").get<std::string>(),
                       .objective = number_or(one.at("objective"), kInfinity),
                       .valid = !one.at("objective").is_null(),
                       .best_so_far = number_or(one.at("best_so_far"), kInfinity)});
  return history;
}

/// They ran to their end and followed their commands, or they would not stand there.
std::vector<Candidate> unbeaten_from(const json& list) {
  std::vector<Candidate> candidates;
  for (const json& one : list) {
    Candidate candidate{.name = one.at("candidate").get<std::string>(), .schedule = {}, .outcome = {}};
    Score& score = candidate.outcome.score;
    score.valid = score.followed = true;
    score.max_gap = one.at("max_gap").get<double>();
    score.max_boundary_offset = one.at("max_boundary_offset").get<double>();
    score.duration = one.at("duration").get<double>();
    score.objective = one.at("objective").get<double>();
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

DesignResult design_from(const json& value) {
  DesignResult design;
  design.evaluations = value.at("evaluations").get<int>();
  for (const json& one : value.at("changes")) {
    DesignChange change{.path = one.at("path").get<std::string>(),
                        .before = one.at("from").get<std::string>(),
                        .after = one.at("to").get<std::string>(),
                        .without = {}};
    Score& without = change.without.score;
    without.objective = number_or(one.at("objective_without"), kInfinity);
    without.valid = !one.at("objective_without").is_null();
    if (!without.valid) without.reason = one.at("reason_without").get<std::string>();
    design.changes.push_back(std::move(change));
  }
  return design;
}

}  // namespace

PlanRecord plan_record(const RunFolder& run, const Case& definition) {
  return from_result(run, [&definition](const json& document) {
    PlanRecord record;
    const json& best = document.at("best");
    PlanResult& result = record.result;
    result.wall_seconds = document.at("wall_seconds").get<double>();
    if (best.contains("design")) {
      result.design = design_from(best.at("design"));
      result.given = score_from(best.at("design").at("given_uniform"));
    }
    StagedResult& search = result.search;
    search.best.name = best.at("candidate").get<std::string>();
    search.best_fidelity = best.at("fidelity").get<std::string>();
    search.finalists = unbeaten_from(document.at("unbeaten"));
    search.beats_baselines = document.at("beats_baselines").get<bool>();
    // A plan that was interrupted after its search has compared its changes of the rig.
    search.interrupted =
        document.at("interrupted").get<bool>() && !(result.design && !result.design->changes.empty());
    search.message = document.at("message").get<std::string>();
    search.history = history_from(document.at("history"));
    search.evaluations = document.at("evaluations").get<int>();
    search.failed_evaluations = document.at("failed_evaluations").get<int>();
    definition.fidelities.at(search.best_fidelity);
    if (document.contains("numerics"))
      record.trust.choice = choice_from(document.at("numerics"), definition.fidelities);
    if (document.contains("robust")) record.trust.spread = spread_from(document.at("robust"));
    record.effects = effects_from(document.at("diagnosis"), *definition.grippers);
    return record;
  });
}

}  // namespace drapeplan
