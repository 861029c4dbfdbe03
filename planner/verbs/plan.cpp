// plan: the main job, for one or many case files.
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "mapping/error.hpp"
#include "planner/base/quantity.hpp"
#include "planner/base/text.hpp"
#include "planner/batch/run_folders.hpp"
#include "planner/batch/summary.hpp"
#include "planner/cli/process.hpp"
#include "planner/diagnosis/verdict.hpp"
#include "planner/drape/run_checks.hpp"
#include "planner/report/run_files.hpp"
#include "planner/search/interrupted.hpp"
#include "planner/search/plan.hpp"
#include "planner/trust/after_search.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

struct PlanVerbOptions {
  CommonOptions common;
  std::vector<std::string> files;
  bool resume = false;
  std::string budget;  ///< a time or a number of evaluations; empty: the case's
  std::string cycle;   ///< of the robot's controller
};

/// A line on stderr every few seconds: where the search is, how good, how long still.
class ProgressLine {
 public:
  void operator()(const Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    const bool last = progress.done == progress.planned;
    if (progress.stage == stage_ && !last && now - shown_ < std::chrono::seconds(kSeconds)) return;
    shown_ = now;
    stage_ = progress.stage;
    const std::string planned = progress.planned > 0 ? fmt::format("/{}", progress.planned) : "";
    std::cerr << fmt::format("  {:4}{}  {:<8} best {:8.3f}", progress.done, planned, progress.stage,
                             progress.best);
    if (std::isfinite(progress.seconds_left))
      std::cerr << fmt::format("   about {:.0f} s left", progress.seconds_left);
    std::cerr << '\n';
  }

 private:
  static constexpr int kSeconds = 5;
  std::chrono::steady_clock::time_point shown_{};
  std::string stage_;
};

std::string design_text(const PlanResult& result) {
  std::string text =
      fmt::format("\nthe case as it was given, uniform: objective {:.2f}\n", result.given.objective);
  for (const DesignChange& change : result.design->changes) {
    text += fmt::format("  {}: {} instead of {}; without this change the objective is {}\n", change.path,
                        change.after, change.before,
                        change.without.score.valid ? fmt::format("{:.2f}", change.without.score.objective)
                                                   : "none: " + change.without.score.reason);
  }
  text.pop_back();
  return text;
}

struct PlannedCase {
  json result;
  std::string text;    ///< for people
  bool valid = false;  ///< at least the best drape could be simulated
  std::string reason;  ///< if not
  bool interrupted = false;
};

/// What was found before the search begins.
void print_start(const DrapeProblem& problem) {
  std::cerr << fmt::format("{}: mapped, shear at most {:g} deg\n  terms: {}\n  reach: {}\n{}  {}\n",
                           problem.definition().name, problem.mapping().max_shear_deg,
                           terms_line(problem.model(kReport)),
                           explain_reach(problem.reach_problem(), problem.reach()),
                           front_table(problem.ply_floor().front), problem.ply_floor().meaning);
}

std::string result_text(const DrapeProblem& problem, const PlanResult& result, const PlanTrust& trust,
                        const Diagnosis& diagnosis, const std::filesystem::path& folder) {
  std::string text = fmt::format("\n{}\n", verdict_text(problem, result, trust));
  text += reasons_text(diagnosis, *problem.definition().grippers);
  text += fmt::format("\n{}\n{}\n", comparison_table(problem, result), result.search.message);
  if (const std::string force = best_force_text(problem, result); !force.empty()) text += force + "\n";
  if (trust.confirmation) text += confirmation_text(*trust.confirmation) + "\n";
  if (trust.spread) text += spread_text(*trust.spread) + "\n";
  if (!trust.spread && !result.search.interrupted && result.best.score.valid)
    text +=
        "plants that differ were not simulated: the time, or an interruption, left none for it (--resume "
        "goes on)\n";
  text += fmt::format("{} evaluations ({} failed) in {} s", result.search.evaluations,
                      result.search.failed_evaluations, std::llround(result.wall_seconds));
  if (result.best.score.valid) text += fmt::format("; report: {}", (folder / "report.html").string());
  if (result.design && !result.search.interrupted) text += design_text(result);
  return text + "\n";
}

