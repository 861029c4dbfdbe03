// Fibre compression from cantilevers: the inverse bending model. [Krogh], "Cantilever Test".
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "planner/case/case.hpp"
#include "planner/tables/smooth.hpp"

namespace drapeplan {

/// A strip on its way down.
struct TipHistory {
  double length = 0, width = 0;   ///< free length and width [m]
  std::vector<double> time, tip;  ///< [s], drop of the tip [m]
};

/// A strip that is let go, clamped on its left: a case whose fidelity "report" has cells of a quarter of its width.
/// Its weight is damped as [Krogh] damps a strip (critically), by the drop at rest that a strip of this fabric has.
/// @param length, width  free length and width [m].  @param gravity  [m/s^2].  @param section_points  of the fidelity.
/// @throws NotFinished for a strip so soft that it hangs down straight.
Case falling_strip(const Fabric& fabric, double length, double width, double gravity, int section_points);

/// The compression curve that is scaled: the slope of tension up to 0.1 % of strain, beyond it 0.5 GPa (the
/// break comes from tows that buckle).
Curve master_compression(const Curve& tension);

/// Drops at rest of a strip over the scale of its compression curve, each from a simulation.
struct BendingModel {
  std::vector<double> scale;  ///< increasing
  std::vector<double> tip;    ///< [m], decreasing
  /// The scale of a drop. @throws NotFinished for a drop beyond those that were simulated.
  [[nodiscard]] double scale_of(double tip) const;
};

/// Simulates twelve strips with scales from 0.02 to 10 side by side, and one more for each drop that is sought: between
/// two of the twelve the drop is known to some percent only.
/// @param fabric  with tension; its compression is replaced.  @param gravity  [m/s^2].  @param section_points  of the
/// simulations: a curve that breaks is seen at few points only, which makes strips softer or stiffer than they are.
/// @param sought  drops [m].
/// @throws NotFinished if one of them does not come to rest, or if a drop that is sought lies beyond those of the twelve.
BendingModel bending_model(Fabric fabric, const Curve& master, double length, double width, double gravity,
                           int section_points, int threads, const std::vector<double>& sought);

struct CompressionLaw {
  Curve master;
  std::vector<double> factors;  ///< of the master, slowest rate first
  std::vector<double> rates;    ///< of the strain [1/s]; the first is that of rest, 1e-15
  std::vector<double> times;    ///< at which the strip had the drop of each [s]
  double largest_strain = 0;    ///< outside at the clamp, of the strip at rest [-]
  BendingModel model;
  double first_tip = 0;         ///< at 0.4 s [m]
  double static_tip = 0;        ///< [m]
  double stiffness = 0;         ///< D of the isotropic strip with this drop [N m]
  double frequency = 0;         ///< omega_1 of Eq. (5) [1/s]
  double alpha = 0;             ///< of Eq. (4), critical damping [1/s]
};

/// Six curves: the first from the drop at 0.4 s, the last from the drop at rest, with a rate of 1e-15/s; four
/// with factors at equal distances between. The rate of each is that of the strain outside at the clamp at the time at
/// which the strip had the drop that belongs to the factor. Nothing is extrapolated. [Krogh] takes this strain from the
/// curvature of the picture's midline, which is least certain at the clamp; here it is that of the strip at rest with
/// the factor of each drop, since the strip creeps: a midline reads rates too low, which makes curves up to 16 % too
/// stiff.
/// @param history  that starts at 0.4 s or before; its largest drop is taken to be that at rest.
/// @throws NotFinished if the history does not span this.
CompressionLaw compression_law(const TipHistory& history, const Fabric& fabric, double gravity, int section_points,
                               int threads);

}  // namespace drapeplan
