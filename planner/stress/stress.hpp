// Scenes pushed to and past their limits, and what became of each: right, refused, stopped, or nonsense.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fem/run/simulate.hpp"

namespace drapeplan {

/// Silent nonsense is the only failure.
enum class Verdict {
  right,    ///< the run ended and everything that must hold does
  refused,  ///< with a reason, before the run
  stopped,  ///< with a reason, by what watches the run
  wrong,    ///< ended without a word, and something does not hold; or refused or stopped where it must not be
};
const char* verdict_name(Verdict verdict);

/// One figure and the range in which it is right; NaN never is.
struct StressCheck {
  std::string what;  ///< with its unit
  double value = 0, least = 0, most = 0;
  [[nodiscard]] bool holds() const { return value >= least && value <= most; }
  [[nodiscard]] std::string text() const;
};

/// `value` is `expected` but for a share of it.
StressCheck near(std::string what, double value, double expected, double share);
StressCheck at_most(std::string what, double value, double most);

/// What a scene plays. A word of warning that the user would read counts as one.
struct StressSetup {
  Scene scene;
  std::optional<Schedule> schedule;  ///< with a rig
  double duration = 0;               ///< without one [s]
  std::vector<std::string> warnings = {};
};

/// A run that has ended.
struct StressRun {
  const StressSetup& setup;
  const Model& model;
  const RunResult& result;
  const std::vector<Snapshot>& frames;  ///< at every tenth, the start included
};

struct StressScene {
  std::string group, name;
  /// @throws std::exception with the reason if the scene is refused.
  std::function<StressSetup()> build;
  /// What right means for this scene, beside what holds for all (see stress.cpp); may be empty.
  std::function<std::vector<StressCheck>(const StressRun&)> judge = nullptr;
  /// Acceptable beside `right`, with a word of the reason that must be given; empty: right or nothing.
  Verdict otherwise = Verdict::right;
  std::string says = {};
  bool rests = true;             ///< ends at rest: nothing may drift any more
  bool fast = false;             ///< belongs to the subset that tests run
  bool bisect = false;           ///< look for the limit of the step by runs
  double most_strain = 0.05;     ///< of fibres
  double most_shortening = 0.1;  ///< of fibres: folds finer than the mesh
  /// Energy that damping, friction or contact seem to give, over the largest.
  double most_given = 1e-3;
  double most_drift = 1e-5;    ///< r.m.s. over the last tenth, where it rests [m]
  double most_balance = 1e-9;  ///< of the largest energy
};

struct StressOutcome {
  std::string group, name;
  Verdict verdict = Verdict::wrong;
  std::string reason = {};  ///< of what is not right; else what was measured
  std::vector<StressCheck> checks = {};
  std::optional<RunSummary> summary = {};                     ///< if there was a run
  std::optional<double> drift = {};                           ///< [m]
  std::optional<double> estimated_step = {}, true_step = {};  ///< at the end [s]
  std::optional<double> limit_over_estimate = {};             ///< by bisection of runs
  int elements = 0;
  double wall_seconds = 0;
};

/// All scenes, by group.
std::vector<StressScene> stress_scenes();

/// Plays and judges one scene; never throws.
StressOutcome play_stress(const StressScene& scene);

/// The outcomes as JSON; as a table for programs and one for people.
nlohmann::json stress_json(const std::vector<StressOutcome>& outcomes);
std::string stress_csv(const std::vector<StressOutcome>& outcomes);
std::string stress_markdown(const std::vector<StressOutcome>& outcomes);

}  // namespace drapeplan
