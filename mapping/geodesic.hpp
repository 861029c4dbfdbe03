// Lines on a mold: geodesics, and tracks that are given in plan.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/mold.hpp"

namespace drapeplan {

/// A geodesic as points on the mold at equal arc length.
struct Geodesic {
  std::vector<Eigen::Vector3d> points;  ///< first one is the start [m]
  Eigen::Vector3d end_direction;        ///< unit tangent at the last point
};

/// Shoots a geodesic from (x, y) of `start` in the direction whose projection on the x-y plane is
/// `direction`. Integrates the geodesic equation of the height field with the classical fourth-order
/// Runge-Kutta method.
/// @param step   distance between points [m], > 0;  @param count  number of steps, >= 0.
/// @throws NotFinished where the mold is not defined along the way.
Geodesic shoot_geodesic(const Mold& mold, const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                        double step, int count);

/// Direction (unit, in the x-y plane) of the geodesic from `start` that passes through `goal`.
/// @throws NotFinished if the shooting iteration does not converge.
Eigen::Vector2d geodesic_direction(const Mold& mold, const Eigen::Vector2d& start,
                                   const Eigen::Vector2d& goal);

/// A place on a mold that moves along a track, which is straight in plan between points (x, y), and beyond its end
/// along the geodesic that goes on from it.
class TrackWalker {
 public:
  /// @param track  two points at least, no two neighbours in one place [m].
  TrackWalker(const Mold& mold, std::vector<Eigen::Vector2d> track);

  /// Moves on to the first place that is as far from `from` as the crow flies: found to round-off by bisection, after
  /// steps of an eighth of the distance.
  /// @param from  the place before, or one near it [m];  @param chord  > 0 [m].
  /// @throws NotFinished where the mold is not defined along the way.
  Eigen::Vector3d next(const Eigen::Vector3d& from, double chord);
  /// Direction of the way on (unit, in the x-y plane).
  [[nodiscard]] const Eigen::Vector2d& heading() const { return heading_; }
  /// Whether the place lies beyond the track.
  [[nodiscard]] bool ended() const { return at_ > lengths_.back(); }

 private:
  /// The place at a length along the track in plan, or beyond it along the geodesic; sets the heading.
  Eigen::Vector3d place(double at);

  const Mold& mold_;
  std::vector<Eigen::Vector2d> track_;
  std::vector<double> lengths_;  ///< in plan up to each point [m]
  double at_ = 0;                ///< along the track, or beyond it [m]
  Eigen::Vector2d heading_{0, 0};
};

}  // namespace drapeplan