/// Which strokes of the best schedule matter, at the cheapest fidelity.
std::optional<StrokeEffects> effects_of_best(const DrapeProblem& problem, const PlanResult& result,
                                             EvaluationLog& log, const PlanOptions& planning) {
  return stroke_effects(problem, result.search.best.strokes, plan_ladder(problem.definition()).front(),
                        runs_after_search(kEffectsShare, problem.definition().optimise, result, planning),
                        log);
}

/// Plans one case into its folder; throws what went wrong.
PlannedCase plan_case(Case definition, const PlanVerbOptions& options, OutputFolder& out) {
  const auto clock = std::chrono::steady_clock::now();
  const bool talk = !options.common.quiet;
  auto problem = std::make_unique<const DrapeProblem>(definition);
  if (!definition.chooses_fidelities) build_models(*problem);
  if (talk) print_start(*problem);
  print_warnings(map_warnings(problem->definition(), problem->mapping()), options.common);
  ProgressLine line;
  const auto show = [&](const Progress& progress) {
    if (talk) line(progress);
  };
  const InterruptGuard guard;
  const PlanOptions planning{
      .resume = options.resume,
      .threads = options.common.threads,
      .stop = [] { return InterruptGuard::interrupted(); },
      .kept =
          [&](double each) {
            return seconds_after_search(definition, each, options.common.threads) +
                   kEffectsShare * definition.optimise.budget;
          },
      .moved = [&](const std::filesystem::path& earlier) { print_set_aside(earlier, options.common); }};
  EvaluationLog log = start_log(problem->definition(), out, planning);
  PlanTrust trust;
  if (definition.chooses_fidelities) {
    trust.choice = choose_fidelities(definition, log, planning.threads, planning.stop, show);
    definition.fidelities = trust.choice->fidelities();
    problem = std::make_unique<const DrapeProblem>(definition);
    write_resolved(problem->definition(), out);
    if (talk) std::cerr << choice_table(*trust.choice, definition.optimise, planning.threads);
  }
  PlanResult result = plan(*problem, log, planning, show);
  const DrapeProblem& planned = planned_problem(*problem, result);
  bool interrupted = result.search.interrupted;
  std::optional<StrokeEffects> effects;
  if (result.best.score.valid && !interrupted) {
    try {
      look_closer(*problem, log, planning, show, result, trust);
      effects = effects_of_best(planned, result, log, planning);
    } catch (const Interrupted&) {
      interrupted = true;
    }
  }
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  print_warnings(drape_warnings(planned, result.best, result.search.best_fidelity), options.common);
  const Diagnosis diagnosis =
      diagnosis_of(planned, result.best, result.search.best_fidelity, std::move(effects));
  if (result.best.score.valid)
    // No schedule for a robot from failed runs.
    write_plan(out.path(), planned, result, trust, diagnosis, cycle_of(options.cycle));
  json document = plan_json(planned, result, trust, diagnosis);
  document["interrupted"] = interrupted;
  write_text(out.path() / "result.json", document_text(document));
  return {.result = std::move(document),
          .text = result_text(planned, result, trust, diagnosis, out.path()),
          .valid = result.best.score.valid,
          .reason = result.best.score.reason,
          .interrupted = interrupted};
}

/// Plans one case and adds its result to the list: of a case that could not be planned, its name and why.
/// A bug is thrown on.
ExitCode plan_and_add(Case definition, const std::string& file, const PlanVerbOptions& options,
                      OutputFolder& folder, json& results) {
  const std::string name = definition.name;
  try {
    PlannedCase planned = plan_case(std::move(definition), options, folder);
    results.push_back(std::move(planned.result));
    if (!options.common.json && !options.common.quiet) print(planned.text, true);
    if (!planned.valid)
      std::cerr << file << ": no drape could be simulated to its end; the last: " << planned.reason << '\n';
    return planned.valid && !planned.interrupted ? kDone : kNotFinished;
  } catch (...) {
    Failure failure = failure_of(std::current_exception());
    if (failure.code == kBug) throw;
    std::error_code error;
    if (failure.code == kNotFinished && std::filesystem::exists(folder.path() / kEvaluations, error))
      failure.reason += "; what was done is kept in " + folder.path().string();
    print_failure(failure, file);
    results.push_back({{"case", name}, {"status", "not finished"}, {"reason", failure.reason}});
    return failure.code;
  }
}

