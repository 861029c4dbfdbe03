// Design variables: fields of the case that a search may change.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/case/case.hpp"
#include "planner/input/reader.hpp"

namespace drapeplan {

/// A variable's limits as numbers in its own unit.
struct DesignRange {
  double from = 0, to = 0;
  std::string unit;  ///< with a blank in front; empty for bare numbers
};

/// Nothing if these are no two numbers with one unit.
std::optional<DesignRange> range_of(const DesignVariable& variable);

/// `path=value` for a share of the range, from 0 to 1; the value has six digits. Needs a sound range.
std::string override_of(const DesignVariable& variable, double share);

/// Adds an error for every variable that names no field, one that judges drapes, or has no sound range.
void check_design(const std::vector<DesignVariable>& design, FieldReader& reader);

}  // namespace drapeplan
