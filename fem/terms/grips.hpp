// Grips: rigid clamps that hold nodes of the ply and move them, as the jaws of a test machine do.
#pragma once

#include <Eigen/Core>
#include <string>
#include <tuple>
#include <vector>

namespace drapeplan {

/// Positions and directors of the nodes are held; the whole clamp translates.
struct Grip {
  std::string name;
  std::vector<int> nodes;
  /// Reached at the end of the ramp, world frame [m/s] of the schedule's clock.
  Eigen::Vector3d velocity{0, 0, 0};
  double ramp = 0.1;  ///< from rest to `velocity`, with continuous acceleration at both ends [s]
};

/// Without its name, which changes no result.
inline auto fields_of(const Grip& of) {
  const auto& [name, nodes, velocity, ramp] = of;
  return std::tie(nodes, velocity, ramp);
}

}  // namespace drapeplan
