// Draping strategies: who goes down when. All are pure functions from a few numbers to a schedule.
//
// A sequence has two parts ([Krogh], "Motion Planning"): the preshape, a straight line of constant velocity
// to a height above every target, the same in the baselines, and then one stroke per gripper down to its
// target. A strategy is only the choice of the strokes; `to_schedule` does the rest.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fem/rig/schedule.hpp"
#include "planner/case/case.hpp"

namespace drapeplan {

/// What is fixed about a sequence, whatever the strategy.
struct SequenceFrame {
  RigOptions rig;
  std::vector<double>
      target_z;  ///< height of each joint where its pad touches the mold, in the order of the grid [m]
  /// x-y of each joint in the flat start and where its pad touches the mold [m]; empty if only z is driven.
  std::vector<Eigen::Vector2d> start_xy = {}, target_xy = {};
  ScheduleOptions options;
  double shortest_stroke = 1.0;    ///< [s], of the searched families
  double longest_sequence = 15.0;  ///< after the preshape [s], of the searched families
  std::optional<PressOptions> press = {};

  /// Height of all joints at t = 0: the highest target plus the preshape height, so that grippers of the
  /// baselines only go down [m].
  [[nodiscard]] double start_z() const;
};

/// What one gripper does besides going straight to its target.
struct Stroke {
  double start = 0;     ///< from the end of the preshape [s]
  double duration = 0;  ///< [s]
  /// Over the target at the end of the preshape [m]; at `overtravel` below it the pad is down already, and
  /// there is no stroke. It may be higher than the flat start: then the gripper goes up first.
  double height = 0;
  double leave = 0;   ///< when it leaves the flat start, as a share of the preshape, [0, 1)
  double bend = 0.5;  ///< share of the stroke's way that is done after half of its time; 0.5: straight
};

/// The strokes of all grippers, in the order of the grid. Gauge: the smallest start is 0.
using Strokes = std::vector<Stroke>;

enum class WaveDistance {
  rings,    ///< round(Chebyshev distance / spacing): groups of grippers, as in [Krogh]
  blended,  ///< (1 - roundness) * Chebyshev + roundness * Euclid, continuous
};

/// A front that spreads from a point; a delay of 0 is the uniform strategy.
struct WaveParameters {
  Eigen::Vector2d start{0, 0};  ///< in the ply frame (u, v) [m]
  double delay = 0;             ///< from start to start, per spacing of distance (rings: per ring) [s]
  double duration = 0;          ///< of one stroke [s]
  double preshape_height = 0;   ///< [m]
  WaveDistance distance = WaveDistance::rings;
  double roundness = 0;  ///< 0: square front, 1: round front; only if blended
};

/// Strokes of the baselines, with the durations, delay and start point of `frame.options`.
Strokes uniform_strokes(const SequenceFrame& frame);
Strokes wave_strokes(const SequenceFrame& frame);
/// Strokes of any wave.
Strokes wave_strokes(const SequenceFrame& frame, const WaveParameters& wave);
/// Starts earlier, all by as much, so that the first is 0.
void shift_to_gauge(Strokes& strokes);
/// The wave of `frame.options` as a member of the family; its delay is from start to start.
WaveParameters baseline_wave(const SequenceFrame& frame);

/// Paths of all grippers: rest until they leave, preshape (with all in-plane movement, if the rig has any),
/// wait, stroke to `overtravel` below the target, rest until `settle` after the last stroke. Knot times
/// increase strictly. Times are rounded to 0.1 ms and heights to 1 um, so that equal strategies from
/// different parametrisations are equal schedules. A preshape or stroke that would need more than the rig's
/// largest velocity or acceleration is stretched (see `stretched`); the starts stay. Suction ends
/// `rig.release_time` after the last stroke, or when a press has taken over (see let_go_pressed).
Schedule to_schedule(const SequenceFrame& frame, const Strokes& strokes);
/// Where pads are released in the press, ends the suction of all grippers that still hold the ply when the
/// pressure is full.
void let_go_pressed(const std::optional<PressOptions>& press, Schedule& schedule);
/// All knots agree within 50 ms and 1 mm: for a robot, the same schedule.
bool nearly_equal(const Schedule& a, const Schedule& b);
/// What to_schedule stretched, as a sentence; empty if nothing.
std::string stretched(const SequenceFrame& frame, const Strokes& strokes);

}  // namespace drapeplan
