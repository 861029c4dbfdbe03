// simulate: one FE run, with or without grippers.
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "fem/run/stable_step.hpp"
#include "fem/run/state_file.hpp"
#include "planner/base/quantity.hpp"
#include "planner/base/spelling.hpp"
#include "planner/base/text.hpp"
#include "planner/drape/acceptance.hpp"
#include "planner/drape/problem.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/drape/run_checks.hpp"
#include "planner/report/run_files.hpp"
#include "planner/schedule/check.hpp"
#include "planner/schedule/file.hpp"
#include "planner/schedule/motion.hpp"
#include "planner/schedule/motion_file.hpp"
#include "planner/schedule/robot_files.hpp"
#include "planner/search/plan.hpp"
#include "planner/trust/setting_runs.hpp"
#include "planner/verbs/verbs.hpp"
#include "planner/views/drape_page.hpp"
#include "planner/views/history.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

struct SimulateOptions {
  CommonOptions common;
  std::string file;
  std::string schedule = "uniform";
  std::string fidelity = "report";
  int frames = 21;
  std::string restart, save;  ///< files of states
  std::string pause;          ///< a time, e.g. "2 s"
  std::string cycle;          ///< of the robot's controller
};

/// The part of the run that was asked for; the state is kept here while it is used.
struct PartOfRun {
  std::optional<State> from;
  double pause = 0;
  [[nodiscard]] RunPart request() const { return {.from = from ? &*from : nullptr, .pause = pause}; }
};

/// Reads what --restart and --pause say. @throws WrongInput with the reason.
/// @param schedule  that the rig plays; null without a rig.
PartOfRun part_of_run(const SimulateOptions& options, const Model& model, const Schedule* schedule) {
  PartOfRun part;
  if (!options.pause.empty()) {
    std::string fault;
    const std::optional<double> time = parse_quantity(options.pause, Dimension::time, fault);
    if (!time || !(*time > 0)) throw WrongInput("--pause: " + (time ? "must be > 0" : fault));
    if (options.save.empty()) throw WrongInput("--pause: needs --save FILE, or the run is lost");
    part.pause = *time;
  }
  if (options.restart.empty()) return part;
  StateReading reading = load_state(options.restart, model, schedule);
  if (!reading.value) throw WrongInput("--restart: " + reading.error);
  part.from = std::move(reading.value);
  return part;
}

/// Tries the place of --save, before the first step. @throws WrongInput if no state can, or may, be written
/// there.
void try_save(const SimulateOptions& options) {
  if (options.save.empty()) return;
  const std::filesystem::path file(options.save), folder(options.common.out);
  try_output_file(file, "drapeplan state ", "a saved state");
  std::error_code error;
  const bool beside =
      std::filesystem::equivalent(file.has_parent_path() ? file.parent_path() : ".", folder, error);
  if (beside && (is_result_name(file.filename().string()) || file.filename() == kRunLock))
    throw WrongInput(fmt::format("--save: {}: is the name of another file of --out", options.save));
}

/// Saves the state where --save says.
void save(const SimulateOptions& options, const Model& model, const State& state, const Schedule* schedule) {
  if (!options.save.empty()) save_state(options.save, model, state, schedule);
}

/// Does both, also if the first fails, and then throws what the first threw: one place that cannot be written
/// does not cost what belongs to the other.
void keep_all(const std::function<void()>& first, const std::function<void()>& second) {
  std::exception_ptr thrown;
  try {
    first();
  } catch (...) {
    thrown = std::current_exception();
  }
  second();
  if (thrown) std::rethrow_exception(thrown);
}

/// The stable step at the end: as estimated, and the true one.
void add_stable_step(const Model& model, const RunResult& run, json& result) {
  if (run.summary.status == RunStatus::diverged) return;
  StepScratch scratch(model);
  State state = run.state;
  const double estimate = stable_step(model, state, scratch), limit = true_stable_step(model, run.state);
  result["stable_step"] = {
      {"estimate", finite(estimate)}, {"true", finite(limit)}, {"share", finite(estimate / limit)}};
}

std::string summary_text(const RunSummary& summary, int nodes) {
  std::string text = fmt::format(
      "{}: {} steps of {:.3g} us on {} nodes in {:.1f} s ({:.1f} million element updates per second)\n"
      "energy [J]:",
      summary.message, summary.steps, 1e6 * summary.dt, nodes, summary.wall_seconds,
      1e-6 * summary.element_updates_per_second);
  for_each_energy(summary, [&](const std::string& key, double value, bool SummaryParts::*part) {
    if (key == "largest" || key == "balance_error" || (part != nullptr && !(summary.parts.*part))) return;
    text += fmt::format(" {} {:.4g},", key, value);
  });
  return text +
         fmt::format(
             " hourglass at most {:.2f} % of internal; books close to {:.1e} of the largest\nstate hash {}\n",
             1e2 * summary.largest_hourglass_share, summary.energy.balance_error, hex(summary.state_hash));
}

