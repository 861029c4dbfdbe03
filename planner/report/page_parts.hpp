// Parts of pages that show drapes: the view in space, angles of fibres, and where the figures of a case are
// from.
#pragma once

#include <string>
#include <vector>

#include "planner/case/case.hpp"
#include "planner/diagnosis/diagnosis.hpp"
#include "planner/page/page.hpp"
#include "planner/page/view.hpp"

namespace drapeplan {

/// The view of drapes in space, in the colours of the pictures. @param mapping  null without one.
std::string space_view(const std::vector<ViewDrape>& drapes, const MapResult* mapping);

/// How much of each ply, at its last frame, is within classes of shear and, with a mapping, of the angle
/// between its fibres and those of the mapped net.
ReportTable angles_table(const std::vector<ViewDrape>& drapes, const MapResult* mapping);

/// Where the drape stands above the mold, of what kind, and which grippers hold it there.
ReportTable folds_table(const Diagnosis& diagnosis, const RigOptions& rig);

/// Rest area of the ply [m^2].
double ply_area(const Mesh& mesh);

/// Where the figures of material and grippers come from, and what is assumed of them; as the case says it.
std::vector<std::string> source_notes(const Case& definition);

}  // namespace drapeplan
