// What could be changed about a case to lower its floor, each as a case of its own.
#pragma once

#include <string>
#include <vector>

#include "planner/case/case.hpp"
#include "planner/drape/map_result.hpp"
#include "planner/reach/floor.hpp"

namespace drapeplan {

struct FloorChange {
  std::string name;   ///< for files: "mapped_interlinks"
  std::string words;  ///< "interlinks as long as mapped"
  Case definition;    ///< the case with this change alone
};

/// Interlinks as mapped, with play, joints at the ply, small pads, more grippers over the same extent, no
/// fixed joint (which also bounds every other place and turn of the ply), other starts of the mapping. Those
/// that would change nothing are left out.
/// @param definition  with mold, mapping and grippers.
std::vector<FloorChange> floor_changes(const Case& definition);

/// The floor with a change at one boundary tolerance [m], in words if it cannot even be posed.
struct ChangedFloor {
  std::string name, words;
  FloorPoint point;
};

/// Each costs a mapping and a solve of its own.
/// @param cell  of the net [m]; @param fibre_strain  see FloorProblem.
std::vector<ChangedFloor> solve_changes(const std::vector<FloorChange>& changes, double tolerance,
                                        double cell, double fibre_strain);

/// "With interlinks as long as mapped it would be 0.1 mm." for each, the best first.
std::string explain_changes(const FloorPoint& floor, const std::vector<ChangedFloor>& changes);

}  // namespace drapeplan
