// Contact of the ply with the mold, and the ply's weight.
#pragma once

#include <memory>
#include <optional>

#include "fem/term.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// Node-to-mold contact by a stiff normal spring; with a coefficient also anchored Coulomb friction: a node
/// that touches drops an anchor and is held by an equally stiff tangential spring; the anchor is dragged
/// where the force would exceed coefficient times normal force. Exact stick, no creep; path dependent.
/// @param stiffness  per node [N/m];  @param surface  distance of the touching face from the nodes [m] (half
/// the ply).
std::unique_ptr<Term> make_contact(const Mold& mold, std::optional<double> friction,
                                   std::vector<double> stiffness, double surface);

/// Weight of the unscaled mass. @param mass  per node [kg];  @param acceleration  downwards [m/s^2].
std::unique_ptr<Term> make_gravity(const std::vector<double>& mass, double acceleration);

}  // namespace drapeplan
