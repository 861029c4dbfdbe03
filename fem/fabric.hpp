// The woven fabric: nominal stress over strain along the fibres, and shear stress over shear angle.
#pragma once

#include <cstddef>
#include <vector>

namespace drapeplan {

/// A piecewise linear curve through points of increasing strain that starts at (0, 0); beyond its last point
/// it goes on with its last slope.
struct Curve {
  std::vector<double> strain;  ///< [-] or [rad], first 0, increasing
  std::vector<double> stress;  ///< nominal [Pa], first 0, not decreasing

  [[nodiscard]] double operator()(double at) const;
  [[nodiscard]] double slope(size_t piece) const;  ///< between points piece and piece + 1 [Pa]
  [[nodiscard]] double largest_slope() const;      ///< [Pa]
  [[nodiscard]] double smallest_slope() const;     ///< smallest one above zero; 0 if there is none [Pa]
};

/// Ply material. Modes are decoupled, as in the seed ("Transient Nonlinear Finite Element Model").
struct Fabric {
  double thickness = 0;                 ///< [m]
  double areal_density = 0;             ///< [kg/m^2]
  Curve tension;                        ///< fibre, over nominal strain
  Curve compression;                    ///< fibre, magnitudes
  Curve shear;                          ///< over the shear angle [rad]; conjugate to the angle, odd
  double transverse_shear_modulus = 0;  ///< G13 = G23 [Pa]
};

}  // namespace drapeplan
