// What is made of the candidates at the reporting fidelity: a winner, a sentence, a front.
#pragma once

#include <vector>

#include "planner/search/stages.hpp"

namespace drapeplan {

/// Sorts the finalists, best first: failures last, before them what the rig did not follow. The first is the
/// best; the message says by how much it beats the baselines, or that it does not.
void conclude(StagedResult& result);

/// Of candidates that were evaluated to their end and followed their commands: those that no other one beats,
/// or equals, in largest gap, largest boundary offset and duration at once; by increasing gap.
std::vector<const Candidate*> unbeaten(const std::vector<Candidate>& candidates);

}  // namespace drapeplan
