// Loads that are given from outside: constant forces, moments and area loads.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <tuple>
#include <vector>

#include "fem/core/term.hpp"

namespace drapeplan {

/// A vector on one node, world frame.
struct NodalLoad {
  int node = 0;
  Eigen::Vector3d value{0, 0, 0};
};

inline auto fields_of(const NodalLoad& of) {
  const auto& [node, value] = of;
  return std::tie(node, value);
}

/// Dead loads: they act in full from the first step on and keep their direction.
///
/// A moment M turns the director d about a fixed axis: on d it is m = M x d, whose power m . dd/dt is M times
/// the director's angular velocity. It follows d, so it has an energy (- |M| times the angle) only as long as
/// the director turns in the plane normal to M; otherwise its work depends on the path.
struct Loads {
  std::vector<NodalLoad> forces{};    ///< [N]; several of one node add
  std::vector<NodalLoad> moments{};   ///< on directors [N m]; several of one node add
  Eigen::Vector3d pressure{0, 0, 0};  ///< force per rest area of the ply [Pa]
};

inline auto fields_of(const Loads& of) {
  const auto& [forces, moments, pressure] = of;
  return std::tie(forces, moments, pressure);
}

/// @param area  rest area of each node [m^2]
/// @throws WrongInput if a load's node does not exist or its value is not finite.
std::unique_ptr<Term> make_loads(const Loads& loads, const std::vector<double>& area);

}  // namespace drapeplan
