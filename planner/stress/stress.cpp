#include "planner/stress/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include "fem/run/stable_step.hpp"
#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

/// Share of the largest energy by which work that can only be taken may seem to be given, and by which the
/// ply may hold more than it took: booked and stored work differ by the square of the step, below 1e-4.
constexpr double kGiven = 1e-3;
constexpr double kLinkError = 1e-7;  // [m]: constraints hold to 1e-12 of the spacing, but for round-off

/// R.m.s. distance of the nodes of two instants [m].
double apart(const Snapshot& a, const Snapshot& b) {
  double sum = 0;
  for (size_t n = 0; n < a.position.size(); ++n) sum += (a.position[n] - b.position[n]).squaredNorm();
  return std::sqrt(sum / double(a.position.size()));
}

double drift_of(const StressRun& run) {
  return run.frames.size() > 1 ? apart(run.frames[run.frames.size() - 2], run.frames.back())
                               : std::numeric_limits<double>::quiet_NaN();
}

/// What holds for every run that ends.
std::vector<StressCheck> common_checks(const StressScene& scene, const StressRun& run) {
  const RunSummary& summary = run.result.summary;
  const RunRecord& record = run.result.state.record;
  const double largest = std::max(summary.energy.largest, 1e-300);
  std::vector<StressCheck> checks{
      at_most("balance", summary.energy.balance_error, scene.most_balance),
      at_most("fibre strain", record.fibre_strain, scene.most_strain),
      at_most("fibre shortening", record.fibre_compression, scene.most_shortening)};
  // What nothing can give, over the largest energy.
  const Energies& e = summary.energy;
  const double given = -std::min({e.damping, e.friction, e.contact, e.internal, 0.0}) / largest;
  checks.push_back(at_most("energy given by what only takes", given, scene.most_given));
  const Fabric& fabric = run.setup.scene.fabric;
  if (!(run.setup.scene.options.rates && fabric.rate_dependent())) {
    const ShellEnergy stored = run.model.shell().stored_energy(run.result.state);
    checks.push_back(at_most("energy stored but never taken",
                             (stored.fabric + stored.hourglass - e.internal) / largest, scene.most_given));
  }
  if (run.setup.scene.mold)
    checks.push_back(
        at_most("penetration over thickness", summary.largest_penetration / fabric.thickness, 1));
  if (run.setup.scene.rig)
    checks.push_back(at_most("error of interlinks [m]", summary.largest_link_error, kLinkError));
  double size = 0;
  for (const Eigen::Vector3d& x : run.result.final.position) size += x.squaredNorm();
  checks.push_back(at_most("squares of places", size, 1e6));  // not finite fails
  if (scene.rests) checks.push_back(at_most("drift [m]", drift_of(run), scene.most_drift));
  return checks;
}

/// Stable steps at the last state.
void measure_steps(const Model& model, const RunResult& run, StressOutcome& outcome) {
  StepScratch scratch(model);
  State state = run.state;
  outcome.estimated_step = stable_step(model, state, scratch);
  outcome.true_step = true_stable_step(model, run.state);
}

/// True if a run with this share of the estimated step stays bounded.
bool stays_stable(const StressSetup& setup, double share) {
  StressSetup changed = setup;
  changed.scene.options.step_safety = share;
  const Model model(changed.scene);
  const RunResult run = simulate(model, request_of(changed));
  const Energies& e = run.summary.energy;
  const double given = -std::min({e.damping, e.friction, e.contact, e.internal, 0.0});
  return run.summary.status == RunStatus::done && given <= kGiven * std::max(e.largest, 1e-300);
}

/// Largest share of the estimated step that a run survives.
double step_limit(const StressSetup& setup) {
  constexpr int kRuns = 7;       // to 1 % of the range
  constexpr double kMost = 2.5;  // bounds are sharper than this: below 1.3 in all scenes
  double stable = 0.5, unstable = kMost;
  for (int run = 0; run < kRuns; ++run) {
    const double middle = 0.5 * (stable + unstable);
    (stays_stable(setup, middle) ? stable : unstable) = middle;
  }
  return 0.5 * (stable + unstable);
}

