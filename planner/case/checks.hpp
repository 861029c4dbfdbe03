// Rules between fields: what no single field can know.
#pragma once

#include "planner/case/fields.hpp"
#include "planner/input/reader.hpp"

namespace drapeplan {

/// Adds an error for every broken rule between fields that are good by themselves.
void check_case(const CaseFields& fields, FieldReader& reader);

}  // namespace drapeplan
