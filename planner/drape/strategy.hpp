// Draping strategies: who goes down when. All are pure functions from a few numbers to a schedule.
//
// A sequence has two parts ([Krogh], "Motion Planning"): the preshape, a straight line of constant velocity
// to the same height above every target, and then one stroke per gripper down to its target. A strategy is
// only the choice of the strokes; `to_schedule` does the rest.
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

  /// Height of all joints at t = 0: the highest target plus the preshape height, so that grippers only go
  /// down [m].
  [[nodiscard]] double start_z() const;
};

/// The strokes after the preshape. Gauge: the smallest start is 0.
struct Strokes {
  std::vector<double> start;     ///< from the end of the preshape [s]
  std::vector<double> duration;  ///< [s]
  double preshape_height = 0;    ///< above the targets [m]; at most the frame's, or grippers would go up
};

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
/// The wave of `frame.options` as a member of the family; its delay is from start to start.
WaveParameters baseline_wave(const SequenceFrame& frame);

/// Paths of all grippers: preshape (with all in-plane movement, if the rig has any), wait, stroke to
/// `overtravel` below the target, rest until `settle` after the last stroke. Knot times increase strictly.
/// Times are rounded to 0.1 ms and heights to 1 um, so that equal strategies from different parametrisations
/// are equal schedules. A preshape or stroke that would need more than `rig.max_velocity` is stretched to it
/// (see `stretched`); the starts stay. Suction ends `rig.release_time` after the last stroke, or when a press
/// has taken over (see let_go_pressed).
Schedule to_schedule(const SequenceFrame& frame, const Strokes& strokes);
/// Where pads are released in the press, ends the suction of all grippers that still hold the ply when the
/// pressure is full.
void let_go_pressed(const std::optional<PressOptions>& press, Schedule& schedule);
/// What to_schedule stretched, as a sentence; empty if nothing.
std::string stretched(const SequenceFrame& frame, const Strokes& strokes);

/// The wave family over [0, 1]^6:
///   0, 1  start point, linear, from one spacing outside the grid to one spacing outside on the other side
///   2     delay per spacing, quadratic from 0 to (longest_sequence - shortest_stroke) / (grippers along the
///   rig - 1) 3     stroke, logarithmic from shortest_stroke to longest_sequence 4     preshape height,
///   logarithmic from 1/4 of the frame's to the frame's 5     roundness of the front, linear
/// Starts are scaled down together where the sequence would exceed longest_sequence. Coordinates outside [0,
/// 1] are clipped.
class WaveFamily {
 public:
  explicit WaveFamily(SequenceFrame frame);
  static constexpr int kDimension = 6;
  [[nodiscard]] Strokes decode(const Eigen::VectorXd& x) const;
  /// Nearest member; rings become a square front (the same strokes if the start point is a gripper).
  [[nodiscard]] Eigen::VectorXd encode(const WaveParameters& wave) const;

 private:
  SequenceFrame frame_;
  double longest_delay_ = 0;  ///< [s]
};

/// Free starts over [0, 1]^(grippers + 1) around a base whose preshape height is kept: one start per gripper,
/// linear from 0 to longest_sequence - shortest_stroke, then one factor on all durations of the base,
/// logarithmic from 1/4 to 4. Starts are shifted to the gauge; what would end after longest_sequence starts
/// earlier. Coordinates outside [0, 1] are clipped.
class GripperFamily {
 public:
  GripperFamily(SequenceFrame frame, Strokes base);
  [[nodiscard]] int dimension() const;
  [[nodiscard]] Strokes decode(const Eigen::VectorXd& x) const;
  /// The base's own coordinates: where a search around it starts.
  [[nodiscard]] Eigen::VectorXd encode_base() const;

 private:
  SequenceFrame frame_;
  Strokes base_;
};

}  // namespace drapeplan
