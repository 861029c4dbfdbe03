// simulate: one FE run, with or without grippers.
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "fem/run/monitor.hpp"
#include "fem/run/stable_step.hpp"
#include "fem/run/state_file.hpp"
#include "planner/base/quantity.hpp"
#include "planner/base/spelling.hpp"
#include "planner/base/text.hpp"
#include "planner/cli/cli.hpp"
#include "planner/drape/problem.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/report/run_files.hpp"
#include "planner/report/vtu.hpp"
#include "planner/schedule/check.hpp"
#include "planner/schedule/file.hpp"

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
};

/// The part of the run that was asked for; the state is kept here while it is used.
struct PartOfRun {
  std::optional<State> from;
  double pause = 0;
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

void print_terms(const Model& model, const CommonOptions& options) {
  if (!options.quiet) std::cerr << "terms: " << terms_line(model) << '\n';
}

/// Displacements of the named points, of the node nearest to each; displacements and forces of the grips.
json probes_json(const Case& definition, const Model& model, const Snapshot& start, const Snapshot& end) {
  json probes = json::object();
  for (const Probe& probe : definition.probes) {
    const size_t nearest = nearest_node(model, probe.place);
    const Eigen::Vector3d u = end.position[nearest] - start.position[nearest];
    probes[probe.name] = {{"displacement", {u.x(), u.y(), u.z()}}};
  }
  for (size_t k = 0; k < model.scene().grips.size(); ++k) {
    const Grip& grip = model.scene().grips[k];
    const auto node = size_t(grip.nodes.front());
    const Eigen::Vector3d u = end.position[node] - start.position[node], f = end.grip_force[k];
    probes[grip.name] = {{"displacement", {u.x(), u.y(), u.z()}}, {"force", {f.x(), f.y(), f.z()}}};
  }
  return probes;
}

/// What `probes_json` found, for people.
std::string probes_text(const json& probes) {
  std::string text;
  const auto line = [&text](const std::string& what, const json& v, double scale, const char* unit) {
    text += fmt::format("{} ({:.3f}, {:.3f}, {:.3f}) {}\n", what, scale * v[0].get<double>(),
                        scale * v[1].get<double>(), scale * v[2].get<double>(), unit);
  };
  for (const auto& [name, probe] : probes.items()) {
    line(name + " moved by", probe["displacement"], 1e3, "mm");
    if (probe.contains("force")) line(name + " pulls with", probe["force"], 1, "N");
  }
  return text;
}

/// A case without grippers: strips and specimens.
int simulate_free(const Case& definition, const SimulateOptions& options) {
  const Model model = model_of(definition, definition.fidelities.at(options.fidelity));
  const PartOfRun part = part_of_run(options, model, nullptr);
  OutputFolder out = take_folder(options.common, "simulate");
  try_save(options);
  begin_output(out, options.common);
  print_terms(model, options.common);
  std::vector<Snapshot> frames;
  RunRequest request;
  request.duration = definition.duration;
  request.from = part.from ? &*part.from : nullptr;
  request.pause = part.pause;
  request.frames = options.common.out.empty() ? 0 : options.frames;
  request.observe = [&frames](const Snapshot& frame) { frames.push_back(frame); };
  const RunResult run = simulate(model, request);
  json result = summary_json(run.summary);
  add_stable_step(model, run, result);
  result["terms"] = model.term_names();
  std::string text = summary_text(run.summary, model.node_count());
  if (!definition.probes.empty() || !definition.grips.empty()) {
    const Snapshot start = take_snapshot(model, model.flat_state(definition.start_height), RigDrive{});
    result["probes"] = probes_json(definition, model, start, run.final);
    text += probes_text(result["probes"]);
  }
  keep_all([&] { save(options, model, run.state, nullptr); },
           [&] {
             if (!options.common.out.empty()) {
               write_frames(options.common.out, "ply", model.scene().mesh, frames,
                            definition.mold ? &*definition.mold : nullptr, definition.material.thickness);
             }
             deliver(result, text, options.common, &definition);
           });
  return run.summary.status != RunStatus::diverged ? kDone : kNotFinished;
}

/// The schedule by name or from a file. @throws WrongInput with all that is wrong with the file.
Schedule schedule_of(const DrapeProblem& problem, const std::string& name) {
  if (name == "uniform") return to_schedule(problem.frame(), uniform_strokes(problem.frame()));
  if (name == "wave") return to_schedule(problem.frame(), wave_strokes(problem.frame()));
  std::error_code error;
  if (std::filesystem::is_directory(name, error)) {
    throw WrongInput(
        fmt::format("{}: is a folder; a schedule is uniform, wave or a file like schedule.json", name));
  }
  if (!std::filesystem::exists(name, error)) {
    const std::string nearest = nearest_word(name, {"uniform", "wave"});
    throw WrongInput(fmt::format("{}: there is no such file{}", name,
                                 nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
  }
  const RigOptions& rig = *problem.definition().grippers;
  ScheduleReading reading = read_schedule(name, rig);
  if (!reading.errors.empty()) throw InputErrors(reading.errors);
  std::string refusals;
  for (const std::string& refusal : rig_refusals(reading.value, rig))
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
void write_drape(const std::filesystem::path& folder, const DrapeProblem& problem, const Drape& drape,
                 const Schedule& schedule, const SimulateOptions& options) {
  const Case& definition = problem.definition();
  write_frames(folder, "ply", problem.model(options.fidelity).scene().mesh, drape.frames, &*definition.mold,
               definition.material.thickness);
  write_mold_vtu(folder / "mold.vtu", *definition.mold);
  write_text(folder / "drape.svg",
             drape_picture({drape_panel(problem, drape, options.fidelity, options.schedule)},
                           definition.mold->extent()));
  write_schedule(folder / "schedule.json", schedule, *definition.grippers);
  write_schedule_csv(folder / "schedule.csv", schedule, *definition.grippers);
}

int simulate_drape(Case definition, const SimulateOptions& options) {
  const DrapeProblem problem(std::move(definition));
  print_warnings(map_warnings(problem.definition(), problem.mapping()), options.common);
  const Schedule schedule = schedule_of(problem, options.schedule);
  const bool files = !options.common.out.empty();
  const Model& model = problem.model(options.fidelity);
  const PartOfRun part = part_of_run(options, model, &schedule);
  OutputFolder out = take_folder(options.common, "simulate");
  try_save(options);
  begin_output(out, options.common);
  print_terms(model, options.common);
  const Drape drape = problem.run(schedule, options.fidelity, files ? options.frames : 0,
                                  {part.from ? &*part.from : nullptr, part.pause});
  json result = summary_json(drape.run.summary);
  add_stable_step(model, drape.run, result);
  add_scores(drape.score, drape.other, result);
  result["terms"] = model.term_names();
  const std::string text = summary_text(drape.run.summary, model.node_count()) + score_line(drape);
  keep_all([&] { save(options, model, drape.run.state, &schedule); },
           [&] {
             if (files) write_drape(options.common.out, problem, drape, schedule, options);
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
                        "uniform, wave or a schedule file (default: uniform)");
        verb.add_option("--fidelity", options.fidelity, "fidelity of the case (default: report)");
        verb.add_option("--frames", options.frames, "instants written for ParaView (default: 21)")
            ->check(CLI::Range(1, 10000));
        verb.add_option("--pause", options.pause, "stops there, e.g. \"2 s\" of the schedule; needs --save");
        verb.add_option("--save", options.save, "file for the last state, to go on from");
        verb.add_option("--restart", options.restart, "goes on from a saved state, with the same bits");
      },
      run_simulate);
}

}  // namespace drapeplan
