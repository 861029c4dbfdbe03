// The quick case with the coarsest numerics that still drape: a run takes a fraction of a second.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "planner/case/file.hpp"

namespace drapeplan {

/// @param overrides  further ones, as of --set.
inline Case coarse_case(std::vector<std::string> overrides = {}) {
  for (const char* change : {"fem.mesh_size=40 mm", "fem.time_scaling=30", "fidelities={}"})
    overrides.emplace_back(change);
  return read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json", std::move(overrides)).definition;
}

}  // namespace drapeplan
