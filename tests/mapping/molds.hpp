// Molds that several tests use.
#pragma once

#include "mapping/mold.hpp"

namespace drapeplan {

/// Seed, Eq. (1).
inline Mold seed_mold() {
  return Mold(PolynomialShape{{{1, 0, 1.004},
                               {0, 1, 1.089},
                               {2, 0, -3.667},
                               {1, 1, -4.4},
                               {0, 2, -3.75},
                               {3, 0, 3.086},
                               {2, 1, 8.889},
                               {0, 3, 4.321}}},
              {{0, 0}, {0.45, 0.45}});
}

inline Mold inclined_plane(double angle) {
  return Mold(PlaneShape{angle}, {{-0.5, -0.5}, {0.5, 0.5}});
}

inline Mold sphere(const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(radius / 2);
  return Mold(SphereShape{centre, radius}, {centre.head<2>() - half, centre.head<2>() + half});
}

inline Mold cylinder(const Eigen::Vector3d& centre, double azimuth, double radius) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(radius / 2);
  return Mold(CylinderShape{centre, azimuth, radius}, {centre.head<2>() - half, centre.head<2>() + half});
}

}  // namespace drapeplan
