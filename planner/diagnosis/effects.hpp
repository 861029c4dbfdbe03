// Which strokes of a schedule matter: what the objective is expected to be where one of them is a little
// different.
#pragma once

#include <vector>

#include "planner/search/stages.hpp"

namespace drapeplan {

/// Steps of one height and one start, small enough to stay near what the search has seen.
inline constexpr double kHeightStep = 0.005;  // [m]
inline constexpr double kStartStep = 0.5;     // [s]

/// One value of one gripper's stroke.
struct StrokeEffect {
  int gripper = 0;
  bool height = false;  ///< of the preshape, above the target; false: the start of the stroke
  double value = 0;     ///< in the schedule [m] or [s]
  double more = 0,
         less =
             0;  ///< expected changes of the objective, one step up and one step down, as far as bounds allow

  /// The larger change of both: what it costs to get this value wrong.
  [[nodiscard]] double size() const;
};

/// Of all heights and starts, those of largest effect first.
std::vector<StrokeEffect> stroke_effects(const Learned& learned);

}  // namespace drapeplan
