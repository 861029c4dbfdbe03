// Geodesic lines on a mold.
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

}  // namespace drapeplan
