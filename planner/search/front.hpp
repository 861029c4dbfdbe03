// The front of gap, boundary offset and duration.
#pragma once

#include <vector>

#include "planner/search/stages.hpp"

namespace drapeplan {

/// Of candidates that were evaluated to their end and followed their commands: those that no other one beats,
/// or equals, in largest gap, largest boundary offset and duration at once; by increasing gap.
std::vector<const Candidate*> unbeaten(const std::vector<Candidate>& candidates);

}  // namespace drapeplan
