#include "planner/input/field.hpp"

#include <fmt/format.h>

#include <cmath>

namespace drapeplan {

bool Range::holds(double value) const {
  if (odd && std::fmod(value, 2) != 1) return false;
  return (lowest_excluded ? value > lowest : value >= lowest) &&
         (highest_excluded ? value < highest : value <= highest);
}

std::string range_text(const Range& range, Dimension dimension) {
  const auto text = [dimension](double value) { return format_quantity(value, dimension); };
  std::string limits;
  if (std::isfinite(range.lowest))
    limits = fmt::format("{} {}", range.lowest_excluded ? ">" : ">=", text(range.lowest));
  if (std::isfinite(range.highest)) {
    limits += fmt::format("{}{} {}", limits.empty() ? "" : " and ",
                          range.highest_excluded ? "<" : "<=", text(range.highest));
  }
  if (range.odd) limits += ", odd";
  return limits;
}

}  // namespace drapeplan
