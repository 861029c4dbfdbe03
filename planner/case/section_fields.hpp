// Fields of what a case is made of: the fabric, its damping and the mold; parts of the one statement of
// fields.hpp.
#pragma once

#include "planner/case/fields.hpp"

namespace drapeplan {

void visit_material(FieldVisitor& visitor, MaterialFields& material);
void visit_mold(FieldVisitor& visitor, MoldFields& mold);
void visit_damping(FieldVisitor& visitor, DampingFields& damping);

/// The gripper grid; what `c` says of interlinks beside the rig.
void visit_grippers(FieldVisitor& v, RigOptions& g, Case& c);

}  // namespace drapeplan