void print_terms(const Model& model, const Case& definition, const CommonOptions& options) {
  if (options.quiet) return;
  std::cerr << "terms: " << terms_line(model) << '\n';
  if (definition.chooses_fidelities)
    std::cerr << "settings: " << setting_text(model.scene().options)
              << ": from the sizes of the rig; what they are worth is measured by `plan` alone\n";
}

/// What probes and grips ended with, where the case has any.
void add_probes(const Recorder& recorder, json& result) {
  json probes = probes_json(recorder.history());
  if (!probes.empty()) result["probes"] = std::move(probes);
}

Played played_of(const SimulateOptions& options) {
  return {.schedule = options.schedule,
          .fidelity = options.fidelity,
          .frames = options.common.out.empty() ? 0 : options.frames,
          .part = !options.restart.empty() || !options.pause.empty()};
}

/// A case without grippers: strips and specimens.
int simulate_free(const Case& definition, const SimulateOptions& options) {
  const Model model = model_of(definition, definition.fidelities.at(options.fidelity));
  const PartOfRun part = part_of_run(options, model, nullptr);
  OutputFolder out = take_folder(options.common, "simulate");
  try_save(options);
  begin_output(out, options.common);
  print_terms(model, definition, options.common);
  Played played = played_of(options);
  played.schedule.clear();
  const SeenRun seen = play_run(definition, model, played, part.request());
  json result = summary_json(seen.run.summary);
  add_stable_step(model, seen.run, result);
  result["terms"] = model.term_names();
  result["played"] = played_json(played);
  add_probes(seen.recorder, result);
  const std::string text =
      summary_text(seen.run.summary, model.node_count()) + probes_text(seen.recorder.history());
  keep_all([&] { save(options, model, seen.run.state, nullptr); },
           [&] {
             if (out) write_run_page(out.path(), definition, model, seen);
             deliver(result, text, options.common, &definition);
           });
  return seen.run.summary.status != RunStatus::diverged ? kDone : kNotFinished;
}

/// A table has the motion itself. @param schedule  name of a schedule or a file.
PathKind kind_of(const std::string& schedule) {
  return is_motion_file(schedule) ? PathKind::sampled : PathKind::blended;
}

