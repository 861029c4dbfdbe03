// Numerical settings of one FE run: a fidelity is a value of this type.
#pragma once

#include <cmath>
#include <tuple>

namespace drapeplan {

/// Of the numbers in which the shell's forces are computed; all else is in double.
enum class Precision { double_lanes, single_lanes };

struct FemOptions {
  double mesh_size = 0.010;  ///< largest element edge [m]
  int section_points = 3;    ///< through the thickness: 1, 3 or 5
  double mass_scaling = 20;  ///< factor on the mass; gravity acts on the unscaled mass ([Krogh]: up to 20)
  /// The step may be this many times longer: mass is added to the stretch of fibres alone.
  double fibre_mass_scaling = 1;
  double target_step = 0;    ///< mass is added where the step would be smaller [s]; 0: nowhere
  double time_scaling = 1;   ///< the schedule is played this many times faster than written
  double step_safety = 0.9;  ///< share of the estimated stable step
  int step_interval = 32;    ///< steps between two choices of the step; 0: one step, safe for all strains
  bool rates = true;         ///< false: slowest curves only, whatever tables the material has
  Precision precision = Precision::double_lanes;  ///< of the shell's forces; the rest is in double
  /// Across each fibre at mid-thickness: 1 or 2; with 1 only hourglass control is left.
  int fibre_points = 2;
  /// In-plane hourglass stiffness over that of a bilinear element of fibre in compression; directors have the
  /// full one.
  double hourglass = 0.005;
  /// Damping ratio along the fibres at the highest frequency. A fibre that is stiffer in tension than in
  /// compression is a spring with two stiffnesses, which central differences feed in narrow windows of the
  /// step from 0.4 of the stable one on. With a ratio of 0.1 and up to 0.95 of the stable step (which the
  /// ratio lowers to 0.905) none is left, whatever the two stiffnesses (scanned: tests/bench/fem.md).
  double bulk_viscosity = 0.1;
  double contact_stiffness = 0.05;  ///< of a free node, over its membrane stiffness
  double contact_damping = 0.2;     ///< share of the critical damping of a node on its contact spring
};

inline auto fields_of(const FemOptions& of) {
  const auto& [mesh_size, section_points, mass_scaling, fibre_mass_scaling, target_step, time_scaling,
               step_safety, step_interval, rates, precision, fibre_points, hourglass, bulk_viscosity,
               contact_stiffness, contact_damping] = of;
  return std::tie(mesh_size, section_points, mass_scaling, fibre_mass_scaling, target_step, time_scaling,
                  step_safety, step_interval, rates, precision, fibre_points, hourglass, bulk_viscosity,
                  contact_stiffness, contact_damping);
}

/// Stable step with a damping ratio at the highest frequency, velocities half a step late, over that without.
inline double viscous_share(double ratio) {
  return std::sqrt(1 + ratio * ratio) - ratio;
}

/// A ply is at rest when its r.m.s. speed has stayed below `speed` for the time `hold` (simulation's clock).
struct RestCriterion {
  double speed = 1e-4;  ///< [m/s]
  double hold = 0.1;    ///< [s]
};

inline auto fields_of(const RestCriterion& of) {
  const auto& [speed, hold] = of;
  return std::tie(speed, hold);
}

}  // namespace drapeplan
