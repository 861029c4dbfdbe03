// Mesh lines across a ply, for the generators of meshes.
#pragma once

#include <vector>

namespace drapeplan {

/// Increasing lines from `lower` to `upper` through `places` (increasing; those outside are left out) [m]:
/// equal cells between them, at most `mesh_size`. A margin narrower than three quarters of a cell joins the
/// cell beside it.
std::vector<double> mesh_lines(double lower, double upper, double mesh_size,
                               const std::vector<double>& places);

}  // namespace drapeplan
