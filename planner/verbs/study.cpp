// study: error against run time.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "planner/base/statistics.hpp"
#include "planner/drape/problem.hpp"
#include "planner/search/plan.hpp"
#include "planner/study/files.hpp"
#include "planner/study/runner.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

struct StudyOptions {
  CommonOptions common;
  std::string file;
  std::vector<std::string> parts;  ///< empty: all that the case can have
  std::vector<std::string> at;
  double refinement = 2.5;
  int schedules = 24;
  int repeats = 3;
  bool resume = false;
  std::string run;  ///< folder of a plan

  [[nodiscard]] bool wants(const char* part) const {
    return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
  }
};

/// A line on stderr every few seconds: what is done, how long still.
class ProgressLine {
 public:
  void operator()(const std::string& what, int done, int of) {
    const auto now = std::chrono::steady_clock::now();
    if (what != what_) what_ = what, start_ = now;
    constexpr int kSeconds = 5;
    if (done < of && now - shown_ < std::chrono::seconds(kSeconds)) return;
    shown_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    std::cerr << fmt::format("  {:4}/{}  {}", done, of, what);
    if (done > 1 && done < of)
      std::cerr << fmt::format("   about {:.0f} s left", seconds / done * (of - done));
    std::cerr << '\n';
  }

 private:
  std::string what_;
  std::chrono::steady_clock::time_point start_, shown_{};
};

/// What every part of a study needs.
struct StudyWork {
  const StudySubject& subject;
  StudyRunner& runner;
  const StudyOptions& options;
};

/// Runs every setting with every schedule. @return by setting, then by schedule.
std::vector<std::vector<StudyRun>> run_all(StudyWork& work, const std::string& what,
                                           const std::vector<Settings>& settings,
                                           const std::vector<Schedule>& schedules) {
  std::vector<StudyJob> jobs;
  for (const Settings& one : settings) {
    for (const Schedule& schedule : schedules) jobs.push_back({one, schedule});
  }
  const std::vector<StudyRun> runs = work.runner.run(what, jobs);
  std::vector<std::vector<StudyRun>> result;
  for (size_t k = 0; k < settings.size(); ++k) {
    const auto first = runs.begin() + std::ptrdiff_t(k * schedules.size());
    result.emplace_back(first, first + std::ptrdiff_t(schedules.size()));
  }
  return result;
}

void sweep(StudyWork& work, Study& study) {
  constexpr int kBaselines = 2;  // uniform and wave
  const std::vector<Schedule> schedules = work.subject.schedules(kBaselines);
  study.points = sweep_points(work.subject);
  std::vector<Settings> settings{study.reference, {}};
  for (const StudyPoint& point : study.points) settings.push_back(point.settings);
  std::vector<std::vector<StudyRun>> runs = run_all(work, "sweep", settings, schedules);
  study.reference_runs = runs[0];
  std::map<std::string, std::vector<StudyRun>> careful;  // the first point of each curve
  for (size_t k = 0; k < study.points.size(); ++k) {
    StudyPoint& point = study.points[k];
    point.runs = std::move(runs[k + 2]);
    const auto [first, fresh] = careful.try_emplace(point.curve, point.runs);
    point.error = study_errors(point.runs, study.reference_runs, study.drapes);
    point.knob_error = study_errors(point.runs, first->second, study.drapes);
    if (!fresh || point.settings.size() != 1 || point.curve.starts_with("fidelity")) continue;
    const auto left = study_errors(runs[1], point.runs, study.drapes);
    if (left.count("relative") > 0) study.base_error[point.curve] = left.at("relative");
  }
}

/// Every fidelity of the case, then every combination of the sweep that is cheap enough to screen with, if
/// the sweep was run; without those that turn the material's rates on or off against the reporting fidelity:
/// other physics, not another accuracy.
std::vector<RankRow> rank_rows(const StudySubject& subject, const std::vector<StudyPoint>& swept) {
  constexpr double kScreens = 0.04;  // of the updates of the reporting fidelity
  double most = std::numeric_limits<double>::infinity();
  for (const StudyPoint& point : swept) {
    if (point.valid() && point.curve == std::string("fidelity ") + kReport)
      most = kScreens * point.mean(&StudyRun::element_updates);
  }
  std::vector<RankRow> named, others;
  const bool rates = subject.changes_of(kReport).count("fem.rates") > 0;
  for (const StudyPoint& point : swept.empty() ? sweep_points(subject) : swept) {
    const std::string fidelity = "fidelity ";
    if ((point.settings.count("fem.rates") > 0) != rates) continue;
    if (point.curve.starts_with(fidelity)) {
      named.push_back({.name = point.curve.substr(fidelity.size()), .settings = point.settings});
    } else if (point.curve == "combination" && (swept.empty() || point.valid()) &&
               point.mean(&StudyRun::element_updates) <= most) {
      others.push_back({.name = "", .settings = point.settings});
    }
  }
  named.insert(named.end(), others.begin(), others.end());
  return named;
}

