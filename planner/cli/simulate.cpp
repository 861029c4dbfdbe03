// simulate: one FE run, with or without grippers.
#include <fmt/format.h>

#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "fem/run/monitor.hpp"
#include "fem/run/stable_step.hpp"
#include "fem/run/state_file.hpp"
#include "planner/base/quantity.hpp"
#include "planner/base/text.hpp"
#include "planner/cli/cli.hpp"
#include "planner/drape/problem.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/drape/schedule_file.hpp"
#include "planner/report/run_files.hpp"
#include "planner/report/vtu.hpp"

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

/// Reads what --restart and --pause say. @throws std::invalid_argument with the reason.
PartOfRun part_of_run(const SimulateOptions& options, const Model& model) {
  PartOfRun part;
  if (!options.pause.empty()) {
    std::string fault;
    const std::optional<double> time = parse_quantity(options.pause, Dimension::time, fault);
    if (!time || !(*time > 0)) throw std::invalid_argument("--pause: " + (time ? "must be > 0" : fault));
    if (options.save.empty()) throw std::invalid_argument("--pause: needs --save FILE, or the run is lost");
    part.pause = *time;
  }
  if (options.restart.empty()) return part;
  StateReading reading = load_state(options.restart, model);
  if (!reading.value) throw std::invalid_argument("--restart: " + reading.error);
  part.from = std::move(reading.value);
  return part;
}

/// Saves the state where --save says, and adds the stable step at it: as estimated, and the true one.
void finish_run(const SimulateOptions& options, const Model& model, const RunResult& run, json& result) {
  if (!options.save.empty()) save_state(options.save, model, run.state);
  if (run.summary.status == RunStatus::diverged) return;
  StepScratch scratch(model);
  State state = run.state;
  const double estimate = stable_step(model, state, scratch), limit = true_stable_step(model, run.state);
  result["stable_step"] = {
      {"estimate", finite(estimate)}, {"true", finite(limit)}, {"share", finite(estimate / limit)}};
}

std::string summary_text(const RunSummary& summary, int nodes) {
  char text[300];
  std::snprintf(text, sizeof text,
                "%s: %lld steps of %.3g us on %d nodes in %.1f s (%.1f million element updates per "
                "second)\nenergy [J]:",
                summary.message.c_str(), static_cast<long long>(summary.steps), 1e6 * summary.dt, nodes,
                summary.wall_seconds, 1e-6 * summary.element_updates_per_second);
  std::string lines = text;
  for_each_energy(summary, [&](const std::string& key, double value, bool SummaryParts::*part) {
    if (key == "largest" || key == "balance_error" || (part != nullptr && !(summary.parts.*part))) return;
    std::snprintf(text, sizeof text, " %s %.4g,", key.c_str(), value);
    lines += text;
  });
  std::snprintf(text, sizeof text,
                " hourglass at most %.2f %% of internal; books close to %.1e of the largest\nstate hash %s\n",
                1e2 * summary.largest_hourglass_share, summary.energy.balance_error,
                hex(summary.state_hash).c_str());
  return lines + text;
}

void print_terms(const Model& model, const CommonOptions& options) {
  if (!options.quiet) std::cerr << "terms: " << terms_line(model) << '\n';
}

