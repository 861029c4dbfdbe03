// Closed forms and small shootings that stress scenes are judged by.
#pragma once

#include "fem/law/fabric.hpp"

namespace drapeplan {

/// A strip of length L between two hinges that do not move, bent by an even load into a cylinder.
struct HingedStrip {
  double length = 0;      ///< [m]
  double stretch = 0;     ///< membrane stiffness E t [N/m]
  double bending = 0;     ///< E t^3 / 12 [N m]
  double transverse = 0;  ///< 5/6 G13 t [N/m]
  double load = 0;        ///< per area [Pa]
};
struct HingedSag {
  double sag = 0;      ///< in the middle [m]
  double tension = 0;  ///< per width [N/m]
};
/// Fourier series for the deflection under a tension that stretches the strip by what it sags (Timoshenko and
/// Woinowsky-Krieger, "Bending to a cylindrical surface"), with transverse shear; bisection on the tension.
HingedSag hinged_sag(const HingedStrip& strip);

/// Tip drop over length of the heavy elastica D theta'' = -w (L - s) cos theta with beta = w L^3 / D:
/// shooting from the root.
double elastica_drop(double beta);

/// Angle of a sheet whose fibres do not stretch, clamped at one edge and sheared by a force along the
/// opposite one: stress(angle) * thickness * edge = force cos(angle). @param force  over edge and thickness
/// [Pa].
double trellis_angle(const Curve& shear, double force);

}  // namespace drapeplan