std::vector<double> objectives(const std::vector<StudyRun>& runs) {
  std::vector<double> values;
  for (const StudyRun& run : runs) values.push_back(run.valid ? run.objective : std::nan(""));
  return values;
}

double median_of(const std::vector<StudyRun>& runs, double StudyRun::*member) {
  std::vector<double> values;
  for (const StudyRun& run : runs) {
    if (run.valid) values.push_back(run.*member);
  }
  return median(values);
}

/// The reference of the ranks is the reporting fidelity: it decides what is claimed.
void rank(StudyWork& work, Study& study) {
  const std::vector<Schedule> schedules = work.subject.schedules(work.options.schedules);
  study.schedules = int(schedules.size());
  study.ranks = rank_rows(work.subject, study.points);
  const Settings reference = work.subject.changes_of(kReport);
  study.rank_reference = "the reporting fidelity";
  std::vector<Settings> settings{reference};
  for (const RankRow& row : study.ranks) settings.push_back(row.settings);
  const std::vector<std::vector<StudyRun>> runs = run_all(work, "ranks", settings, schedules);
  for (size_t k = 0; k < study.ranks.size(); ++k) {
    study.ranks[k].wall_seconds = median_of(runs[k + 1], &StudyRun::wall_seconds);
    study.ranks[k].cpu_seconds = median_of(runs[k + 1], &StudyRun::cpu_seconds);
    study.ranks[k].objectives = objectives(runs[k + 1]);
  }
  rank_against(objectives(runs[0]), study.ranks);
}

void measure_noise(StudyWork& work, Study& study) {
  constexpr int kPoints = 7;
  constexpr double kStep = 1e-3;  // of the family's box: a few milliseconds, far below what a robot can tell
  const std::vector<Schedule> line = work.subject.line_of_schedules(kPoints, kStep);
  std::vector<Settings> settings{{}};
  std::vector<std::string> names{"base"};
  for (const std::string& name : work.subject.fidelities()) {
    const Settings changes = work.subject.changes_of(name);
    if (changes.count("fem.rates") > 0) continue;  // other physics
    names.push_back(name);
    settings.push_back(changes);
  }
  const std::vector<std::vector<StudyRun>> runs = run_all(work, "noise", settings, line);
  for (size_t k = 0; k < runs.size(); ++k) {
    const std::vector<double> values = objectives(runs[k]);
    if (std::any_of(values.begin(), values.end(), [](double value) { return !std::isfinite(value); }))
      continue;
    const NoiseEstimate noise = difference_noise(values);
    study.noise.push_back({names[k], settings[k], kStep, median(values), noise.noise, noise.consistent});
  }
}

/// The search of a run directory of `plan`, which is made now if none is named; beside it, as many evenly
/// spread schedules as are ranked.
void trace_search(StudyWork& work, Study& study, OutputFolder& plan_out) {
  const Case whole = work.subject.whole();
  const std::string fidelity = whole.fidelities.count("search") > 0 ? "search" : kReport;
  std::filesystem::path run = work.options.run;
  if (run.empty()) {
    run = plan_out.path();
    const DrapeProblem problem(whole);
    (void)plan(problem, plan_out, {work.options.resume, work.options.common.threads}, {});
  }
  study.searches.push_back(
      search_trace(read_evaluations((run / kEvaluations).string(), case_hash(whole)), fidelity));
  SearchTrace even{"evenly spread schedules", {}, {}, {}};
  double seconds = 0, best = std::numeric_limits<double>::infinity();
  const std::vector<Schedule> schedules = work.subject.schedules(work.options.schedules);
  const std::vector<StudyRun> spread =
      run_all(work, "search", {work.subject.changes_of(fidelity)}, schedules).front();
  for (const StudyRun& one : spread) {
    seconds += one.wall_seconds;
    if (one.valid) best = std::min(best, one.objective);
    even.evaluations.push_back(double(even.evaluations.size() + 1));
    even.seconds.push_back(seconds);
    even.best.push_back(best);
  }
  study.searches.push_back(even);
}

Study study_case(const StudySubject& subject, StudyRunner& runner, const StudyOptions& options,
                 OutputFolder& plan_out) {
  StudyWork work{subject, runner, options};
  Study study;
  study.case_name = subject.base().name;
  study.drapes = subject.drapes();
  study.at = subject.at();
  study.reference = reference_settings(subject, options.refinement);
  if (options.wants("mapping")) study.mapping = study_mapping(subject, options.repeats);
  if (options.wants("reach")) study.reach = study_reach(subject, options.repeats);
  if (options.wants("sweep")) sweep(work, study);
  if (options.wants("noise") && study.drapes) measure_noise(work, study);
  if (options.wants("ranks") && study.drapes) rank(work, study);
  if (options.wants("search") && study.drapes) trace_search(work, study, plan_out);
  return study;
}

