// Where a run begins.
#pragma once

#include "fem/model/model.hpp"

namespace drapeplan {

/// The flat ply at rest, level at `height` [m] or on the mold, as the scene says.
State flat_start(const Model& model, double height);

}  // namespace drapeplan
