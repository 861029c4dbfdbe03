// Fields of what a case is made of: fabric, damping and gripper grid; parts of the one statement of
// fields.hpp.
#pragma once

#include <string>
#include <vector>

#include "planner/case/fields.hpp"
#include "planner/input/reader.hpp"

namespace drapeplan {

void visit_material(FieldVisitor& visitor, MaterialFields& material);

/// Reads the tables that a material's curves name in place of points, and says in the source of each curve what
/// became of it. Adds an error for every table that is no curve, and for curves without points.
/// @param pointer  where the material stands in the document that was read.
/// @return a line for each table that was smoothed, with what the curve misses.
std::vector<std::string> read_curve_files(MaterialFields& material, const std::string& pointer,
                                          FieldReader& reader);

void visit_damping(FieldVisitor& visitor, DampingFields& damping);

/// The gripper grid; what `c` says of interlinks beside the rig.
void visit_grippers(FieldVisitor& v, RigOptions& g, Case& c);

}  // namespace drapeplan
