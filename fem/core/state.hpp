// Everything that a run needs to continue, and nothing else.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "fem/core/fields.hpp"
#include "fem/core/lanes.hpp"

namespace drapeplan {

/// Books of work, one entry each. See Energies for their meaning.
enum class Book {
  internal,
  gravity,
  contact,
  friction,
  damping,
  actuator,
  interlink,
  stop,
  load,
  release,
  grip,
  fibre_inertia
};
inline constexpr size_t kBooks = 12;

/// A rigid pad: its centre on the ply's mid-surface, its orientation and its half-step velocities.
struct PadState {
  Eigen::Vector3d centre{0, 0, 0};
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity{0, 0, 0};          ///< at t - dt/2 [m/s]
  Eigen::Vector3d angular_velocity{0, 0, 0};  ///< at t - dt/2 [rad/s]
  bool released = false;                      ///< its nodes move on their own
};

/// The worst that a run has seen so far, at the instants at which it is watched.
struct RunRecord {
  double fibre_strain = 0;       ///< tension at mid-thickness [-]
  double fibre_compression = 0;  ///< magnitude [-]
  double actuator_force = 0;     ///< [N], every step
  double lag = 0;                ///< of a joint from its command while its pad touches nothing [m]
  double saturated = 0;          ///< how long some actuator was at its limit of force [s]
  double looked = 0;             ///< when the rig was last watched [s]
  double link_error = 0;         ///< of interlinks and guides [m], every step
  double penetration = 0;        ///< of the ply's underside into the mold [m]
  double energy = 0;             ///< largest magnitude of a book [J]
  double balance = 0;            ///< largest |balance| of the books [J]
  double hourglass_share = 0;    ///< stored hourglass energy over internal energy
  double kinetic_ratio = 0;      ///< kinetic energy of the ply's free nodes over internal energy
  double last_motion = 0;        ///< when the ply was last faster than the rest criterion [s]
};

/// Positions at t, velocities at t - dt_before / 2 (central differences with a changing step).
struct State {
  std::int64_t step = 0;
  double time = 0;            ///< [s], of the simulation
  double dt = 0;              ///< from t to the next positions [s]
  double dt_before = 0;       ///< from the last positions to t [s]
  double stable_dt = 0;       ///< stable step when dt was last chosen [s]
  VectorField position;       ///< nodes [m]
  VectorField velocity;       ///< nodes, at t - dt_before / 2 [m/s]
  VectorField director;       ///< nodes, unit
  VectorField director_rate;  ///< nodes, at t - dt_before / 2, normal to the directors [1/s]
  VectorField anchor;         ///< where a node sticks to the mold [m]; empty without friction
  std::vector<double> stuck;  ///< 1: the node touched, or was held, at the last step; empty without friction
  std::vector<double> history;  ///< what elements remember of their strains; see fem/shell/term.hpp
  /// Directions of edges along warp and weft when the step was last chosen, by their first nodes; empty
  /// without fibre inertia.
  std::array<VectorField, 2> edges;
  std::vector<PadState> pads;  ///< empty without a rig
  /// How the bounds of elements were spread over nodes when the step was last chosen [padded]: see
  /// CornerShares. Empty where one step is chosen for good.
  std::vector<double> lightness;
  std::array<double, kBooks> work{};  ///< done on the moving masses since the start [J]
  RunRecord record;
  double pressure = 0;  ///< of the press at t [Pa]
  /// The ply when pressing began, and what the run had seen until then; empty before, and without a press.
  VectorField unpressed_position, unpressed_director;
  RunRecord unpressed_record;

  /// Time from the half-step velocities before t to those after it [s].
  [[nodiscard]] double kick_time() const { return 0.5 * (dt_before + dt); }
};

/// What of a field the hash of a state counts.
enum class Hashed {
  all,
  nodes,  ///< the entries of nodes, not what pads them to whole lanes: that depends on the machine
  no,     ///< nothing: it is saved only
};

// The lists of fields: what saves, loads or hashes a state visits them. A field that is added and not bound
// does not compile.

/// Hands every field of a state to `visit(field, Hashed)`.
void visit_fields(EitherConst<State> auto& of, const auto& visit) {
  auto& [step, time, dt, dt_before, stable_dt, position, velocity, director, director_rate, anchor, stuck,
         history, edges, pads, lightness, work, record, pressure, unpressed_position, unpressed_director,
         unpressed_record] = of;
  visit(step, Hashed::all);
  visit(time, Hashed::all);
  visit(dt, Hashed::all);
  visit(dt_before, Hashed::all);
  visit(stable_dt, Hashed::all);
  visit(position, Hashed::nodes);
  visit(velocity, Hashed::nodes);
  visit(director, Hashed::nodes);
  visit(director_rate, Hashed::nodes);
  visit(anchor, Hashed::nodes);
  visit(stuck, Hashed::nodes);
  visit(history, Hashed::all);
  visit(pads, Hashed::all);
  visit(work, Hashed::all);
  visit(edges, Hashed::no);      // other directions give other velocities one step later
  visit(lightness, Hashed::no);  // another one gives another stable_dt when the step is next chosen
  visit(record, Hashed::no);     // what a run has seen: no motion depends on it
  visit(pressure, Hashed::no);   // follows from the time
  visit(unpressed_position, Hashed::no);
  visit(unpressed_director, Hashed::no);
  visit(unpressed_record, Hashed::no);
}

/// Hands every field of a pad to `visit(field)`.
void visit_fields(EitherConst<PadState> auto& of, const auto& visit) {
  auto& [centre, rotation, velocity, angular_velocity, released] = of;
  visit(centre), visit(rotation.coeffs()), visit(velocity), visit(angular_velocity), visit(released);
}

/// Hands every figure of a record to `visit(figure)`.
void visit_fields(EitherConst<RunRecord> auto& of, const auto& visit) {
  auto& [fibre_strain, fibre_compression, actuator_force, lag, saturated, looked, link_error, penetration,
         energy, balance, hourglass_share, kinetic_ratio, last_motion] = of;
  for (auto* figure :
       {&fibre_strain, &fibre_compression, &actuator_force, &lag, &saturated, &looked, &link_error,
        &penetration, &energy, &balance, &hourglass_share, &kinetic_ratio, &last_motion}) {
    visit(*figure);
  }
}

/// FNV-1a over all fields that are Hashed.
std::uint64_t hash_state(const State& state, int node_count);

}  // namespace drapeplan
