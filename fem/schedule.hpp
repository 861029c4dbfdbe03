// What each gripper is told to do: its joint's height over time.
#pragma once

#include <vector>

namespace drapeplan {

/// A point of a gripper's path; between knots the height is linear in time.
struct Knot {
  double time = 0;  ///< [s]
  double z = 0;     ///< commanded height of the joint, world frame [m]
};

/// Height and vertical velocity at an instant.
struct Command {
  double z = 0;   ///< [m]
  double vz = 0;  ///< [m/s]
};

/// A draping sequence: pure value, one path per gripper, in the order of the grid (x fastest).
/// The commanded height is the moving average of the path over the last `blend_time`, so that velocities
/// change at a finite acceleration; a path starts and ends at rest.
struct Schedule {
  std::vector<std::vector<Knot>> paths;  ///< times increasing from 0; at least one knot each
  double blend_time = 0;                 ///< [s]

  /// Command of gripper g at time t [s]; before the first and after the last knot the path is at rest.
  [[nodiscard]] Command command(int gripper, double t) const;
  /// Time of the last knot, and the blend after it [s].
  [[nodiscard]] double duration() const;
  /// When the last commanded motion ends; then all joints rest [s].
  [[nodiscard]] double last_motion() const;
  /// Largest |vz| over all grippers [m/s].
  [[nodiscard]] double largest_velocity() const;
};

}  // namespace drapeplan
