// Contact of the ply with the mold, and the ply's weight.
#pragma once

#include <memory>
#include <optional>
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

/// Node-to-mold contact: springs with dashpots. The gap is the distance to the tangent plane at the foot of
/// the perpendicular (one step of Newton's method, 1e-11 m and 1e-6 rad on the article's mold); the force
/// acts along the normal there, and presses only: max(0, -stiffness gap - damping v_n). With a coefficient
/// also anchored Coulomb friction: a node is held by an equal spring and dashpot at its anchor; where they
/// would exceed coefficient times normal force, the anchor is dragged. A node that touches anew drops its
/// anchor where its path crossed the surface, so that friction acts at once: it sticks if it came in steeper
/// than the friction angle. Exact stick, no creep; path dependent.
/// @param surface  distance of the touching face from the nodes [m] (half the ply).
/// @param released  for nodes of pads; empty without a rig.
/// @param look_ahead  steps for which a tangent must hold: it counts nodes that may touch in as many.
std::unique_ptr<Term> make_contact(const Mold& mold, std::optional<double> friction, ContactSprings springs,
                                   double surface, int look_ahead = 0, ReleasedSprings released = {});

/// Weight of the unscaled mass. @param mass  per node [kg];  @param acceleration  downwards [m/s^2].
std::unique_ptr<Term> make_gravity(const std::vector<double>& mass, double acceleration);

}  // namespace drapeplan
