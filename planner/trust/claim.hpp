// What may be claimed of a plan, given what its figures are wrong by.
#pragma once

#include <optional>

#include "planner/search/stages.hpp"
#include "planner/trust/choice.hpp"
#include "planner/trust/spread.hpp"

namespace drapeplan {

/// What is known of how far the results of a plan can be trusted.
struct PlanTrust {
  std::optional<FidelityChoice> choice;  ///< where the case names no numerical settings
  std::optional<PlantSpread> spread;     ///< where a schedule was found that runs to its end
};

/// "The optimised sequence beats the baselines" is said only of a gain that is larger than the error of the
/// reporting fidelity: else `beats_baselines` is taken back, and the message says so.
/// @param error  relative, of objectives at the reporting fidelity.
void claim_beyond(double error, StagedResult& search);

}  // namespace drapeplan
