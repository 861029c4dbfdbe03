// What may be claimed of a plan, given what its figures are wrong by.
#pragma once

#include <optional>

#include "planner/search/stages.hpp"
#include "planner/trust/choice.hpp"
#include "planner/trust/confirm.hpp"
#include "planner/trust/spread.hpp"

namespace drapeplan {

/// What is known of how far the results of a plan can be trusted.
struct PlanTrust {
  std::optional<FidelityChoice> choice;  ///< where the case names no numerical settings
  std::optional<Confirmation> confirmation;  ///< where there was time for it
  Choose rule = Choose::nominal;             ///< by which the winner was chosen
  std::optional<PlantSpread> spread;     ///< where a schedule was found that runs to its end
};

/// "The optimised sequence beats the baselines" is said only of a gain that is larger than the error of the
/// reporting fidelity: else `beats_baselines` is taken back, and the message says so.
/// @param error  relative, of objectives at the reporting fidelity.
void claim_beyond(double error, StagedResult& search);

/// The same where the finer run does not confirm it: the gain is gone or less than half as large, or the
/// winner fails or is not followed there. Nothing is taken back where it wins since the rig does not follow
/// the baselines, or where neither can be played at the finer setting.
void claim_confirmed(const Confirmation& confirmation, StagedResult& search);

}  // namespace drapeplan
