#include "fem/run/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "fem/run/monitor.hpp"
#include "fem/run/move_grips.hpp"
#include "fem/run/stable_step.hpp"
#include "fem/run/workspace.hpp"
#include "fem/terms/contact.hpp"
#include "mapping/error.hpp"

namespace drapeplan {
namespace {

constexpr double kMostSteps = 1e10;   // weeks of run time: a wrong unit or a degenerate mesh, not a plan
constexpr int kLooks = 200;           // per run: 0.5 % of it is lost at most by divergence
constexpr int kTenths = 10;           // at whose ends energies are compared, from the second on
constexpr int kRestInterval = 32;     // steps between two looks at the ply's speed
constexpr double kTimeSlack = 1e-12;  // of the duration: round-off of summed steps

/// The mold is asked vertically, with its slope: a ply that starts inside it would be thrown out.
void refuse_start_in_mold(const Model& model, const State& state) {
  constexpr double kSlack = 0.02;  // of the thickness: round-off, and what a ply's weight sinks in
  const double thickness = model.scene().fabric.thickness;
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    const Jet jet = model.scene().mold->jet(state.position.x[n], state.position.y[n]);
    const double slope = std::min(std::hypot(jet.zx, jet.zy), kSteepestContact);
    const double stretch = std::hypot(1.0, slope);
    const double inside = 0.5 * thickness - (state.position.z[n] - jet.z) / stretch;
    if (inside > kSlack * thickness) {  // false where the mold is not defined
      throw WrongInput(fmt::format(
          "simulate: the flat ply's underside starts {:f} mm below the mold at x = {:f} m, y = {:f} m: "
          "check its place and the start height",
          1e3 * inside, state.position.x[n], state.position.y[n]));
    }
  }
}

/// Where the run stands on the clock of the simulation [s].
struct Clock {
  Clock(const Model& model, const RunRequest& request) {
    const double scaling = model.scene().options.time_scaling;
    end = request.duration > 0 ? request.duration : (request.schedule ? request.schedule->duration() : 0);
    if (!(end > 0)) throw WrongInput("simulate: neither a schedule nor a duration is given");
    if (model.scene().press) {
      const PressTimes times = press_times(*model.scene().press, request.schedule, end);
      end = request.press ? times.end : times.start;
      if (request.press) press = times / scaling;
    }
    end /= scaling;
    pause = request.pause > 0 ? request.pause / scaling : end;
    motion_end = request.schedule ? request.schedule->last_motion() / scaling : 0;
    for (const Grip& grip : model.scene().grips) {
      if (!grip.velocity.isZero()) motion_end = end;
    }
    if (press) motion_end = std::max(motion_end, press->full);
    if (!(end / model.dt() <= kMostSteps))
      throw WrongInput("simulate: the run would need more than 1e10 steps");
  }
  [[nodiscard]] bool ended(const State& state) const { return state.time >= end * (1 - kTimeSlack); }
  /// True from the moment on at which pressing begins.
  [[nodiscard]] bool presses(const State& state) const {
    return press && state.time >= press->start * (1 - kTimeSlack);
  }
  /// Number of equal parts of the run that have passed.
  [[nodiscard]] std::int64_t passed(double time, std::int64_t parts) const {
    return std::int64_t(std::floor(time / end * double(parts) * (1 + kTimeSlack)));
  }
  /// Whether the last step has passed the end of one of so many parts.
  [[nodiscard]] bool crossed(const State& state, std::int64_t parts) const {
    return passed(state.time, parts) > passed(state.time - state.dt_before, parts);
  }
  double end = 0, pause = 0, motion_end = 0;
  std::optional<PressTimes> press;
};

/// The pressure of now; keeps the ply as it is when pressing begins.
void press_ply(const Model& model, const Clock& clock, State& state) {
  if (!clock.presses(state)) return;
  state.pressure = pressure_at(*clock.press, model.scene().press->pressure, state.time);
  if (!state.unpressed_position.x.empty()) return;
  state.unpressed_position = state.position;
  state.unpressed_director = state.director;
  state.unpressed_record = state.record;
}

/// The step from the state's positions to the next: chosen anew every `step_interval` steps, and cut where
/// pressing begins and at the end of the run.
void choose_step(const Model& model, const Clock& clock, State& state, Workspace& work) {
  const FemOptions& options = model.scene().options;
  if (options.step_interval == 0) {
    state.dt = model.dt();
  } else if (state.step % options.step_interval == 0) {
    state.stable_dt = stable_step(model, state, work.step);
    if (model.fibre_inertia()) {
      model.fibre_inertia()->take_directions(state);
      work.inertia.ready = false;
    }
    state.dt = std::min(options.step_safety * state.stable_dt, model.actuator_dt());
    if (state.step == 0) state.dt_before = state.dt;
  }
  const bool press_follows = clock.press && !clock.presses(state);
  state.dt = std::min(state.dt, (press_follows ? clock.press->start : clock.end) - state.time);
}

/// True if the ply has been at rest for long enough, after all commanded motion.
bool at_rest(const Model& model, const Clock& clock, State& state) {
  const RestCriterion& rest = *model.scene().rest;
  if (state.step % kRestInterval == 0) {
    const bool moves = 2 * ply_kinetic_energy(model, state) > model.free_mass() * rest.speed * rest.speed;
    if (moves || state.time < clock.motion_end) state.record.last_motion = state.time;
  }
  return state.time - state.record.last_motion >= rest.hold;
}

State first_state(const Model& model, const RunRequest& request) {
  if (request.from) return *request.from;
  State state = model.flat_state(start_height(model, request.schedule));
  if (model.scene().mold) refuse_start_in_mold(model, state);
  return state;
}

std::optional<Snapshot> unpressed_snapshot(const Model& model, const State& state) {
  if (state.unpressed_position.x.empty()) return std::nullopt;
  State before = model.flat_state(0);
  before.position = state.unpressed_position;
  before.director = state.unpressed_director;
  return take_snapshot(model, before, RigDrive{});
}

/// Hands out snapshots at instants that cut the run into equal parts, its start and its end included.
class Observer {
 public:
  /// @param see  may be null: nothing is looked at.
  Observer(int instants, const std::function<void(const Snapshot&)>& see, const Clock& clock,
           const State& first)
      : count_(see ? instants : 0), spans_(std::max(count_ - 1, 1)), see_(see), clock_(clock) {
    next_ = first.step == 0 ? 0 : clock.passed(first.time, spans_) + 1;
  }
  void look(const Model& model, const State& state, const RigDrive& drive) {
    if (next_ >= count_ || clock_.passed(state.time, spans_) < next_) return;
    see_(take_snapshot(model, state, drive));
    ++next_;
  }
  /// At the end of the run.
  void close(const Snapshot& last) const {
    if (next_ < count_) see_(last);
  }

