#include "planner/search/plan.hpp"

#include <chrono>
#include <limits>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <system_error>

#include "fem/core/hash.hpp"
#include "mapping/error.hpp"
#include "planner/base/json_text.hpp"
#include "planner/base/parallel.hpp"
#include "planner/base/text.hpp"
#include "planner/case/file.hpp"
#include "planner/schedule/check.hpp"

namespace drapeplan {
namespace {

/// Drapes at the reporting fidelity with their frames, so that pictures need no second run: those of the
/// baselines and the best so far. All others are dropped at once, whatever the number of evaluations.
class ReportedDrapes {
 public:
  explicit ReportedDrapes(const SequenceFrame& frame)
      : baselines_{schedule_hash(to_schedule(frame, uniform_strokes(frame))),
                   schedule_hash(to_schedule(frame, wave_strokes(frame)))} {}

  void offer(std::uint64_t hash, Drape drape) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool best = drape.score.valid && drape.score.objective < best_objective_;
    if (!best && !is_baseline(hash)) return;
    if (best) {
      if (!is_baseline(best_)) drapes_.erase(best_);
      best_ = hash;
      best_objective_ = drape.score.objective;
    }
    drapes_[hash] = std::move(drape);
  }

  /// The drape of a schedule; run now if it is not kept, or came from the log of an earlier run.
  Drape take(const DrapeProblem& problem, const Schedule& schedule) {
    const auto known = drapes_.find(schedule_hash(schedule));
    return known != drapes_.end() ? known->second : problem.run(schedule, kReport, kReportFrames);
  }

 private:
  [[nodiscard]] bool is_baseline(std::uint64_t hash) const {
    return hash == baselines_[0] || hash == baselines_[1];
  }

  std::array<std::uint64_t, 2> baselines_;
  std::uint64_t best_ = 0;
  double best_objective_ = std::numeric_limits<double>::infinity();
  std::mutex mutex_;
  std::map<std::uint64_t, Drape> drapes_;
};

/// Takes out what people call things, where they have them from and how far these hold, at any depth: members that
/// are texts, and bands.
void erase_words(nlohmann::json& value) {
  if (value.is_object()) {
    for (const char* key : {"name", "source", "valid_to"}) {
      if (value.contains(key) && value[key].is_string()) value.erase(key);
    }
    value.erase("band");
  }
  for (nlohmann::json& part : value) {
    if (part.is_structured()) erase_words(part);
  }
}

/// Tells evaluations apart whose fidelities have the same name and other settings: of a case that chooses
/// them.
std::uint64_t settings_hash(const Case& definition) {
  if (!definition.chooses_fidelities) return 0;
  Fnv1a hash;
  const nlohmann::json resolved = resolved_case(definition);
  hash.add(std::string_view(dump_json({resolved.at("fem"), resolved.value("fidelities", nlohmann::json())})));
  return hash.value();
}

}  // namespace

EvaluationLog start_log(const Case& definition, OutputFolder& out, const PlanOptions& options) {
  const std::string file = (out.path() / kEvaluations).string();
  const std::uint64_t hash = case_hash(definition);
  std::vector<std::string> kept;
  std::error_code error;
  if (options.resume && std::filesystem::exists(file, error)) {
    read_evaluations(file, hash, {});  // refused before anything is changed
    kept = {kEvaluations, "resolved.json"};
  }
  const std::filesystem::path earlier = out.begin(kept);
  if (!earlier.empty() && options.moved) options.moved(earlier);
  write_resolved(definition, out);
  return EvaluationLog(file, hash);
}

void write_resolved(const Case& definition, const OutputFolder& out) {
  write_text(out.path() / "resolved.json", dump_json(resolved_case(definition), 2) + "\n");
}

std::uint64_t case_hash(const Case& definition) {
  nlohmann::json relevant = resolved_case(definition);
  if (definition.chooses_fidelities) relevant.erase("fem"), relevant.erase("fidelities");
  // Published results and budgets change no evaluation, nor do words: a search may go on with other ones.
  for (const char* key : {"description", "references", "optimise"}) relevant.erase(key);
  erase_words(relevant);
  Fnv1a hash;
  hash.add(std::string_view(dump_json(relevant)));
  return hash.value();
}

