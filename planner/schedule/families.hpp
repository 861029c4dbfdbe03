// Families of schedules: pure maps from points of [0, 1]^n to the strokes of all grippers, for a search.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "planner/schedule/strategy.hpp"

namespace drapeplan {

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
  /// Nine members to begin with: the baseline wave from the corners, the mid-sides, and a slow one from the
  /// middle.
  [[nodiscard]] std::vector<Eigen::VectorXd> spread() const;

 private:
  SequenceFrame frame_;
  double longest_delay_ = 0;  ///< [s]
};

/// How one value per gripper is made.
enum class Spread {
  smooth,  ///< a cubic polynomial over the grid: at most ten numbers, whatever the size of the rig
  each,    ///< a number of its own
};

/// Which values a family changes, and how they are spread; what is absent is as in a plain stroke.
struct StrokeSpreads {
  std::optional<Spread> start = Spread::smooth;
  std::optional<Spread> height = Spread::smooth;
  std::optional<Spread> bend = {};
  std::optional<Spread> leave = {};
};

/// Strokes with heights of their own, over [0, 1]^n. Each value is linear between its bounds:
///   start   0 to longest_sequence - shortest_stroke
///   height  overtravel below the target to as much over twice the preshape height; the middle is that height
///   bend    0.1 to 0.9
///   leave   0 to 0.5
/// and the last coordinate is the one duration of all strokes, logarithmic from shortest_stroke to
/// longest_sequence. The smooth value at a place (u, v) of the grid, scaled to [-1, 1], is 1/2 + sum (x_k -
/// 1/2) P_i(u) P_j(v) with Legendre polynomials P, i + j <= 3. Starts are shifted to the gauge; what would
/// end after longest_sequence starts earlier. Coordinates and values outside [0, 1] are clipped.
class StrokeFamily {
 public:
  StrokeFamily(SequenceFrame frame, const StrokeSpreads& spreads);
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] Strokes decode(const Eigen::VectorXd& x) const;
  /// Nearest member: the same strokes if they are one; durations become their geometric mean, smooth values
  /// their least-squares fit.
  [[nodiscard]] Eigen::VectorXd encode(const Strokes& strokes) const;

 private:
  struct Part {
    double Stroke::*value;
    double low, high;
    Eigen::MatrixXd basis;    ///< grippers by coordinates
    Eigen::MatrixXd inverse;  ///< of the basis, in the sense of least squares
  };
  SequenceFrame frame_;
  std::vector<Part> parts_;
  int dimension_ = 1;
};

/// Point k of a sequence that fills [0, 1]^n evenly, k >= 0; the first is the middle: multiples of powers of
/// 1 / g, with g the root of g^(n + 1) = g + 1 (M. Roberts, "The unreasonable effectiveness of quasirandom
/// sequences", 2018).
Eigen::VectorXd even_point(int k, Eigen::Index dimension);

/// Different schedules within the limits of the rig: the baselines first, then waves and free strokes in
/// turn.
std::vector<Schedule> spread_schedules(const SequenceFrame& frame, int count);

}  // namespace drapeplan