/// Displacements of the named points, of the node nearest to each; displacements and forces of the grips.
json probes_json(const Case& definition, const Model& model, const Snapshot& start, const Snapshot& end) {
  json probes = json::object();
  for (const Probe& probe : definition.probes) {
    const auto& rest = model.scene().mesh.rest;
    size_t nearest = 0;
    for (size_t n = 1; n < rest.size(); ++n) {
      if ((rest[n] - probe.place).norm() < (rest[nearest] - probe.place).norm()) nearest = n;
    }
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

/// A case without grippers: strips and specimens.
int simulate_free(const Case& definition, const SimulateOptions& options) {
  const Model model(scene_of(definition, definition.fidelities.at(options.fidelity)));
  const PartOfRun part = part_of_run(options, model);
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
  finish_run(options, model, run, result);
  result["terms"] = model.term_names();
  json probes = json::object();
  if (!definition.probes.empty() || !definition.grips.empty()) {
    const Snapshot start = take_snapshot(model, model.flat_state(definition.start_height), RigDrive{});
    result["probes"] = probes = probes_json(definition, model, start, run.final);
  }
  std::string text = summary_text(run.summary, model.node_count());
  for (const auto& [name, probe] : probes.items()) {
    const auto u = probe["displacement"];
    char line[200];
    std::snprintf(line, sizeof line, "%s moved by (%.3f, %.3f, %.3f) mm\n", name.c_str(),
                  1e3 * u[0].get<double>(), 1e3 * u[1].get<double>(), 1e3 * u[2].get<double>());
    text += line;
    if (!probe.contains("force")) continue;
    const auto f = probe["force"];
    std::snprintf(line, sizeof line, "%s pulls with (%.3f, %.3f, %.3f) N\n", name.c_str(), f[0].get<double>(),
                  f[1].get<double>(), f[2].get<double>());
    text += line;
  }
  const int code = deliver(result, text, options.common, &definition);
  if (code == kDone && !options.common.out.empty()) {
    write_frames(options.common.out, "ply", model.scene().mesh, frames,
                 definition.mold ? &*definition.mold : nullptr, definition.material.thickness);
  }
  return run.summary.status != RunStatus::diverged ? code : kNotFinished;
}

/// The schedule by name or from a file; prints errors and returns nothing if the file is wrong.
std::optional<Schedule> schedule_of(const DrapeProblem& problem, const std::string& name) {
  if (name == "uniform") return to_schedule(problem.frame(), uniform_strokes(problem.frame()));
  if (name == "wave") return to_schedule(problem.frame(), wave_strokes(problem.frame()));
  if (std::filesystem::is_directory(name)) {
    std::cerr << name << ": is a folder; a schedule is uniform, wave or a file like schedule.json\n";
    return std::nullopt;
  }
  const RigOptions& rig = *problem.definition().grippers;
  ScheduleReading reading = read_schedule(name, rig);
  constexpr double kRounding = 1e-3;  // knots are rounded: a path at the limit may exceed it by as much
  if (reading.errors.empty() && reading.value.largest_velocity() > rig.max_velocity * (1 + kRounding)) {
    std::cerr << name << ": moves at up to " << reading.value.largest_velocity()
              << " m/s, more than grippers.max_velocity (" << rig.max_velocity << " m/s)\n";
    return std::nullopt;
  }
  if (reading.errors.empty()) return std::move(reading.value);
  print_errors(reading.errors);
  return std::nullopt;
}

std::string score_line(const Drape& drape) {
  const Score& score = drape.score;
  if (!score.valid) return "no score: " + score.reason + "\n";
  return fmt::format("{}\npenetration {:.3f} mm; kinetic over internal energy at most {:.2g}\n",
                     score_text(score), 1e3 * drape.run.summary.largest_penetration,
                     drape.run.summary.largest_kinetic_ratio);
}

int simulate_drape(Case definition, const SimulateOptions& options) {
  const DrapeProblem problem(std::move(definition));
  print_warnings(map_warnings(problem.definition(), problem.mapping()), options.common);
  const std::optional<Schedule> schedule = schedule_of(problem, options.schedule);
  if (!schedule) return kInputWrong;
  const bool files = !options.common.out.empty();
  const Model& model = problem.model(options.fidelity);
  const PartOfRun part = part_of_run(options, model);
  print_terms(model, options.common);
  const Drape drape = problem.run(*schedule, options.fidelity, files ? options.frames : 0,
                                  {part.from ? &*part.from : nullptr, part.pause});
  json result = summary_json(drape.run.summary);
  finish_run(options, model, drape.run, result);
  result["score"] = score_json(drape.score);
  result["terms"] = model.term_names();
  const std::string text = summary_text(drape.run.summary, model.node_count()) + score_line(drape);
  const int code = deliver(result, text, options.common, &problem.definition());
  if (code == kDone && files) {
    const std::filesystem::path folder(options.common.out);
    const Case& resolved = problem.definition();
    write_frames(folder, "ply", model.scene().mesh, drape.frames, &*resolved.mold,
                 resolved.material.thickness);
    write_mold_vtu(folder / "mold.vtu", *resolved.mold);
    write_text(folder / "drape.svg",
               drape_picture({drape_panel(problem, drape, options.fidelity, options.schedule)},
                             resolved.mold->extent()));
    write_schedule(folder / "schedule.json", *schedule, *resolved.grippers);
    write_schedule_csv(folder / "schedule.csv", *schedule, *resolved.grippers);
  }
  return drape.score.valid || drape.run.summary.status == RunStatus::paused ? code : kNotFinished;
}

int run_simulate(const SimulateOptions& options) {
  std::optional<Case> definition = load_case(options.file, options.common, {"material"});
  if (!definition) return kInputWrong;
  if (!options.common.out.empty() &&
      std::filesystem::exists(std::filesystem::path(options.common.out) / "evaluations.jsonl")) {
    std::cerr << options.common.out
              << ": --out holds a plan, whose schedule would be overwritten; choose another folder\n";
    return kInputWrong;
  }
  if (definition->fidelities.count(options.fidelity) == 0) {
    std::cerr << options.file << ": /fidelities: there is no fidelity \"" << options.fidelity
              << "\"; there are";
    for (const auto& entry : definition->fidelities) std::cerr << ' ' << entry.first;
    std::cerr << '\n';
    return kInputWrong;
  }
  if (!definition->grippers && !(definition->duration > 0)) {
    std::cerr << options.file << ": /duration: a case without grippers needs a duration, e.g. \"2 s\"\n";
    return kInputWrong;
  }
  try {
    return definition->grippers ? simulate_drape(std::move(*definition), options)
                                : simulate_free(*definition, options);
  } catch (const std::invalid_argument& error) {
    std::cerr << options.file << ": " << error.what() << '\n';
    return kInputWrong;
  } catch (const std::runtime_error& error) {
    std::cerr << options.file << ": not finished: " << error.what() << '\n';
    return kNotFinished;
  } catch (const std::domain_error& error) {
    std::cerr << options.file << ": the ply cannot be mapped or reached: " << error.what() << '\n';
    return kNotFinished;
  }
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