std::vector<std::string> plan_ladder(const Case& definition) {
  std::vector<std::string> ladder;
  for (const char* name : kSearched) {
    if (definition.fidelities.contains(name)) ladder.emplace_back(name);
  }
  if (ladder.empty()) ladder.emplace_back(kReport);
  return ladder;
}

void build_models(const DrapeProblem& problem) {
  std::vector<std::string> fidelities = plan_ladder(problem.definition());
  fidelities.emplace_back(kReport);
  for (const std::string& fidelity : fidelities) static_cast<void>(problem.model(fidelity));
}

namespace {

/// The stages of the search on one rig, at the reporting fidelity in the end.
void search_schedules(const DrapeProblem& problem, std::uint64_t design, EvaluationLog& log,
                      const PlanOptions& options, const std::function<void(const Progress&)>& progress,
                      PlanResult& result) {
  ReportedDrapes reported(problem.frame());
  const Evaluate evaluate = [&](const Schedule& schedule, const std::string& fidelity) {
    require_playable(schedule, *problem.definition().grippers);
    const bool report = fidelity == kReport;
    Drape drape = report ? problem.run(schedule, fidelity, kReportFrames)
                         : problem.run_for_objective(schedule, fidelity);
    Outcome outcome = outcome_of(drape);
    outcome.fields = problem.score_fields_of(drape, fidelity);
    if (report) reported.offer(schedule_hash(schedule), std::move(drape));
    return outcome;
  };
  StagedOptions staged;
  staged.optimise = problem.definition().optimise;
  staged.kept = options.kept;
  staged.threads = options.threads;
  if (result.design) staged.wave = result.design->wave;
  staged.ladder = plan_ladder(problem.definition());
  const ScoreFields& fields = problem.score_fields();
  staged.objective_near = [&fields](const Eigen::VectorXd& around) { return fields.objective_near(around); };
  staged.field_scale = fields.scale();
  const BatchEvaluate batch = make_batch_evaluate(evaluate, log, options.threads, design, options.stop);
  result.search = staged_search(problem.frame(), staged, batch, progress);
  const StagedResult& search = result.search;
  const auto take = [&](const Candidate& candidate, const std::string& fidelity) {
    // Interrupted: a run at the fidelity of the search is quick.
    return fidelity == kReport ? reported.take(problem, candidate.schedule)
                               : problem.run(candidate.schedule, fidelity, kReportFrames);
  };
  const std::array<std::function<void()>, 3> jobs{
      [&] { result.uniform = take(search.uniform, kReport); },
      [&] { result.wave = take(search.wave, kReport); },
      [&] { result.best = take(search.best, search.best_fidelity); }};
  parallel_for(
      int(jobs.size()), [&](int k) { jobs[size_t(k)](); }, options.threads);
}

}  // namespace

PlanResult plan(const DrapeProblem& problem, OutputFolder& out, const PlanOptions& options,
                const std::function<void(const Progress&)>& progress) {
  EvaluationLog log = start_log(problem.definition(), out, options);
  return plan(problem, log, options, progress);
}

PlanResult plan(const DrapeProblem& problem, EvaluationLog& log, const PlanOptions& options,
                const std::function<void(const Progress&)>& progress) {
  const auto clock = std::chrono::steady_clock::now();
  log.use_settings(settings_hash(problem.definition()));
  PlanResult result;
  const OptimiseOptions& optimise = problem.definition().optimise;
  if (!optimise.design.empty()) {
    const auto show = [&](int done, double best) {
      if (!progress) return;
      progress({.stage = "design",
                .done = done,
                .planned = optimise.design_evaluations,
                .best = best,
                .seconds_left = std::numeric_limits<double>::quiet_NaN()});
    };
    result.design = search_design(problem, plan_ladder(problem.definition()).front(), log, options.threads,
                                  show, options.stop);
  }
  const std::uint64_t design = result.design ? design_hash(result.design->overrides) : 0;
  search_schedules(planned_problem(problem, result), design, log, options, progress, result);
  if (result.design && !result.search.interrupted) {
    const Schedule uniform = to_schedule(problem.frame(), uniform_strokes(problem.frame()));
    result.given = problem.run(uniform, kReport).score;
    compare_changes(problem, result.search.best.schedule, log, options.threads, *result.design);
  }
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return result;
}

}  // namespace drapeplan
