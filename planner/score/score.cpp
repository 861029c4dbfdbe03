#include "planner/score/score.hpp"

#include <fmt/format.h>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

static_assert(
    [] {
      for (const ScorePart& part : kScoreParts) {
        if (part.leads && part.study == nullptr) return false;
      }
      return true;
    }(),
    "a leading part is compared by the study");

/// Adds "largest gap 3.15 mm" to a list.
void append(const ScorePart& part, const Score& score, std::string& list) {
  if (!list.empty()) list += "; ";
  list += fmt::format("{} {}", part.label, value_text(part, score));
  if (*part.unit != '\0') list += fmt::format(" {}", part.unit);
}

}  // namespace

std::string title_of(const ScorePart& part) {
  return *part.unit == '\0' ? part.label : fmt::format("{} [{}]", part.label, part.unit);
}

std::string value_text(const ScorePart& part, const Score& score) {
  return fixed(part.factor * score.*part.value, part.decimals);
}

std::string score_text(const Score& score) {
  if (!score.valid) return score.reason;
  std::string list;
  for (const ScorePart& part : kScoreParts) append(part, score, list);
  return list;
}

std::string force_text(const Score& score, double limit, double lag_tolerance) {
  if (!score.valid || !(score.saturated > 0)) return {};
  return fmt::format(
      "Some actuator is at its limit of {:g} N for {:.1f} of {:.1f} s, and joints are up to {:.1f} mm behind "
      "their "
      "commands, of {:g} mm allowed: more force could move the ply further.",
      limit, score.saturated, score.duration, 1e3 * score.max_lag, 1e3 * lag_tolerance);
}

}  // namespace drapeplan
