// What may be claimed of a plan, given what its figures are wrong by.
#pragma once

#include "planner/search/stages.hpp"

namespace drapeplan {

/// "The optimised sequence beats the baselines" is said only of a gain that is larger than the error of the reporting
/// fidelity: else `beats_baselines` is taken back, and the message says so. Both were simulated with the same settings,
/// so that most of their errors are alike: the rule is on the safe side.
/// @param error  relative, of the figures at the reporting fidelity.
void claim_beyond(double error, StagedResult& search);

}  // namespace drapeplan
