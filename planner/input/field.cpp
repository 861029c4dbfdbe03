#include "planner/input/field.hpp"

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
  if (std::isfinite(range.lowest)) limits = (range.lowest_excluded ? "> " : ">= ") + text(range.lowest);
  if (std::isfinite(range.highest)) {
    limits += (limits.empty() ? "" : " and ") + std::string(range.highest_excluded ? "< " : "<= ") +
              text(range.highest);
  }
  if (range.odd) limits += ", odd";
  return limits;
}

}  // namespace drapeplan
