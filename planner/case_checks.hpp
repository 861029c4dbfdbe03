// Rules between fields: what no single field can know.
#pragma once

#include "planner/case_reader.hpp"

namespace drapeplan {

/// Adds an error for every broken rule between fields that are good by themselves.
void check_case(const CaseFields& fields, CaseReader& reader);

}  // namespace drapeplan
