// Hard limits of a pad's rotation.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "fem/rig/rig.hpp"

namespace drapeplan {

/// Stops a pad at its tilt limit and at the limits of its rotation about the warp and the weft axis. Each
/// stop is a spring with critical damping that only pushes back, never pulls. Its frequency is a fixed share
/// of what the step allows, so that it is as hard as the pad's inertia permits, whatever the step.
class RotationStop {
 public:
  /// @param turn  of the ply frame from the world's x-y in the flat start [rad].
  RotationStop(const RigOptions& rig, double turn);

  /// One step of a pad.
  struct Kick {
    Eigen::Vector3d normal;  ///< of the pad at t, unit
    Eigen::Vector3d before;  ///< angular velocity at t - dt/2 [rad/s]
    double inertia = 0;      ///< [kg m^2]
    double dt = 0;           ///< between the half-step velocities [s]
    double gain = 0;         ///< dt / (1 + alpha dt / 2): what a moment changes inertia * velocity by [s]
  };
  /// Adds to `after`, the angular velocity at t + dt/2 without stops [rad/s]. Returns the moment [N m].
  Eigen::Vector3d stop(const Kick& kick, Eigen::Vector3d& after) const;

 private:
  /// How far beyond a limit [rad], and its gradient for a turn of the pad.
  struct Limit {
    double excess = 0;
    Eigen::Vector3d gradient{0, 0, 0};
  };
  template <class Visit>
  void for_each_limit(const Eigen::Vector3d& normal, Visit visit) const;

  double tilt_limit_, cosine_;
  std::optional<RotationLimits> limits_;
  Eigen::Vector3d warp_, weft_;
};

}  // namespace drapeplan
