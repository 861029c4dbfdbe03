// Everything that a run needs to continue, and nothing else.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "fem/lanes.hpp"

namespace drapeplan {

/// Books of work, one entry each. See Energies for their meaning.
enum class Book { internal, gravity, contact, friction, damping, actuator, interlink, stop, grip };
inline constexpr size_t kBooks = 9;

/// A rigid pad: its centre on the ply's mid-surface, its orientation and its half-step velocities.
struct PadState {
  Eigen::Vector3d centre{0, 0, 0};
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity{0, 0, 0};          ///< at t - dt/2 [m/s]
  Eigen::Vector3d angular_velocity{0, 0, 0};  ///< at t - dt/2 [rad/s]
};

/// Positions at t, velocities at t - dt/2 (central differences).
struct State {
  std::int64_t step = 0;
  double time = 0;             ///< [s], of the simulation
  VectorField x, v;            ///< nodes [m], [m/s]
  VectorField d, w;            ///< unit directors and their rate of change, normal to them [1/s]
  VectorField anchor;          ///< where a node sticks to the mold [m]; empty without friction
  std::vector<double> stuck;   ///< 1: the node touched the mold at the last step; empty without friction
  std::vector<PadState> pads;  ///< empty without a rig
  std::array<double, kBooks> work{};  ///< done on the moving masses since the start [J]
};

/// FNV-1a over all bits of the state that belong to nodes and pads (padding left out).
std::uint64_t hash_state(const State& state, int node_count);

}  // namespace drapeplan
