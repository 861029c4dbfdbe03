// The gripper rig in motion: rigid pads tied to ply nodes, joints, actuators, interlinks, rotation limits.
//
// A pad is a rigid body with an isotropic inertia (so that it has no gyroscopic moment) that owns the nodes
// under it, until its suction ends: then they move on their own and the pad goes on with its own mass. Its
// joint stands off along the pad's normal and follows the schedule through critically damped springs with a
// force limit, in z or in x, y and z. Interlinks and the fixed joint are constraints (interlinks.hpp).
#pragma once

#include <array>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/core/state.hpp"
#include "fem/rig/interlinks.hpp"
#include "fem/rig/rig.hpp"
#include "fem/rig/rotation_stop.hpp"
#include "fem/rig/schedule.hpp"

namespace drapeplan {

/// What pads and their nodes tell each other in a step; other nodes are left alone.
struct TiedFields {
  const VectorField &force, &moment;  ///< on nodes and directors [N], [N m]
  VectorField &mean_v, &mean_w;       ///< means of the half-step velocities [m/s], [1/s]
};

/// Scratch of one run: free and mean velocities, the constraint system.
struct RigScratch {
  /// Mean velocities of pads before constraints: what damping sees.
  std::vector<Eigen::Vector3d> free_v, free_w;
  std::vector<Eigen::Vector3d> stop, joint_v;  ///< moments of stops [N m]; mean velocities of joints
  std::vector<Eigen::Vector3d> actuator;       ///< forces [N]
  LinkScratch links;
  bool converged = true;  ///< every step so far met the constraints
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
  /// @throws WrongInput if a pad has no node under it, or two pads share one.
  GripperRig(const RigOptions& rig, const std::vector<Eigen::Vector2d>& rest, const std::vector<double>& mass,
             const std::vector<double>& inertia, std::vector<Eigen::Vector2d> place, double turn);

  /// Nodes that move with pads, all of them.
  [[nodiscard]] const std::vector<int>& tied() const { return tied_; }
  /// Those of each pad.
  [[nodiscard]] std::vector<std::vector<int>> tied_by_pad() const;

  /// @throws WrongInput if a schedule is not one for this rig in its flat start.
  void check(const Schedule& schedule) const;

  /// How many times heavier than its tied nodes a pad is, in the motion in which it is least so (>= 1); for
  /// each node of tied(). A stiffness bound of nodes on their own masses holds on pads with masses that much
  /// larger.
  [[nodiscard]] std::vector<double> mass_ratios(const std::vector<double>& mass,
                                                const std::vector<double>& inertia) const;

  /// Puts pads into the state, the ply lying flat at height z [m].
  void place(State& state, double z) const;

  [[nodiscard]] RigScratch scratch() const;

  /// Pads whose suction has ended let go of their nodes; before the step's forces, since fibre inertia
  /// must not pull at a light node as at a pad. Books the difference of kinetic energy.
  void let_go(State& state, const RigDrive& drive) const;

  /// One step for the pads: from nodal forces to pad velocities at t + dt/2 that meet all constraints at t +
  /// dt. Books the work of damping (rate alpha), actuators, interlinks and stops into state.work, and the
  /// largest actuator force and link error into state.record. Needs what kick_nodes has done to the
  /// velocities of tied nodes: damping alone.
  void kick(State& state, const RigDrive& drive, double alpha, const TiedFields& tied,
            RigScratch& scratch) const;

  /// Moves pads to t + dt and their nodes with them.
  void drift(State& state) const;

  [[nodiscard]] double kinetic_energy(const State& state) const;
  /// How far the joint of gripper g is from its command, in the driven directions [m].
  [[nodiscard]] double lag(const State& state, const RigDrive& drive, int g) const;
  /// Whether an actuator of gripper g gives all the force that it has.
  [[nodiscard]] bool saturated(const State& state, const RigDrive& drive, int g) const;
  [[nodiscard]] Eigen::Vector3d joint(const PadState& pad) const {
    return pad.centre + pad.rotation * Eigen::Vector3d(0, 0, rig_.joint_offset);
  }
  /// Actuator force of gripper g for the state's positions and velocities [N]; z upwards.
  [[nodiscard]] Eigen::Vector3d actuator_force(const State& state, const RigDrive& drive, int g) const;
  void snapshot(const State& state, const RigDrive& drive, Snapshot& out) const;

 private:
  /// Up to kLanes nodes of a pad that follow each other.
  struct Patch {
    size_t at = 0;           ///< first node
    Lanes tied{0.0};         ///< 1 for lanes of the pad, 0 for others
    Lanes offset1, offset2;  ///< in the pad's frame [m]
  };
  struct Pad {
    double mass = 0, inertia = 0;            ///< with the tied nodes [kg], [kg m^2]
    double bare_mass = 0, bare_inertia = 0;  ///< of the pad alone
    int first = 0, last = 0;                 ///< range in tied_
    std::vector<Patch> patches;              ///< the same nodes
    [[nodiscard]] double mass_of(const PadState& pad) const { return pad.released ? bare_mass : mass; }
    [[nodiscard]] double inertia_of(const PadState& pad) const {
      return pad.released ? bare_inertia : inertia;
    }
  };
  struct Tied {
    Eigen::Vector3d offset;        ///< in the pad's frame [m]
    double mass = 0, inertia = 0;  ///< of node and director [kg], [kg m^2]
  };

  void lay_patches(Pad& pad) const;
  void free_velocities(State& state, const RigDrive& drive, double alpha, const TiedFields& tied,
                       RigScratch& scratch) const;
  void book_pad(State& state, size_t g, double alpha, const TiedFields& tied, RigScratch& scratch) const;
  void kick_released(State& state, const Pad& body, double alpha, const TiedFields& tied) const;
  [[nodiscard]] double kinetic_energy(const State& state, size_t g) const;

  RigOptions rig_;
  std::vector<Pad> pads_;
  std::vector<int> tied_;
  std::vector<Tied> nodes_;  ///< in the order of tied_
  LinkSystem links_;
  RotationStop stop_;
  std::vector<Eigen::Vector2d> place_;
  double turn_ = 0;
};

}  // namespace drapeplan
