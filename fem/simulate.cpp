#include "fem/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "fem/monitor.hpp"
#include "fem/workspace.hpp"

namespace drapeplan {
namespace {

constexpr double kMostSteps = 1e10;  // weeks of run time: a wrong unit or a degenerate mesh, not a plan
constexpr int kLooks =
    200;  // times per run at which the monitor looks: 0.5 % of the run is lost at most by divergence

/// Height of the flat ply at the start: all joints stand at the same height.
double start_height(const Model& model, const RunRequest& request) {
  if (!model.rig()) return model.scene().start_height;
  const RigOptions& rig = *model.scene().rig;
  if (!request.schedule) throw std::invalid_argument("simulate: a rig needs a schedule");
  const Schedule& schedule = *request.schedule;
  if (int(schedule.paths.size()) != rig.count()) {
    throw std::invalid_argument("simulate: the schedule has " + std::to_string(schedule.paths.size()) +
                                " grippers, the rig " + std::to_string(rig.count()));
  }
  const double z = schedule.paths.front().front().z;
  for (const auto& path : schedule.paths) {
    if (path.front().z != z) throw std::invalid_argument("simulate: joints must start at one height");
  }
  return z - rig.joint_offset;
}

/// The mold is asked vertically: a flat ply above all heights is outside, whatever the slope.
void refuse_start_in_mold(const Model& model, const State& state) {
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    const double height = model.scene().mold->height(state.x.x[n], state.x.y[n]);
    const double thickness = model.scene().fabric.thickness;
    if (state.x.z[n] < height - thickness) {  // false where the mold is not defined
      throw std::invalid_argument(
          "simulate: the flat ply starts " + std::to_string(1e3 * (height - state.x.z[n])) +
          " mm below the mold at x = " + std::to_string(state.x.x[n]) +
          " m, y = " + std::to_string(state.x.y[n]) + " m: check its place and the start height");
    }
  }
}

}  // namespace

RunResult simulate(const Model& model, const RunRequest& request) {
  const auto clock = std::chrono::steady_clock::now();
  const double dt = model.dt();
  const RigDrive drive{request.schedule, model.scene().options.time_scaling};
  State state = model.flat_state(start_height(model, request));
  const double duration =
      request.duration > 0 ? request.duration : (request.schedule ? request.schedule->duration() : 0);
  if (!(duration > 0)) throw std::invalid_argument("simulate: neither a schedule nor a duration is given");
  if (model.scene().mold) refuse_start_in_mold(model, state);
  const double count = std::ceil(duration / drive.time_scaling / dt);
  if (!(count <= kMostSteps))
    throw std::invalid_argument("simulate: the run would need more than 1e10 steps");
  const auto steps = std::int64_t(count);
  const auto instant = [steps](std::int64_t k, std::int64_t of) { return k * steps / of; };

  RunResult result;
  RigRecord record;
  Workspace work(model);
  Monitor monitor(model);
  std::int64_t look = 1, tenth = 2, frame = 0;
  const std::int64_t frames = request.observe ? request.frames : 0;
  bool running = true;
  while (running && state.step < steps) {
    if (frame < frames && state.step >= instant(frame, std::max<std::int64_t>(frames - 1, 1))) {
      request.observe(take_snapshot(model, state, drive));
      ++frame;
    }
    compute_forces(model, state, work);
    kick_nodes(model, state, work);
    if (model.rig()) kick_pads(model, state, drive, work, record);
    if (!model.scene().grips.empty()) move_grips(model, state, dt, dt, work);
    book_work(model, state, work);
    drift_nodes(model, state);
    if (model.rig()) model.rig()->drift(state, dt);
    state.time = double(++state.step) * dt;

    if (state.step >= instant(look, kLooks)) {
      ++look;
      running = monitor.look(state, result) && record.converged;
      if (state.step >= instant(tenth, 10)) {
        ++tenth;
        monitor.note_kinetic_ratio(state, result);
      }
    }
  }

  RunReport& report = result.report;
  result.final = take_snapshot(model, state, drive);
  if (running) monitor.close(state, result);
  if (running && frame < frames) request.observe(result.final);
  if (!record.converged && report.status == RunStatus::done) {
    report.status = RunStatus::diverged;
    report.message = "interlinks could not be kept at their length";
  }
  if (report.message.empty()) report.message = "the schedule has ended";
  report.steps = state.step;
  report.dt = dt;
  report.simulated_time = state.time;
  report.largest_link_error = record.largest_link_error;
  report.state_hash = hash_state(state, model.node_count());
  report.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  report.element_updates_per_second =
      double(state.step) * model.scene().mesh.element_count() / std::max(report.wall_seconds, 1e-9);
  result.largest_actuator_force = record.largest_force;
  return result;
}

}  // namespace drapeplan
