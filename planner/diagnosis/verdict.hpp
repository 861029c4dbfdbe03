// What is said first of a plan: good enough or not, whether the rig forbids more, and what is doubtful.
#pragma once

#include <string>

#include "planner/drape/acceptance.hpp"
#include "planner/search/plan.hpp"
#include "planner/trust/claim.hpp"

namespace drapeplan {

/// Whether the best drape is good enough, by the tolerances of its case; if not, whether another schedule
/// could be; in how many plants that differ it would be; and which checks its run did not pass.
std::string verdict_text(const DrapeProblem& problem, const PlanResult& result, const PlanTrust& trust);

/// That the floor of the ply and the reach of the rig allow both tolerances; empty where the floor does not
/// show it.
/// @param floor_max  how near all grippers can be to their targets at once [m]; see ReachResult.
std::string within_reach_text(const FloorFront& front, double floor_max, const ScoreOptions& options);

/// In how many of the plants that differ both tolerances are kept.
int accepted_plants(const PlantSpread& spread, const ScoreOptions& options);

/// What the limit of force has to do with the best sequence; empty if no actuator was at it.
std::string best_force_text(const DrapeProblem& problem, const PlanResult& result);

}  // namespace drapeplan
