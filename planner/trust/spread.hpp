// How a planned sequence does where the plant is a little different from the case.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planner/drape/problem.hpp"
#include "planner/search/batch_evaluate.hpp"
#include "planner/search/evaluation_log.hpp"

namespace drapeplan {

/// What a plant cannot hold better, one at a time: of the friction and of the level of the ply's shear stress
/// as shares, of where and how the rig puts the ply, of the joints above it, of the clock of the schedule as
/// a share.
inline constexpr double kFrictionSpread = 0.2, kShearSpread = 0.5, kTimingSpread = 0.05;
inline constexpr double kPlacementSpread = 0.002, kJointSpread = 0.0005;  // [m]
inline constexpr double kAngleSpreadDeg = 1;

/// One way in which a plant may differ.
struct Disturbance {
  std::string name;                             ///< "friction + 20 %"; empty: none
  std::function<void(Case&, Schedule&)> apply;  ///< to what is simulated; scores stay those of the case
};

/// None, then each up and down. A case without friction has none to be disturbed.
std::vector<Disturbance> disturbances(const Case& definition);

/// The best schedule and the better baseline in the same plant.
struct DisturbedPair {
  std::string disturbance;
  Score best, baseline;
  [[nodiscard]] bool better() const {
    return best.valid && (!baseline.valid || best.objective < baseline.objective);
  }
};

struct PlantSpread {
  std::string fidelity;
  std::vector<DisturbedPair> pairs;  ///< the undisturbed one first
  /// In how many of the disturbed plants the best schedule stays better than the baseline.
  [[nodiscard]] int better() const;
  [[nodiscard]] int plants() const { return int(pairs.size()) - 1; }
};

/// Runs both schedules, as they are commanded, in every disturbed plant, through the log: at the finest
/// fidelity that the time is enough for; nothing where it is enough for none.
/// @param fidelities  to choose from, cheapest first.
/// @throws Interrupted once `stop` says so; what has run is in the log.
std::optional<PlantSpread> spread_of(const DrapeProblem& problem, const Schedule& best,
                                     const Schedule& baseline, const std::vector<std::string>& fidelities,
                                     const SideRuns& runs, EvaluationLog& log);

/// What a schedule is worth by a rule; fewer failures come first.
struct Worth {
  int failures = 0;  ///< in plants that count
  double value =
      0;  ///< the objective in the undisturbed plant, or the mean or the largest over all that it runs in
  [[nodiscard]] bool before(const Worth& other) const {
    return failures != other.failures ? failures < other.failures : value < other.value;
  }
};
Worth worth_of(const PlantSpread& spread, Choose rule);
/// "mean"; as in a case file.
const char* name_of(Choose rule);

/// "in 14 plants that differ (...) its objective is 21.10 to 23.00, worst with ...".
std::string spread_text(const PlantSpread& spread);
/// @param rule  by which the best was chosen.
nlohmann::json spread_json(const PlantSpread& spread, Choose rule = Choose::nominal);
/// What `spread_json` wrote. @throws nlohmann::json::exception if it is no spread.
PlantSpread spread_from(const nlohmann::json& value);

}  // namespace drapeplan