/// @throws WrongInput if the text is neither a time nor a number of evaluations.
void set_budget(const std::string& text, OptimiseOptions& optimise) {
  if (text.empty()) return;
  const char* end = text.data() + text.size();
  int count = 0;
  if (const auto [last, fault] = std::from_chars(text.data(), end, count);
      last == end && fault == std::errc()) {
    if (count < 1) throw WrongInput("--budget: a number of evaluations is 1 or more");
    optimise.evaluations = count;
    return;
  }
  std::string fault;
  const std::optional<double> time = parse_quantity(text, Dimension::time, fault);
  if (!time || !(*time > 0))
    throw WrongInput("--budget: a time, as \"10 min\", or a number of evaluations; " +
                     (time ? "it must be > 0" : fault));
  optimise.budget = *time;
  optimise.evaluations = 0;
}

/// A case of several: what is planned, or what is wrong with it.
struct Job {
  std::string file;
  std::filesystem::path folder;
  Case definition;
  std::vector<InputError> errors;
  OutputFolder out;
};

/// Reads all cases and takes their folders. Of several, those that are wrong are left out, and named.
/// @throws InputErrors if none can be planned, or if two would share a folder.
std::vector<Job> read_jobs(const PlanVerbOptions& options) {
  const std::vector<std::filesystem::path> folders = run_folders(options.files, options.common.out);
  if (const auto errors = shared_folders(options.files, folders); !errors.empty()) throw InputErrors(errors);
  std::vector<Job> jobs;
  std::vector<InputError> all;
  bool any = false;
  for (size_t k = 0; k < options.files.size(); ++k) {
    Job job{options.files[k], folders[k], {}, {}, {}};
    job.definition = load_case(job.file, options.common, {"grippers", "material"}, job.errors);
    set_budget(options.budget, job.definition.optimise);
    all.insert(all.end(), job.errors.begin(), job.errors.end());
    any = any || job.errors.empty();
    jobs.push_back(std::move(job));
  }
  if (!any) throw InputErrors(all);
  if (!all.empty()) std::cerr << errors_text(all) << "\nthese cases are left out\n";
  for (Job& job : jobs) {
    if (job.errors.empty()) job.out = OutputFolder(job.folder, "plan", options.resume ? kEvaluations : "");
  }
  return jobs;
}

/// One table of all cases, and its files beside their folders.
void summarise(const std::vector<Job>& jobs, const json& results, const PlanVerbOptions& options) {
  std::vector<PlannedLine> lines;
  for (size_t k = 0; k < results.size(); ++k) {
    lines.push_back(planned_line(jobs[k].file, jobs[k].folder, results[k]));
  }
  const std::filesystem::path root = jobs.front().folder.parent_path();
  write_summary(root, lines);
  if (options.common.json || options.common.quiet) return;
  print(fmt::format("\n{}summary: {}\n", summary_text(lines), (root / "summary.html").string()), true);
}

int plan_all(const PlanVerbOptions& options) {
  cycle_of(options.cycle);  // refused before the work
  std::vector<Job> jobs = read_jobs(options);
  json results = json::array();
  int code = kDone;
  for (Job& job : jobs) {
    ExitCode one = kInputWrong;
    if (job.errors.empty()) {
      one = plan_and_add(std::move(job.definition), job.file, options, job.out, results);
    } else {
      results.push_back({{"case", job.file}, {"status", "wrong input"}, {"reason", errors_text(job.errors)}});
    }
    if (code == kDone || one == kInputWrong) code = one;
    if (InterruptGuard::interrupted()) break;  // the cases that follow, too, are not wanted any more
  }
  if (jobs.size() > 1) summarise(jobs, results, options);
  if (options.common.json)
    print(document_text(jobs.size() == 1 ? results[0] : json{{"cases", results}}), true);
  return code;
}

}  // namespace

void add_plan(CLI::App& program, Action& action) {
  add_verb<PlanVerbOptions>(
      program, action, "plan",
      "the main job: finds a better draping sequence and compares it with the uniform and the wave baseline",
      [](CLI::App& verb, PlanVerbOptions& options) {
        verb.add_option("CASE", options.files, "case files")->required();
        verb.add_option("--budget", options.budget,
                        "time that each plan may take, as \"10 min\", or its number of evaluations "
                        "(default: the case's optimise.budget)");
        add_cycle(verb, options.cycle);
        verb.add_flag("--resume", options.resume, "continue from the evaluations in the run directory");
      },
      plan_all);
}

}  // namespace drapeplan
