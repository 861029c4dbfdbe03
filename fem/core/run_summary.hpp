// Why a run ended, how it went and where its energy is.
#pragma once

#include <cstdint>
#include <string>

namespace drapeplan {

/// What a scene has that some figures measure; where it is absent, the figures are 0 and are not written.
struct SummaryParts {
  bool external = true;    ///< gravity, loads, actuators or grips
  bool contact = true;     ///< a mold
  bool friction = true;    ///< with friction
  bool damping = true;     ///< mass damping
  bool constraint = true;  ///< a rig: interlinks, guides, tilt stops
  bool links = true;       ///< interlinks or a fixed joint
};

/// Books of one run [J]. Work is booked per term with the mean of the two half-step velocities, so that
/// kinetic = external - internal - friction - contact - damping - constraint closes to round-off.
struct Energies {
  double kinetic = 0;        ///< that of fibre inertia included
  double internal = 0;       ///< work done on the fabric, its hourglass part included
  double external = 0;       ///< work of gravity, loads, actuators and grips
  double friction = 0;       ///< taken by friction, its elastic part included
  double contact = 0;        ///< stored by normal contact and taken by its dashpots
  double damping = 0;        ///< taken by mass damping
  double constraint = 0;     ///< taken by interlinks, guides, tilt stops and the release of pads
  double hourglass = 0;      ///< stored in hourglass modes; part of `internal`
  double largest = 0;        ///< largest magnitude that any entry reached
  double balance_error = 0;  ///< largest |balance| over the run / largest
};

enum class RunStatus { done, diverged, paused };

struct RunSummary {
  RunStatus status = RunStatus::done;
  std::string message;  ///< why it ended
  SummaryParts parts;
  std::int64_t steps = 0;
  double dt = 0;              ///< mean step [s], of the simulation
  double simulated_time = 0;  ///< [s], of the simulation (schedule time / time scaling)
  double wall_seconds = 0;
  double element_updates_per_second = 0;
  Energies energy;
  /// Kinetic energy of the ply's free nodes over internal energy at the end of each tenth, from the second
  /// on.
  double largest_kinetic_ratio = 0;
  double largest_hourglass_share = 0;  ///< stored hourglass energy over internal energy, at the same instants
  double largest_penetration = 0;      ///< of the ply's underside below the mold over the run [m]
  double largest_link_error = 0;  ///< of an interlink's length or the fixed joint's place, over the run [m]
  std::uint64_t state_hash = 0;
};

}  // namespace drapeplan