/// The schedule by name or from a file. @throws WrongInput with all that is wrong with the file.
Schedule schedule_of(const DrapeProblem& problem, const std::string& name) {
  if (name == "uniform") return to_schedule(problem.frame(), uniform_strokes(problem.frame()));
  if (name == "wave") return to_schedule(problem.frame(), wave_strokes(problem.frame()));
  std::error_code error;
  if (std::filesystem::is_directory(name, error)) {
    throw WrongInput(fmt::format(
        "{}: is a folder; a schedule is uniform, wave or a file like schedule.json or schedule.csv", name));
  }
  if (!std::filesystem::exists(name, error)) {
    const std::string nearest = nearest_word(name, {"uniform", "wave"});
    throw WrongInput(fmt::format("{}: there is no such file{}", name,
                                 nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
  }
  const RigOptions& rig = *problem.definition().grippers;
  ScheduleReading reading = is_motion_file(name) ? read_motion(name, rig) : read_schedule(name, rig);
  if (!reading.errors.empty()) throw InputErrors(reading.errors);
  if (is_motion_file(name)) level_start(problem.frame().start_xy, reading.value);
  std::string refusals;
  for (const std::string& refusal : rig_refusals(reading.value, rig, kind_of(name)))
    refusals += fmt::format("{}{}: {}", refusals.empty() ? "" : "\n", name, refusal);
  if (!refusals.empty()) throw WrongInput(refusals);
  let_go_pressed(problem.definition().press, reading.value);
  return std::move(reading.value);
}

std::string score_line(const Drape& drape) {
  const Score& score = drape.score;
  if (!score.valid) return fmt::format("no score: {}\n", score.reason);
  const std::string other =
      drape.other ? fmt::format("{}: {}\n", drape.other->label(), score_text(drape.other->score)) : "";
  return fmt::format("{}\n{}penetration {:.3f} mm; kinetic over internal energy at most {:.2g}\n",
                     score_text(score), other, 1e3 * drape.run.summary.largest_penetration,
                     drape.run.summary.largest_kinetic_ratio);
}

/// The files of a drape beside result.json and resolved.json.
void write_drape(const OutputFolder& out, const DrapeProblem& problem, const SeenDrape& seen,
                 const Schedule& schedule, const SimulateOptions& options, const std::string& verdict,
                 const Diagnosis& diagnosis) {
  const Case& definition = problem.definition();
  write_schedule(out.path() / "schedule.json", schedule, *definition.grippers);
  const std::vector<std::string> refusals = write_robot_files(out.path(), schedule, *definition.grippers,
                                                              {.cycle = cycle_of(options.cycle),
                                                               .case_name = definition.name,
                                                               .case_hash = hex(case_hash(definition)),
                                                               .kind = kind_of(options.schedule)});
  if (!refusals.empty())
    print_warnings({"no trajectory for ROS 2 is written, the rig cannot follow: " + refusals.front()},
                   options.common);
  write_drape_page(out.path(), problem, seen, schedule, played_of(options), verdict, diagnosis);
}

int simulate_drape(Case definition, const SimulateOptions& options) {
  const DrapeProblem problem(std::move(definition));
  print_warnings(map_warnings(problem.definition(), problem.mapping()), options.common);
  const Schedule schedule = schedule_of(problem, options.schedule);
  const Model& model = problem.model(options.fidelity);
  const PartOfRun part = part_of_run(options, model, &schedule);
  OutputFolder out = take_folder(options.common, "simulate");
  try_save(options);
  begin_output(out, options.common);
  print_terms(model, problem.definition(), options.common);
  const SeenDrape seen = play_drape(problem, schedule, played_of(options), part.request());
  const Drape& drape = seen.drape;
  json result = summary_json(drape.run.summary);
  add_stable_step(model, drape.run, result);
  add_scores(drape.score, drape.other, result);
  std::string verdict;  // of a run that has ended
  Diagnosis diagnosis;  // needs instants in between
  if (drape.run.summary.status != RunStatus::paused) {
    const Acceptance acceptance = acceptance_of(problem, drape, options.fidelity);
    result["acceptance"] = acceptance_json(acceptance);
    verdict = acceptance_text(acceptance);
    if (out) diagnosis = diagnosis_of(problem, drape, options.fidelity);
    if (!diagnosis.good()) result["diagnosis"] = diagnosis_json(diagnosis, *problem.definition().grippers);
  }
  const std::vector<std::string> warnings = drape_warnings(problem, drape, options.fidelity);
  print_warnings(warnings, options.common);
  result["warnings"] = warnings;
  result["terms"] = model.term_names();
  result["played"] = played_json(played_of(options));
  add_probes(seen.recorder, result);
  const std::string text = summary_text(drape.run.summary, model.node_count()) + score_line(drape) +
                           probes_text(seen.recorder.history()) + verdict + (verdict.empty() ? "" : "\n") +
                           reasons_text(diagnosis, *problem.definition().grippers);
  keep_all([&] { save(options, model, drape.run.state, &schedule); },
           [&] {
             if (out) write_drape(out, problem, seen, schedule, options, verdict, diagnosis);
             deliver(result, text, options.common, &problem.definition());
           });
  return drape.score.valid || drape.run.summary.status == RunStatus::paused ? kDone : kNotFinished;
}

/// What the options ask of the case must be possible. @throws WrongInput with the reason.
void check_options(const Case& definition, const SimulateOptions& options) {
  if (definition.fidelities.count(options.fidelity) == 0) {
    std::vector<std::string> names;
    for (const auto& entry : definition.fidelities) names.push_back(entry.first);
    throw InputErrors({{options.file, 0, "/fidelities",
                        fmt::format("there is no fidelity \"{}\"; there are {}", options.fidelity,
                                    fmt::join(names, " "))}});
  }
  cycle_of(options.cycle);  // refused before the run
  if (!definition.grippers && !(definition.duration > 0)) {
    throw InputErrors(
        {{options.file, 0, "/duration", "a case without grippers needs a duration, e.g. \"2 s\""}});
  }
}

int run_simulate(const SimulateOptions& options) {
  Case definition = load_case(options.file, options.common, {"material"});
  check_options(definition, options);
  return definition.grippers ? simulate_drape(std::move(definition), options)
                             : simulate_free(definition, options);
}

}  // namespace

void add_simulate(CLI::App& program, Action& action) {
  add_verb<SimulateOptions>(
      program, action, "simulate", "one finite-element run of a case",
      [](CLI::App& verb, SimulateOptions& options) {
        verb.add_option("CASE", options.file, "case file")->required();
        verb.add_option("--schedule", options.schedule,
                        "uniform, wave, a schedule file, or a motion as schedule.csv or schedule_wide.csv "
                        "have it (default: uniform)")
            ->type_name("uniform|wave|FILE");
        add_cycle(verb, options.cycle);
        verb.add_option("--fidelity", options.fidelity, "fidelity of the case (default: report)");
        verb.add_option("--frames", options.frames, "instants written for ParaView (default: 21)")
            ->check(CLI::Range(1, 10000));
        verb.add_option("--pause", options.pause, "stops there, e.g. \"2 s\" of the schedule; needs --save")
            ->type_name("TIME");
        verb.add_option("--save", options.save, "file for the last state, to go on from")->type_name("FILE");
        verb.add_option("--restart", options.restart, "goes on from a saved state, with the same bits")
            ->type_name("FILE");
      },
      run_simulate);
}

}  // namespace drapeplan