std::string failed_checks(const std::vector<StressCheck>& checks) {
  std::string text;
  for (const StressCheck& check : checks) {
    if (!check.holds()) text += (text.empty() ? "" : "; ") + check.text();
  }
  return text;
}

/// Whether a refusal or a stop was to be expected, and says why.
void accept(const StressScene& scene, Verdict verdict, const std::string& reason, StressOutcome& outcome) {
  outcome.verdict = verdict;
  outcome.reason = reason;
  const bool clear = !reason.empty() && reason.find(scene.says) != std::string::npos;
  if (scene.otherwise == verdict && clear) return;
  outcome.verdict = Verdict::wrong;
  outcome.reason = fmt::format(
      "{}{}: {}", verdict_name(verdict),
      scene.otherwise == verdict ? " without a clear reason" : ", though it can be played", reason);
}

void judge_run(const StressScene& scene, const StressRun& run, StressOutcome& outcome) {
  outcome.checks = common_checks(scene, run);
  std::string words;
  if (scene.judge) {
    for (StressCheck& check : scene.judge(run)) {
      words += (words.empty() ? "" : "; ") + check.text();
      outcome.checks.push_back(std::move(check));
    }
  }
  for (const std::string& warning : run.setup.warnings)
    words += fmt::format("{}warned: {}", words.empty() ? "" : "; ", warning);
  const std::string failed = failed_checks(outcome.checks);
  outcome.verdict = failed.empty() ? Verdict::right : Verdict::wrong;
  outcome.reason = failed.empty() ? words : failed;
}

void play(const StressScene& scene, StressOutcome& outcome) {
  std::optional<StressSetup> setup;
  std::unique_ptr<const Model> model;
  RunResult result;
  std::vector<Snapshot> frames;
  try {
    setup = scene.build();
    model = std::make_unique<const Model>(setup->scene);
    outcome.elements = setup->scene.mesh.element_count();
    RunRequest request = request_of(*setup);
    constexpr int kTenths = 11;  // frames
    request.frames = kTenths;
    request.observe = [&frames](const Snapshot& frame) { frames.push_back(frame); };
    result = simulate(*model, request);
  } catch (const std::exception& error) {
    return accept(scene, Verdict::refused, error.what(), outcome);
  }
  outcome.summary = result.summary;
  if (result.summary.status == RunStatus::diverged)
    return accept(scene, Verdict::stopped, result.summary.message, outcome);
  const StressRun run{*setup, *model, result, frames};
  if (scene.rests) outcome.drift = drift_of(run);
  judge_run(scene, run, outcome);
  constexpr int kMeasurable = 10000;  // elements: hundreds of forces and vectors of all nodes
  if (outcome.elements <= kMeasurable) measure_steps(*model, result, outcome);
  if (scene.bisect) outcome.limit_over_estimate = step_limit(*setup);
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  constexpr const char* kNames[] = {"right", "refused", "stopped", "wrong"};
  return kNames[size_t(verdict)];
}

std::string StressCheck::text() const {
  if (least == -kForever) return fmt::format("{} {:.4g}, at most {:.4g}", what, value, most);
  return fmt::format("{} {:.6g}, right: {:.6g} +- {:.2g}", what, value, 0.5 * (least + most),
                     0.5 * (most - least));
}

StressCheck near(std::string what, double value, double expected, double share) {
  const double slack = share * std::abs(expected);
  return {std::move(what), value, expected - slack, expected + slack};
}

StressCheck at_most(std::string what, double value, double most) {
  return {std::move(what), value, -kForever, most};
}

StressOutcome play_stress(const StressScene& scene) {
  const auto start = std::chrono::steady_clock::now();
  StressOutcome outcome{scene.group, scene.name};
  try {
    play(scene, outcome);
  } catch (const std::exception& error) {
    outcome.verdict = Verdict::wrong;
    outcome.reason = fmt::format("the judge failed: {}", error.what());
  }
  outcome.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

}  // namespace drapeplan
