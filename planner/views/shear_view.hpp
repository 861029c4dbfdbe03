// The ply in space, coloured by its shear.
#pragma once

#include <string>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/mesh/mesh.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// The ply at one instant.
struct ShearPanel {
  std::string title;
  const Snapshot* ply = nullptr;
};

/// SVG of the panels side by side with one colour scale of the magnitude of the shear angle [deg], seen
/// obliquely from above without perspective; the mold as a net of lines below. Cells are drawn from the back
/// to the front. Cells with a corner that is not finite are left out. [Krogh], Figures 19, 22 and 25.
/// @param mold  null without one.
/// @throws std::invalid_argument without panels or if a snapshot does not fit the mesh.
std::string shear_picture(const std::vector<ShearPanel>& panels, const Mesh& mesh, const Mold* mold);

}  // namespace drapeplan
