// Cantilever tests: how a strip bends in time, its strains and their rates. [Krogh], "Cantilever Test".
#pragma once

#include <Eigen/Core>
#include <vector>

namespace drapeplan {

/// The shape of a strip at an instant: y = a1 x + a2 x^2 + a3 x^3 + a4 x^4, through the clamp.
struct StripShape {
  double time = 0;  ///< [s]
  Eigen::Vector4d coefficients = Eigen::Vector4d::Zero();
  double end = 0;  ///< x of the tip [m]

  [[nodiscard]] double height(double x) const;
  [[nodiscard]] double slope(double x) const;
  /// [Krogh], Eq. (11) [1/m].
  [[nodiscard]] double curvature(double x) const;
  /// Drop of the tip [m].
  [[nodiscard]] double tip() const { return -height(end); }
  /// Length along the strip from the clamp to the tip [m].
  [[nodiscard]] double length() const;
  /// x at a share of that length.
  [[nodiscard]] double place(double share) const;
};

/// Least squares through a midline's points. @param line  from the clamp on [m], ten points at least.
StripShape strip_shape(const std::vector<Eigen::Vector2d>& line, double time);

/// Strain on the outside where the neutral axis is in the middle, [Krogh], Eq. (12), > 0 for a strip that
/// hangs down [-].
double outer_strain(const StripShape& shape, double share_of_length, double thickness);

/// [Krogh], Eq. (13): a t^b + c t^d.
struct DoublePowerLaw {
  double a = 0, b = 0, c = 0, d = 0;
  [[nodiscard]] double operator()(double t) const;
  [[nodiscard]] double rate(double t) const;
};

/// Least squares in relative terms: for each pair of powers a and c follow; the powers are sought on a grid that
/// is refined again and again.
/// @param time  > 0 [s], four at least.
DoublePowerLaw fit_double_power(const std::vector<double>& time, const std::vector<double>& value);

/// Transverse shear modulus from the slope at the clamp, [Krogh], Eq. (14) [Pa]. @param load  [N/m^2].
double transverse_shear_modulus(double root_slope, double length, double load, double thickness);

}  // namespace drapeplan
