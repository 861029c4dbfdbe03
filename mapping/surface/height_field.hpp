// What every mold is described with: the derivatives of a height field z = f(x, y) and the part of the plane
// it covers.
#pragma once

#include <Eigen/Core>

namespace drapeplan {

/// Height and its partial derivatives up to third order at one point (x, y). Metre based SI units.
struct Jet {
  double z = 0;                                   ///< [m]
  double zx = 0, zy = 0;                          ///< [-]
  double zxx = 0, zxy = 0, zyy = 0;               ///< [1/m]
  double zxxx = 0, zxxy = 0, zxyy = 0, zyyy = 0;  ///< [1/m^2]
};

/// The part of the x-y plane that the mold covers [m]; the height field itself extends beyond it.
struct Extent {
  Eigen::Vector2d lower{0, 0}, upper{0, 0};
};

}  // namespace drapeplan