 private:
  int count_, spans_;
  std::int64_t next_;
  const std::function<void(const Snapshot&)>& see_;
  const Clock& clock_;
};

/// Why a run ended, where nothing that was seen said it.
/// @param links_kept  interlinks had their length at every step.
void say_why(const Clock& clock, bool rests, bool links_kept, const State& state, RunSummary& summary) {
  if (summary.message.empty() && !std::isfinite(state.time)) {
    summary.status = RunStatus::diverged;
    summary.message = fmt::format(
        "the stable step is not finite: the steps before were unstable; after step {}", state.step);
  }
  if (!links_kept && summary.status == RunStatus::done) {
    summary.status = RunStatus::diverged;
    summary.message = fmt::format(
        "interlinks could not be kept at their length: pads are too fast, or the step is unstable; seen at "
        "step {}, t = {:f} s",
        state.step, state.time);
  }
  if (!summary.message.empty()) return;
  const bool paused = !rests && !clock.ended(state);
  summary.message = rests ? "the ply is at rest" : paused ? "paused, to be continued" : "the time is over";
  if (paused) summary.status = RunStatus::paused;
}

}  // namespace

double start_height(const Model& model, const Schedule* schedule) {
  if (!model.rig()) return model.scene().start_height;
  if (schedule == nullptr) throw WrongInput("simulate: a rig needs a schedule");
  model.rig()->check(*schedule);
  return schedule->paths.front().front().z - model.scene().rig->joint_offset;
}

RunResult simulate(const Model& model, const RunRequest& request) {
  const auto wall = std::chrono::steady_clock::now();
  const Clock clock(model, request);
  const RigDrive drive{request.schedule, model.scene().options.time_scaling};
  RunResult result;
  RunSummary& summary = result.summary;
  summary.parts = model.summary_parts();
  State& state = result.state;
  state = first_state(model, request);
  const std::int64_t first_step = state.step;
  const std::int64_t last_step =
      request.steps > 0 ? first_step + request.steps : std::numeric_limits<std::int64_t>::max();
  std::array observers{Observer(request.frames, request.observe, clock, state),
                       Observer(request.samples, request.sample, clock, state)};
  Workspace work(model);
  Monitor monitor(model, drive);
  bool running = true, rests = false;
  while (running && !rests && !clock.ended(state) && state.time < clock.pause && state.step < last_step) {
    for (Observer& observer : observers) observer.look(model, state, drive);
    if (model.rig()) model.rig()->let_go(state, drive);
    if (clock.press) press_ply(model, clock, state);
    choose_step(model, clock, state, work);
    compute_forces(model, state, work);
    kick_nodes(model, state, work);
    if (model.rig()) kick_pads(model, state, drive, work);
    if (!model.scene().grips.empty()) move_grips(model, state, work);
    book_work(model, state, work);
    drift_nodes(model, state);
    if (model.rig()) model.rig()->drift(state);
    advance_clock(state);

    if (clock.crossed(state, kLooks)) running = monitor.look(state, summary) && work.rig.converged;
    if (clock.crossed(state, kTenths) && clock.passed(state.time, kTenths) > 1)
      monitor.compare_energies(state);
    if (model.scene().rest) rests = at_rest(model, clock, state);
  }

  result.final = take_snapshot(model, state, drive);
  result.unpressed = unpressed_snapshot(model, state);
  if (running) monitor.close(state, summary);
  if (running && clock.ended(state)) {
    for (const Observer& observer : observers) observer.close(result.final);
  }
  say_why(clock, rests, work.rig.converged, state, summary);
  summary.steps = state.step;
  summary.dt = state.time / double(std::max<std::int64_t>(state.step, 1));
  summary.simulated_time = state.time;
  summary.state_hash = hash_state(state, model.node_count());
  summary.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  summary.element_updates_per_second = double(state.step - first_step) * model.scene().mesh.element_count() /
                                       std::max(summary.wall_seconds, 1e-9);
  return result;
}

}  // namespace drapeplan
