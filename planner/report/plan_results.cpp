#include <nlohmann/json.hpp>

#include "planner/diagnosis/verdict.hpp"
#include "planner/drape/acceptance.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/drape/run_checks.hpp"
#include "planner/report/run_files.hpp"
#include "planner/search/finalists.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

json history_json(const StagedResult& search) {
  json list = json::array();
  for (const HistoryEntry& entry : search.history) {
    list.push_back({{"evaluation", entry.number},
                    {"stage", entry.stage},
                    {"fidelity", entry.fidelity},
                    {"objective", finite(entry.objective)},
                    {"best_so_far", finite(entry.best_so_far)}});
  }
  return list;
}

json drape_json(const Drape& drape) {
  json out = summary_json(drape.run.summary);
  add_scores(drape.score, drape.other, out);
  return out;
}

json baselines_json(const PlanResult& result) {
  json uniform, wave;
  add_scores(result.uniform.score, result.uniform.other, uniform);
  add_scores(result.wave.score, result.wave.other, wave);
  json baselines{{"uniform", uniform["score"]}, {"wave", wave["score"]}};
  if (result.uniform.other)
    baselines["pressed"] = {{"uniform", uniform["score_pressed"]}, {"wave", wave["score_pressed"]}};
  return baselines;
}

/// What was changed of the case, and the objective of the best schedule without each change.
json design_json(const PlanResult& result) {
  json changes = json::array();
  for (const DesignChange& change : result.design->changes) {
    changes.push_back(
        {{"path", change.path},
         {"from", change.before},
         {"to", change.after},
         {"objective_without",
          change.without.score.valid ? finite(change.without.score.objective) : json(nullptr)}});
    if (!change.without.score.valid) changes.back()["reason_without"] = change.without.score.reason;
  }
  return {{"changes", std::move(changes)},
          {"case", kDesignFile},
          {"evaluations", result.design->evaluations},
          {"given_uniform", score_json(result.given)}};
}

/// The front of gap, boundary offset and duration, of all that was evaluated at the reporting fidelity.
json candidates_json(const StagedResult& search) {
  json list = json::array();
  for (const Candidate* candidate : unbeaten(search.finalists)) {
    const Score& score = candidate->outcome.score;
    list.push_back({{"candidate", candidate->name},
                    {"max_gap", score.max_gap},
                    {"max_boundary_offset", score.max_boundary_offset},
                    {"duration", score.duration},
                    {"objective", score.objective}});
  }
  return list;
}

}  // namespace

json plan_json(const DrapeProblem& problem, const PlanResult& result, const PlanTrust& trust,
               const Diagnosis& diagnosis) {
  const StagedResult& search = result.search;
  json reach{{"floor_max", finite(problem.reach().floor_max)},
             {"floor_rms", finite(problem.reach().floor_rms)},
             {"link_violation", finite(problem.reach().link_violation)},
             {"status", problem.reach().status},
             {"meaning", explain_reach(problem.reach_problem(), problem.reach())}};
  json best{{"candidate", search.best.name}};
  add_scores(result.best.score, result.best.other, best);
  best["warnings"] = drape_warnings(problem, result.best, search.best_fidelity);
  best["fidelity"] = search.best_fidelity;
  best["acceptance"] = acceptance_json(acceptance_of(problem, result.best, search.best_fidelity));
  if (result.best.score.valid) best["schedule"] = "schedule.json";
  if (result.design) best["design"] = design_json(result);
  json document{{"case", problem.definition().name},
                {"terms", problem.model(kReport).term_names()},
                {"reach", reach},
                {"front", front_json(problem.ply_floor().front)},
                {"floor", problem.ply_floor().meaning},
                {"map",
                 {{"max_shear_deg", problem.mapping().max_shear_deg},
                  {"mean_shear_deg", problem.mapping().mean_shear_deg}}},
                {"baselines", baselines_json(result)},
                {"best", best},
                {"runs",
                 {{"uniform", drape_json(result.uniform)},
                  {"wave", drape_json(result.wave)},
                  {"best", drape_json(result.best)}}},
                {"unbeaten", candidates_json(search)},
                {"interrupted", search.interrupted},
                {"beats_baselines", search.beats_baselines},
                {"message", search.message},
                {"verdict", verdict_text(problem, result, trust)},
                {"force", best_force_text(problem, result)},
                {"evaluations", search.evaluations},
                {"failed_evaluations", search.failed_evaluations},
                {"wall_seconds", result.wall_seconds},
                {"history", history_json(search)}};
  if (trust.choice) document["numerics"] = choice_json(*trust.choice);
  if (trust.confirmation) document["confirmation"] = confirmation_json(*trust.confirmation);
  if (trust.spread) document["robust"] = spread_json(*trust.spread, trust.rule);
  if (result.best.score.valid)
    document["diagnosis"] = diagnosis_json(diagnosis, *problem.definition().grippers);
  return document;
}

}  // namespace drapeplan
