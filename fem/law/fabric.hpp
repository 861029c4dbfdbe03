// The woven fabric: nominal stress over strain along the fibres, and shear stress over shear angle.
#pragma once

#include <cstddef>
#include <tuple>
#include <utility>
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

inline auto fields_of(const Curve& of) {
  const auto& [strain, stress] = of;
  return std::tie(strain, stress);
}

/// Stress over strain at one or several rates: linear in strain along each curve, linear in
/// log(1 + rate / floor) between curves, which is the logarithm of the rate for rates far above the floor and
/// the rate itself far below (so that a curve measured at rest, rate 1e-15/s, is met at rest). Slower than
/// the slowest and faster than the fastest curve the stress does not change further.
struct StressTable {
  std::vector<Curve> curves;  ///< at least one; by rate; none is below a slower one
  std::vector<double> rates;  ///< of the curves [1/s], increasing; empty for one curve: no dependence

  StressTable() = default;
  StressTable(Curve curve)
      : curves{std::move(curve)} {}  // NOLINT(google-explicit-constructor): a table of one

  [[nodiscard]] bool rate_dependent() const { return curves.size() > 1; }
  [[nodiscard]] const Curve& slowest() const { return curves.front(); }
  /// @param rate  of growth [1/s], >= 0;  @param floor  [1/s], > 0.
  [[nodiscard]] double operator()(double strain, double rate, double floor) const;
};

inline auto fields_of(const StressTable& of) {
  const auto& [curves, rates] = of;
  return std::tie(curves, rates);
}

/// How the shear stress of the table is measured.
enum class ShearMeasure {
  conjugate,  ///< stress times rate of the shear angle is power per volume
  force,      ///< shear force per length over thickness, F_sh / t of [Krogh], Eq. (10); conjugate / cos g
};

/// Ply material. Modes are decoupled, as in [Krogh] ("Transient Nonlinear Finite Element Model").
struct Fabric {
  double thickness = 0;      ///< [m]
  double areal_density = 0;  ///< [kg/m^2]
  StressTable tension;       ///< fibre, over nominal strain
  StressTable compression;   ///< fibre, magnitudes
  StressTable shear;         ///< over the shear angle [rad]; odd
  ShearMeasure shear_measure = ShearMeasure::conjugate;
  double transverse_shear_modulus = 0;  ///< G13 = G23 [Pa]
  double rate_floor = 1e-3;             ///< slower rates count linearly, see StressTable [1/s]
  double rate_filter = 0.02;            ///< time constant over which rates are averaged [s]

  [[nodiscard]] bool rate_dependent() const {
    return tension.rate_dependent() || compression.rate_dependent() || shear.rate_dependent();
  }
};

inline auto fields_of(const Fabric& of) {
  const auto& [thickness, areal_density, tension, compression, shear, shear_measure, transverse_shear_modulus,
               rate_floor, rate_filter] = of;
  return std::tie(thickness, areal_density, tension, compression, shear, shear_measure,
                  transverse_shear_modulus, rate_floor, rate_filter);
}

}  // namespace drapeplan
