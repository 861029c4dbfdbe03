// The gripper rig in motion: rigid pads tied to ply nodes, joints, actuators, interlinks, tilt stops.
//
// A pad is a rigid body with an isotropic inertia (so that it has no gyroscopic moment) that owns the nodes
// under it. Its joint stands off along the pad's normal. The joint's height follows the schedule through a
// critically damped spring with a force limit; interlinks and the fixed joint are constraints, met at the end
// of every step by impulses along the directions at its start (SHAKE: Ryckaert, Ciccotti and Berendsen 1977)
// with Newton's method.
#pragma once

#include <array>
#include <vector>

#include "fem/rig.hpp"
#include "fem/schedule.hpp"
#include "fem/snapshot.hpp"
#include "fem/state.hpp"

namespace drapeplan {

/// Scratch of one run: sums over tied nodes, free and mean velocities, the constraint system.
struct RigScratch {
  std::vector<Eigen::Vector3d> force, moment;  ///< in: on tied nodes and their directors [N], [N m]
  std::vector<Eigen::Vector3d> mean_v,
      mean_w;                  ///< out: means of the half-step velocities of tied nodes and directors
  std::vector<PadState> next;  ///< pads with their velocities at t + dt/2
  std::vector<Eigen::Vector3d> arm, next_arm;  ///< joints from their pads' centres at t and t + dt [m]
  std::vector<Eigen::Vector3d> free_mean_v,
      free_mean_w;                                ///< mean velocities before constraints: what damping sees
  std::vector<Eigen::Vector3d> stop, joint_v;     ///< moments of tilt stops [N m]; mean velocities of joints
  std::vector<double> actuator;                   ///< forces [N]
  std::vector<Eigen::Vector3d> direction;         ///< of each constraint row
  std::vector<double> residual, impulse, factor;  ///< of each row; envelope of the Cholesky factor
  bool converged = true;                          ///< every step so far met the constraints
};

/// The schedule as the simulation plays it.
struct RigDrive {
  const Schedule* schedule = nullptr;
  double time_scaling = 1;
};

class GripperRig {
 public:
  /// @param rest  ply frame places of all nodes [m];  @param mass, inertia  of nodes and directors, scaled
  /// [kg], [kg m^2]
  /// @param place  x-y of each joint in the flat start [m];  @param turn  of the ply frame from the world's
  /// x-y [rad]
  /// @throws std::invalid_argument if a pad has no node under it, or two pads share one.
  GripperRig(const RigOptions& rig, const std::vector<Eigen::Vector2d>& rest, const std::vector<double>& mass,
             const std::vector<double>& inertia, std::vector<Eigen::Vector2d> place, double turn);

  /// Nodes that move with pads, all of them.
  [[nodiscard]] const std::vector<int>& tied() const { return tied_; }

  /// How many times heavier than its tied nodes a pad is, in the motion in which it is least so (>= 1); for
  /// each node of tied(). A stiffness bound of nodes on their own masses holds on pads with masses that much
  /// larger.
  [[nodiscard]] std::vector<double> mass_ratios(const std::vector<double>& mass,
                                                const std::vector<double>& inertia) const;

  /// Puts pads into the state, the ply lying flat at height z [m].
  void place(State& state, double z) const;

  [[nodiscard]] RigScratch scratch() const;

  /// One step for the pads: from nodal forces to pad velocities at t + dt/2 that meet all constraints at t +
  /// dt. Books the work of damping (rate alpha), actuators, interlinks and stops into state.work, and the
  /// largest actuator force and link error into state.record.
  void kick(State& state, const RigDrive& drive, double alpha, RigScratch& scratch) const;

  /// Moves pads to t + dt and their nodes with them.
  void drift(State& state) const;

  [[nodiscard]] double kinetic_energy(const State& state) const;
  [[nodiscard]] Eigen::Vector3d joint(const PadState& pad) const {
    return pad.centre + pad.rotation * Eigen::Vector3d(0, 0, rig_.joint_offset);
  }
  /// Actuator force of gripper g for the state's positions and velocities [N], upwards > 0.
  [[nodiscard]] double actuator_force(const State& state, const RigDrive& drive, int g) const;
  void snapshot(const State& state, const RigDrive& drive, Snapshot& out) const;

 private:
  struct Pad {
    double mass = 0, inertia = 0;  ///< with the tied nodes [kg], [kg m^2]
    int first = 0, last = 0;       ///< range in tied_
  };
  /// A row of the constraint system: the joints i and j keep their distance, or joint i its coordinate
  /// `axis`.
  struct Row {
    int i = 0, j = -1, axis = -1;
    double value = 0;  ///< length or coordinate [m]
  };
  /// Rows k and l <= k of the constraint system share a pad; `sign` is +1 if it stands on the same side in
  /// both.
  struct Coupling {
    int k = 0, l = 0, pad = 0;
    double sign = 1;
  };

  void free_velocities(State& state, const RigDrive& drive, double alpha, RigScratch& scratch) const;
  void meet_constraints(State& state, RigScratch& scratch) const;
  void factorise(RigScratch& scratch) const;
  double residuals(const State& state, RigScratch& scratch) const;
  void push(RigScratch& scratch, int g, const Eigen::Vector3d& impulse) const;
  [[nodiscard]] Eigen::Vector3d stop_moment(const Eigen::Vector3d& normal) const;

  RigOptions rig_;
  std::vector<Pad> pads_;
  std::vector<int> tied_;
  std::vector<Eigen::Vector3d> offset_;  ///< of tied nodes in their pad's frame [m]
  std::vector<Row> rows_;
  std::vector<Coupling> couplings_;
  std::vector<int> envelope_;  ///< first column of each row of the factor
  std::vector<size_t> start_;  ///< where row k of the factor starts, less its first column
  std::vector<Eigen::Vector2d> place_;
  double turn_ = 0;
};

}  // namespace drapeplan
