// A heavy strip that is clamped at one end, with any law between moment and curvature; and the law of a ply.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/law/fabric.hpp"

namespace drapeplan {

/// Curvature [1/m] over moment per width [N], both magnitudes; it increases.
using BendingLaw = Curve;

/// The law of a linear strip. @param stiffness  per width [N m].
BendingLaw linear_bending(double stiffness);

/// A strip at rest. The clamp is at the origin, the strip starts along +x, y is up.
struct StripAtRest {
  std::vector<Eigen::Vector2d> places;  ///< equally spaced along the strip [m]
  std::vector<double> curvature;        ///< there, > 0 downwards [1/m]
  std::vector<double> moment;           ///< there, per width [N]
  [[nodiscard]] double tip() const { return -places.back().y(); }  ///< drop of the tip [m]
};

/// The strip under its weight: exact for large rotations, without stretch and transverse shear. The slope angle
/// of the tip is sought for which that of the clamp is zero (it grows with it, so bisection finds it); fourth
/// order in the step along the strip.
/// @param length  [m], > 0;  @param load  weight per area [N/m^2], >= 0.
StripAtRest strip_at_rest(const BendingLaw& law, double length, double load);

/// Bending stiffness per width D of a linear strip with this tip drop [N m]: [Krogh] fits the isotropic beam
/// whose modulus is E = 12 D / t^3.
/// @throws std::invalid_argument if no stiffness has it: the drop lies between 0 and the length.
double stiffness_of(double tip, double length, double load);

/// The law of a strip from its shape at rest under its weight, which is what a picture of it shows. The weight beyond
/// a place gives the moment there; the law is the piecewise linear one whose curvatures, integrated twice, miss the
/// places least (in the sense of least squares). It goes through the origin and falls nowhere.
/// @param places  from the clamp on, where the strip starts along +x; y is up [m]. Much further apart than they are
/// uncertain, since chords between them are taken to be the strip's length.  @param load  weight per area [N/m^2], > 0.
/// @param pieces  of the law, between the moments at places equally far apart along the strip: the fewer, the less
/// noise and the less detail; two at least.
/// @throws std::invalid_argument for fewer than two places for each piece, or a strip that turns back on itself.
BendingLaw bending_law_of_profile(const std::vector<Eigen::Vector2d>& places, double load, int pieces = 20);

/// Moment per width of a ply whose fibres have these curves [N]: pure bending with the neutral axis where no
/// force is left. Exact for piecewise linear curves.
/// @param tension, compression  nominal stress over strain, magnitudes.  @param thickness  [m].
double section_moment(const Curve& tension, const Curve& compression, double thickness, double curvature);

/// The law of such a ply, at many curvatures up to that at which the outside is strained by 10 %.
BendingLaw section_bending(const Curve& tension, const Curve& compression, double thickness);

}  // namespace drapeplan
