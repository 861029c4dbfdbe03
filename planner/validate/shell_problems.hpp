// Published problems of shells and strips, and their solutions by elements: tests of verification play them,
// too.
#pragma once

#include <array>
#include <cmath>

#include "fem/model/model.hpp"
#include "fem/run/workspace.hpp"

namespace drapeplan {

/// An isotropic sheet without lateral contraction: G = E / 2, in the section too.
struct Sheet {
  double modulus = 1, thickness = 1, density = 1;  ///< [Pa], [m], [kg/m^2]
  double compression_share = 1;                    ///< modulus in compression over that in tension

  [[nodiscard]] Fabric fabric() const;
  /// Per width [N m]. With two moduli the neutral line lies where no force is left:
  /// D = t^3/12 4 Et Ec / (sqrt(Et) + sqrt(Ec))^2 (S. P. Timoshenko, Strength of Materials, part II).
  [[nodiscard]] double bending_stiffness() const;
  /// Angular frequency of a mode that would be `number` / length^2 * sqrt(D / density) [1/s].
  [[nodiscard]] double frequency(double number, double length) const {
    return number * std::sqrt(bending_stiffness() / density) / (length * length);
  }
};

/// First bending frequency of a clamped-free strip: 1.8751^2.
inline constexpr double kCantilever = 3.516;

/// A strip of n elements along x from 0 to `length`, clamped at 0; its tip nodes are n and 2 n + 1. The
/// damping is critical for the lowest bending mode.
Scene cantilever(const Sheet& sheet, double length, double width, int n);

/// Forces, kicks, drifts: one step of the time loop, without books and rig.
void advance(const Model& model, State& state, Workspace& work);

/// Plays the scene from `state` until it rests: with a damping near critical for the lowest mode, a node
/// still has about v / (alpha / 2) to go; this is below `remainder` [m] for all nodes at twenty looks one
/// after the other, spread over two time constants.
/// @throws NotFinished if it does not come to rest.
void settle(const Model& model, State& state, double remainder);
/// The same from the flat ply.
State at_rest(const Model& model, double remainder);

/// Where the tip of a cantilever is, over its length.
struct TipPlace {
  double along = 0, up = 0;
};

/// Under a dead force k D / L^2 per width at the tip, upwards. @param n  elements.
/// Source: K. Y. Sze, X. H. Liu, S. H. Lo, "Popular benchmark problems for geometric nonlinear analysis of
/// shells" (Finite Elem. Anal. Des. 40, 2004), section 3.1.
TipPlace under_tip_force(double k, int n);
/// Under the moment 2 pi D / L at the tip, which closes the circle. Source: the same, section 3.2.
TipPlace under_tip_moment(int n);
/// Tip drop over length under a weight of beta D / L^3 per area.
/// @param ratio  modulus in tension over that in compression.  @param points  through the thickness.
double drop_under_weight(double beta, int n, double ratio = 1, int points = 3);

/// Bending stiffness of a strip with two moduli, seen at the tip under a small moment, over the exact one.
/// @param points  through the thickness.  @param ratio  modulus in tension over that in compression.
double stiffness_of_two_moduli(double ratio, int points);

/// Deflections of the loaded edge's inner and outer ends (W_A, W_B) of the slit annular plate: radii 6 and
/// 10, E = 21e6, nu = 0, thickness 0.03, a dead line load of 0.8 per length. Source: Sze, Liu, Lo (2004),
/// section 3.4. The hourglass stiffness is 0.01 and each fibre is looked at in one point across it: edges of
/// an element that bends around an oblique axis are chords of different arcs, and a full in-plane stiffness
/// resists that (membrane locking, about (curvature h^2 / t)^2 / 48).
std::array<double, 2> lifted_annulus(int across, int around);

enum class PlateEdge { supported, clamped };
enum class PlateLoad { uniform, central };
/// Deflection at the middle of a square plate of n x n elements, in units of q a^4 / D or P a^2 / D. It is
/// scaled to a thousandth of the thickness, so that membrane forces do not count.
/// @param expected  the result, about.
double plate_deflection(PlateEdge edge, PlateLoad load, int n, double expected);

}  // namespace drapeplan
