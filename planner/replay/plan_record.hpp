// What result.json of a plan says, as a plan had it: all but its drapes, which are played again.
#pragma once

#include <optional>

#include "planner/diagnosis/diagnosis.hpp"
#include "planner/replay/run_folder.hpp"
#include "planner/search/plan.hpp"
#include "planner/trust/claim.hpp"

namespace drapeplan {

struct PlanRecord {
  /// Without drapes and scores of the baselines and of the best; of the finalists those that no other one
  /// beats, with the figures that these are compared by.
  PlanResult result;
  PlanTrust trust;  ///< without levels of the choice, and without the confirmation
  std::optional<StrokeEffects> effects;
};

/// @param definition  of the run: resolved.json, or design.json where the rig was searched, too.
/// @throws WrongInput if result.json is not that of a plan of this case.
PlanRecord plan_record(const RunFolder& run, const Case& definition);

}  // namespace drapeplan
