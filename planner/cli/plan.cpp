// plan: the main job, for one or many case files.
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "planner/base/json_text.hpp"
#include "planner/base/text.hpp"
#include "planner/cli/cli.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/report/run_files.hpp"
#include "planner/search/plan.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

struct PlanVerbOptions {
  CommonOptions common;
  std::vector<std::string> files;
  bool resume = false;
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
    std::fprintf(stderr, "  %4d/%d  %-8s best %8.3f", progress.done, progress.planned, progress.stage.c_str(),
                 progress.best);
    if (std::isfinite(progress.seconds_left))
      std::fprintf(stderr, "   about %.0f s left", progress.seconds_left);
    std::fputc('\n', stderr);
  }

 private:
  static constexpr int kSeconds = 5;
  std::chrono::steady_clock::time_point shown_{};
  std::string stage_;
};

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
  out["score"] = score_json(drape.score);
  return out;
}

json plan_json(const DrapeProblem& problem, const PlanResult& result) {
  const StagedResult& search = result.search;
  json reach{{"floor_max", finite(problem.reach().floor_max)},
             {"floor_rms", finite(problem.reach().floor_rms)},
             {"link_violation", finite(problem.reach().link_violation)},
             {"status", problem.reach().status},
             {"meaning", explain_reach(problem.reach_problem(), problem.reach())}};
  return {
      {"case", problem.definition().name},
      {"terms", problem.model(kReport).term_names()},
      {"reach", reach},
      {"map",
       {{"max_shear_deg", problem.mapping().max_shear_deg},
        {"mean_shear_deg", problem.mapping().mean_shear_deg}}},
      {"baselines", {{"uniform", score_json(result.uniform.score)}, {"wave", score_json(result.wave.score)}}},
      {"best",
       {{"score", score_json(result.best.score)},
        {"schedule", "schedule.json"},
        {"candidate", search.best.name}}},
      {"runs",
       {{"uniform", drape_json(result.uniform)},
        {"wave", drape_json(result.wave)},
        {"best", drape_json(result.best)}}},
      {"beats_baselines", search.beats_baselines},
      {"message", search.message},
      {"evaluations", search.evaluations},
      {"failed_evaluations", search.failed_evaluations},
      {"wall_seconds", result.wall_seconds},
      {"history", history_json(search)}};
}

struct PlannedCase {
  json result;
  bool valid = false;  ///< at least the best drape could be simulated
};

/// Plans one case into its folder; throws what went wrong.
PlannedCase plan_case(Case definition, const PlanVerbOptions& options, const std::filesystem::path& folder) {
  const bool talk = !options.common.quiet;
  const std::string name = definition.name;
  const DrapeProblem problem(std::move(definition));
  for (const std::string& fidelity : plan_fidelities(problem.definition()))
    static_cast<void>(problem.model(fidelity));  // what cannot be built is found before anything is written
  if (talk) {
    std::cerr << name << ": mapped, shear at most " << problem.mapping().max_shear_deg
              << " deg\n  terms: " << terms_line(problem.model(kReport))
              << "\n  reach: " << explain_reach(problem.reach_problem(), problem.reach()) << '\n';
  }
  print_warnings(map_warnings(problem.definition(), problem.mapping()), options.common);
  std::filesystem::create_directories(folder);
  write_text(folder / "resolved.json", dump_json(resolved_case(problem.definition()), 2) + "\n");
  ProgressLine line;
  const PlanResult result =
      plan(problem, {folder, options.resume, options.common.threads}, [&](const Progress& progress) {
        if (talk) line(progress);
      });
  if (result.best.score.valid)
    write_plan(folder, problem, result);  // no schedule for a robot from failed runs
  const json out = plan_json(problem, result);
  write_text(folder / "result.json", dump_json(out, 2) + "\n");
  if (!options.common.json && talk) {
    std::cout << '\n' << comparison_table(problem, result) << '\n' << result.search.message << '\n';
    std::cout << result.search.evaluations << " evaluations (" << result.search.failed_evaluations
              << " failed) in " << std::llround(result.wall_seconds)
              << " s; report: " << (folder / "report.html").string() << std::endl;
  }
  return {out, result.best.score.valid};
}

