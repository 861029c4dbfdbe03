// The flat ply as it is cut and marked.
#pragma once

#include <filesystem>
#include <string>

#include "planner/case/case.hpp"
#include "planner/exports/vtk_file.hpp"

namespace drapeplan {

/// The pattern as DXF (dxf.hpp): the ply frame seen from the side of the grippers, x along the warp, y along
/// the weft. Layers: CUT, the outline, closed; GRIPPERS, a circle per pad and a cross below its joint;
/// FIBRES, ticks over the ply, long ones along the warp, short ones along the weft; DATUM, a cross at the
/// origin of the ply frame, which `ply.position` places; TEXT, names of the grippers, the ends of the datum,
/// and what the drawing is.
std::string pattern_text(const Case& definition);

/// Writes it as pattern.dxf. @return the file.
NamedFiles write_pattern(const std::filesystem::path& folder, const Case& definition);

}  // namespace drapeplan