/// The settings of --at, without what the case has anyway. @throws WrongInput with what is wrong with them.
Settings settings_at(const StudyOptions& options) {
  Settings at;
  for (const std::string& text : options.at) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw WrongInput(fmt::format("--at: \"{}\" is not path=value", text));
    at[text.substr(0, equals)] = text.substr(equals + 1);
  }
  CommonOptions changed = options.common;
  changed.overrides.insert(changed.overrides.end(), options.at.begin(), options.at.end());
  static_cast<void>(load_case(options.file, changed, {"material"}));
  return at;
}

/// What is asked for by name must be possible. @throws WrongInput with the first that is not.
void check_parts(const Case& definition, const StudyOptions& options) {
  for (const std::string& part : options.parts) {
    if (part == "mapping" && !definition.mapping)
      throw WrongInput("--part mapping: the case has no section \"mapping\"");
    const bool drapes = part == "ranks" || part == "noise" || part == "reach" || part == "search";
    if (drapes && !definition.grippers)
      throw WrongInput(fmt::format("--part {}: the case has no section \"grippers\"", part));
  }
  if (options.run.empty()) return;
  const std::string log = options.run + "/evaluations.jsonl";
  std::error_code error;
  if (!std::filesystem::is_regular_file(log, error))
    throw WrongInput(fmt::format("--run: {}: there is no such file", log));
  read_evaluations(log, case_hash(definition), {});  // throws for another case's
}

/// The whole study, once all input is known to be good.
int study_into(const std::filesystem::path& folder, const Case& definition, const StudySubject& subject,
               const StudyOptions& options) {
  OutputFolder out(folder, "study", options.resume ? kStudyLog : "");
  OutputFolder plan_out;
  if (options.wants("search") && subject.drapes() && options.run.empty())
    plan_out = OutputFolder(folder / "plan", "plan", options.resume ? kEvaluations : "");
  if (!options.resume) begin_output(out, options.common);
  ProgressLine line;
  StudyRunner runner(subject, {folder / kStudyLog, options.common.threads, options.repeats},
                     [&](const std::string& what, int done, int of) {
                       if (!options.common.quiet) line(what, done, of);
                     });
  if (options.resume)
    begin_output(out, options.common, {kStudyLog, "resolved.json"});  // its log was accepted
  const Study study = study_case(subject, runner, options, plan_out);
  write_study(folder, study);
  CommonOptions common = options.common;
  common.out = folder.string();
  deliver(study_json(study), study_text(study), common, &definition);
  const bool referred =
      study.points.empty() || std::any_of(study.points.begin(), study.points.end(),
                                          [](const StudyPoint& point) { return point.valid(); });
  if (!referred) throw NotFinished("no setting can be compared with the reference");
  return kDone;
}

int run_study(const StudyOptions& options) {
  const Case definition = load_case(options.file, options.common, {"material"});
  check_parts(definition, options);
  const Settings at = settings_at(options);
  std::vector<std::string> overrides = options.common.overrides;
  if (options.common.seed) overrides.push_back(fmt::format("optimise.seed={}", *options.common.seed));
  const std::filesystem::path folder = options.common.out.empty()
                                           ? std::filesystem::path("out") / ("study-" + definition.name)
                                           : std::filesystem::path(options.common.out);
  const StudySubject subject(options.file, overrides, at);
  try {
    return study_into(folder, definition, subject, options);
  } catch (const NotFinished& error) {
    throw NotFinished(fmt::format("{}; what was done is kept in {}", error.what(), folder.string()));
  }
}

}  // namespace

void add_study(CLI::App& program, Action& action) {
  add_verb<StudyOptions>(
      program, action, "study", "error against run time: of settings, fidelities, mapping, reach and search",
      [](CLI::App& verb, StudyOptions& options) {
        verb.add_option("CASE", options.file, "case file")->required();
        verb.add_option("--part", options.parts,
                        "only these: sweep, ranks, noise, mapping, reach, search (repeatable; default: all)")
            ->check(CLI::IsMember({"sweep", "ranks", "noise", "mapping", "reach", "search"}))
            ->expected(1)
            ->take_all()
            ->allow_extra_args(false);
        verb.add_option("--at", options.at,
                        "turns knobs around this value instead of that of `fem` (repeatable)")
            ->type_name("PATH=VALUE")
            ->expected(1)
            ->take_all()
            ->allow_extra_args(false);
        verb.add_option("--refinement", options.refinement,
                        "mesh size of the base over that of the reference (default: 2.5)")
            ->check(CLI::Range(1.01, 20.0));
        verb.add_option("--schedules", options.schedules, "that are ranked (default: 24)")
            ->check(CLI::Range(4, 1000));
        verb.add_option("--repeats", options.repeats, "of short runs; the median time counts (default: 3)")
            ->check(CLI::Range(1, 100));
        verb.add_option("--run", options.run,
                        "run directory of `plan` whose search is shown (default: it is run now)")
            ->type_name("DIR")
            ->check(CLI::ExistingDirectory);
        verb.add_flag("--resume", options.resume,
                      "runs that the folder's study.jsonl holds are not done again");
      },
      run_study);
}

}  // namespace drapeplan