/// A run directory per case: --out itself for a single case, else a folder below it by the case file's name.
std::vector<std::filesystem::path> run_folders(const PlanVerbOptions& options) {
  const std::filesystem::path root = options.common.out.empty() ? "out" : options.common.out;
  if (options.files.size() == 1 && !options.common.out.empty()) return {root};
  std::vector<std::filesystem::path> folders;
  for (const std::string& file : options.files) folders.push_back(root / std::filesystem::path(file).stem());
  return folders;
}

/// Two cases in one folder would overwrite each other: prints an error for each such pair.
bool share_a_folder(const std::vector<std::string>& files,
                    const std::vector<std::filesystem::path>& folders) {
  std::map<std::filesystem::path, std::string> owner;
  bool shared = false;
  for (size_t k = 0; k < files.size(); ++k) {
    const auto [found, fresh] = owner.try_emplace(folders[k], files[k]);
    if (fresh) continue;
    std::cerr << files[k] << ": would be planned in the folder of " << found->second << ", "
              << folders[k].string() << "; plan them in two calls with different --out, or rename one\n";
    shared = true;
  }
  return shared;
}

/// Plans one case and adds its result to the list: of a case that could not be planned, its name and why.
ExitCode plan_and_add(Case definition, const std::string& file, const PlanVerbOptions& options,
                      const std::filesystem::path& folder, json& results) {
  const std::string name = definition.name;
  const auto failed = [&](const std::string& reason) {
    std::cerr << file << ": " << reason << '\n';
    results.push_back({{"case", name}, {"status", "not finished"}, {"reason", reason}});
  };
  try {
    PlannedCase planned = plan_case(std::move(definition), options, folder);
    results.push_back(std::move(planned.result));
    if (!planned.valid) std::cerr << file << ": no drape could be simulated to its end\n";
    return planned.valid ? kDone : kNotFinished;
  } catch (const std::invalid_argument& error) {
    failed(error.what());
    return kInputWrong;
  } catch (const std::exception& error) {
    const bool begun = std::filesystem::exists(folder);
    failed("not finished: " + std::string(error.what()) +
           (begun ? "; what was done is kept in " + folder.string() : ""));
    return kNotFinished;
  }
}

int plan_all(const PlanVerbOptions& options) {
  std::vector<Case> cases;
  const std::vector<std::filesystem::path> folders = run_folders(options);
  bool wrong = share_a_folder(options.files, folders);
  for (const std::string& file : options.files) {
    std::optional<Case> definition = load_case(file, options.common, {"grippers", "material"});
    wrong = wrong || !definition;
    if (definition) cases.push_back(std::move(*definition));
  }
  if (wrong) return kInputWrong;
  json results = json::array();
  int code = kDone;
  for (size_t k = 0; k < cases.size(); ++k) {
    const ExitCode one = plan_and_add(std::move(cases[k]), options.files[k], options, folders[k], results);
    if (code == kDone || one == kInputWrong) code = one;
  }
  if (options.common.json) {
    std::cout << dump_json(results.size() == 1 ? results[0] : json{{"cases", results}}, 2) << '\n';
  }
  return code;
}

}  // namespace

void add_plan(CLI::App& program, Action& action) {
  add_verb<PlanVerbOptions>(
      program, action, "plan",
      "the main job: finds a better draping sequence and compares it with the uniform and the wave baseline",
      [](CLI::App& verb, PlanVerbOptions& options) {
        verb.add_option("CASE", options.files, "case files")->required();
        verb.add_flag("--resume", options.resume, "continue from the evaluations in the run directory");
      },
      plan_all);
}

}  // namespace drapeplan
