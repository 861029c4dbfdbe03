// Where the fibres of a draped ply run, and how thick it is, for the finite-element model of the part.
#pragma once

#include <filesystem>
#include <string>

#include "fem/core/snapshot.hpp"
#include "fem/model/scene.hpp"
#include "planner/exports/vtk_file.hpp"

namespace drapeplan {

/// Thickness of a sheared ply [m]. A piece between two fibres of warp and two of weft keeps the length of its
/// sides when it shears (C. Mack, H. M. Taylor, "The fitting of woven cloth to surfaces", 1956), so its area
/// goes with cos(shear); its volume stays, so its thickness goes with 1 / cos(shear). Strains of fibres are
/// left out.
/// @param flat  thickness of the flat ply [m];  @param shear  [rad], below pi/2.
double sheared_thickness(double flat, double shear);

/// Writes fibres.csv, a row per element: `element`, its number among the cells of the ply's grids, from 0;
/// the place of its middle in the flat ply (`u_m`, `v_m`) and in the world (`x_m`, `y_m`, `z_m`, on the
/// mid-surface); unit vectors along the fibres (`warp_x` ... `weft_z`, world); `shear_deg`, > 0 where the
/// angle between warp and weft closes; `thickness_m`, see above. And fibres.csv-metadata.json, which says so
/// to programs (CSV on the Web).
/// @param ply  of a run that did not diverge.
/// @return both files.
/// @throws std::invalid_argument if a number is not finite.
NamedFiles write_fibres(const std::filesystem::path& folder, const Scene& scene, const Snapshot& ply,
                        const std::string& case_name, const std::string& case_hash);

}  // namespace drapeplan
