// Contact of the ply with the mold, and the ply's weight.
#pragma once

#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "fem/core/term.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// Steepest slope that can be touched (84 degrees): at a vertical wall a height field has no distance.
inline constexpr double kSteepestContact = 10;

/// Of each node, the same along the mold's normal and in its tangent plane.
struct ContactSprings {
  std::vector<double> stiffness;  ///< [N/m]
  std::vector<double> damping;    ///< [N s/m]
};

/// Springs of the nodes of pads once these have let go: a spring for a heavy pad would throw a light node.
struct ReleasedSprings {
  std::vector<std::vector<int>> nodes;  ///< of each pad; empty without a rig
  ContactSprings springs;               ///< of all nodes
};

/// What holds the ply to the mold where it has touched it.
struct Tack {
  double stress = 0;  ///< [Pa]
  /// How far a node may be pulled off before its bond breaks [m]. Assumed: about the resin that lies on a
  /// prepreg of 0.3 mm. With the stress it gives the work of adhesion per area: 3 J/m^2 for 30 kPa.
  double reach = 1e-4;
};

inline auto fields_of(const Tack& of) {
  const auto& [stress, reach] = of;
  return std::tie(stress, reach);
}

/// The same for each node.
struct NodalTack {
  std::vector<double> force;  ///< [N]
  double reach = 0;           ///< [m]
};

/// Node-to-mold contact: springs with dashpots. The gap is the distance to the tangent plane at the foot of
/// the perpendicular (one step of Newton's method, 1e-11 m and 1e-6 rad on the article's mold); the force
/// acts along the normal there, and presses only: max(0, -stiffness gap - damping v_n). With a coefficient
/// also anchored Coulomb friction: a node is held by an equal spring and dashpot at its anchor; where they
/// would exceed coefficient times normal force, the anchor is dragged. A node that touches anew drops its
/// anchor where its path crossed the surface, so that friction acts at once: it sticks if it came in steeper
/// than the friction angle. Exact stick, no creep; path dependent.
///
/// With tack a node that has touched is bonded: its spring pulls it back as it presses, up to the tack's
/// force; with this force it yields until it is `reach` off the mold, or as far as its spring needs to have
/// the force. There the bond breaks, and the node must touch again to have a new one. Bonds add their force
/// to the limit of friction. Pulling off takes force times (reach - half the spring's part), whatever the
/// path. Stress times area: it does not depend on the mesh, but a peeling edge takes the work of adhesion
/// only where its front, (bending stiffness reach / stress)^(1/4) long, spans some elements; with longer ones
/// it takes more, up to the stress times their length.
/// @param surface  distance of the touching face from the nodes [m] (half the ply).
/// @param released  for nodes of pads; empty without a rig.
/// @param look_ahead  steps for which a tangent must hold: it counts nodes that may touch in as many.
/// @param tack  with friction only.
std::unique_ptr<Term> make_contact(const Mold& mold, std::optional<double> friction, ContactSprings springs,
                                   double surface, int look_ahead = 0, ReleasedSprings released = {},
                                   std::optional<NodalTack> tack = {});

/// Weight of the unscaled mass. @param mass  per node [kg];  @param acceleration  downwards [m/s^2].
std::unique_ptr<Term> make_gravity(const std::vector<double>& mass, double acceleration);

}  // namespace drapeplan
