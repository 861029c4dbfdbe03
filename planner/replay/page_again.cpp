#include "planner/replay/page_again.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "planner/base/parallel.hpp"
#include "planner/drape/acceptance.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/replay/plan_record.hpp"
#include "planner/report/run_files.hpp"
#include "planner/search/finalists.hpp"
#include "planner/views/drape_page.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// @param recorded  of a drape: its summary and its scores. @param scores  of the drape now; empty of a run
/// that has none.
ReplayedDrape compared(const std::string& name, const json& recorded, const RunSummary& summary,
                       const json& scores) {
  ReplayedDrape drape{.name = name,
                      .recorded_hash = recorded.at("state_hash").get<std::string>(),
                      .state_hash = hex(summary.state_hash),
                      .recorded_objective = kNaN,
                      .objective = kNaN};
  if (scores.empty()) return drape;
  drape.recorded_objective = number_or(recorded.at("score").at("objective"), kNaN);
  drape.objective = number_or(scores.at("score").at("objective"), kNaN);
  for (const auto& [key, score] : scores.items())
    drape.same_score = drape.same_score && recorded.contains(key) && recorded.at(key) == score;
  return drape;
}

std::string objective_text(double objective) {
  return std::isfinite(objective) ? fmt::format("{:.4f}", objective) : "none";
}

/// What is said of a drape that is not the same.
std::string difference_text(const ReplayedDrape& drape) {
  std::string text = fmt::format("replay differs: {}: ", drape.name);
  text += drape.recorded_hash != drape.state_hash
              ? fmt::format("state {} instead of {} as recorded", drape.state_hash, drape.recorded_hash)
              : std::string("the same state has another score");
  if (!drape.same_score)
    text += fmt::format(", objective {} instead of {}", objective_text(drape.objective),
                        objective_text(drape.recorded_objective));
  return text +
         "; another version of the program, another processor, or a file of the run was changed. The page "
         "shows what was "
         "played now, result.json what was recorded";
}

/// Notes which drapes are not the same.
void note_differences(PageAgain& again) {
  for (const ReplayedDrape& drape : again.drapes) {
    if (!drape.same()) again.warnings.push_back(difference_text(drape));
  }
}

json scores_of(const Drape& drape) {
  json scores;
  add_scores(drape.score, drape.other, scores);
  return scores;
}

/// The three drapes of a plan and its page.
PageAgain plan_again(const RunFolder& run, int threads) {
  const bool drawn = from_result(run, [](const json& document) {
    return !document.at("best").at("candidate").is_null() && document.at("best").contains("schedule");
  });
  if (!drawn) throw NotFinished("no drape of this plan could be simulated to its end");
  const bool design =
      from_result(run, [](const json& document) { return document.at("best").contains("design"); });
  Case definition = case_in(run, design ? kDesignFile : "resolved.json");
  PlanRecord record = plan_record(run, definition);
  const DrapeProblem problem(std::move(definition));
  const RigOptions& rig = *problem.definition().grippers;
  PlanResult& result = record.result;
  StagedResult& search = result.search;
  search.best.schedule = schedule_in(run, "schedule.json", rig);
  search.uniform.schedule = schedule_in(run, "schedule_uniform.json", rig);
  search.wave.schedule = schedule_in(run, "schedule_wave.json", rig);
  const auto play = [&problem](Candidate& candidate, const std::string& fidelity, Drape& drape) {
    drape = problem.run(candidate.schedule, fidelity, kReportFrames);
    candidate.outcome.score = drape.score;
  };
  const std::array<std::function<void()>, 3> jobs{
      [&] { play(search.uniform, kReport, result.uniform); },
      [&] { play(search.wave, kReport, result.wave); },
      [&] { play(search.best, search.best_fidelity, result.best); }};
  parallel_for(
      int(jobs.size()), [&](int k) { jobs[size_t(k)](); }, threads);
  PageAgain again = from_result(run, [&](const json& document) {
    const json& runs = document.at("runs");
    const auto one = [&](const char* name, const char* key, const Drape& drape) {
      return compared(name, runs.at(key), drape.run.summary, scores_of(drape));
    };
    return PageAgain{.drapes = {one("uniform", "uniform", result.uniform), one("wave", "wave", result.wave),
                                one("optimised", "best", result.best)},
                     .warnings = {}};
  });
  if (run.result.contains("confirmation"))
    record.trust.confirmation = from_result(run, [&](const json& document) {
      return confirmation_from(document.at("confirmation"), problem.definition().fidelities.at(kReport),
                               search.best.outcome.score, better_baseline(search).outcome.score);
    });
  note_differences(again);
  const Diagnosis diagnosis =
      diagnosis_of(problem, result.best, search.best_fidelity, std::move(record.effects));
  write_plan_page(run.out.path(), problem, result, record.trust, diagnosis, again.warnings);
  return again;
}

/// What the run took, not what its replay did.
void keep_wall_time(const RunFolder& run, RunSummary& summary) {
  summary.wall_seconds =
      from_result(run, [](const json& document) { return number_or(document.at("wall_seconds"), kNaN); });
}

PageAgain simulated_drape_again(const RunFolder& run, Case definition, const Played& played) {
  const DrapeProblem problem(std::move(definition));
  const Schedule schedule = schedule_in(run, "schedule.json", *problem.definition().grippers);
  SeenDrape seen = play_drape(problem, schedule, played);
  keep_wall_time(run, seen.drape.run.summary);
  PageAgain again{.drapes = {from_result(run,
                                         [&](const json& document) {
                                           return compared(played.schedule, document, seen.drape.run.summary,
                                                           scores_of(seen.drape));
                                         })},
                  .warnings = {}};
  note_differences(again);
  const std::string verdict = acceptance_text(acceptance_of(problem, seen.drape, played.fidelity));
  write_drape_page(run.out.path(), problem, seen, schedule, played, verdict,
                   diagnosis_of(problem, seen.drape, played.fidelity), again.warnings);
  return again;
}

PageAgain simulated_run_again(const RunFolder& run, const Case& definition, const Played& played) {
  const Model model = model_of(definition, definition.fidelities.at(played.fidelity));
  SeenRun seen = play_run(definition, model, played);
  keep_wall_time(run, seen.run.summary);
  PageAgain again{
      .drapes = {from_result(
          run, [&](const json& document) { return compared("this run", document, seen.run.summary, {}); })},
      .warnings = {}};
  note_differences(again);
  write_run_page(run.out.path(), definition, model, seen, again.warnings);
  return again;
}

PageAgain simulate_again(const RunFolder& run) {
  Case definition = case_in(run, "resolved.json");
  const Played played = from_result(run, [&](const json& document) {
    Played one = played_from(document.at("played"));
    definition.fidelities.at(one.fidelity);
    return one;
  });
  if (played.part)
    throw WrongInput(
        fmt::format("{}: is one part of a run (--pause, --restart): the state that it began or ended with "
                    "is not in its folder",
                    run.out.path().string()));
  return definition.grippers ? simulated_drape_again(run, std::move(definition), played)
                             : simulated_run_again(run, definition, played);
}

}  // namespace

PageAgain make_page_again(const RunFolder& run, int threads) {
  return run.verb == "plan" ? plan_again(run, threads) : simulate_again(run);
}

}  // namespace drapeplan
