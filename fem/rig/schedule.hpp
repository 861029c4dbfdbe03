// What each gripper is to do: where its joint goes over time, and when its suction ends.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace drapeplan {

/// A point of a gripper's path; between knots the height is linear in time.
struct Knot {
  double time = 0;  ///< [s]
  double z = 0;     ///< commanded height of the joint, world frame [m]
};

/// The same in-plane, for rigs that drive x and y too.
struct PlaneKnot {
  double time = 0;           ///< [s]
  Eigen::Vector2d xy{0, 0};  ///< commanded place of the joint, world frame [m]
};

/// Place and velocity at an instant; x and y are zero if they are not driven.
struct Command {
  double z = 0;                   ///< [m]
  double vz = 0;                  ///< [m/s]
  Eigen::Vector2d xy{0, 0};       ///< [m]
  Eigen::Vector2d v_plane{0, 0};  ///< [m/s]
};

/// A draping sequence: pure value, one path per gripper, in the order of the grid (x fastest).
/// The commanded place is the moving average of the path over the last `blend_time`, so that velocities
/// change at a finite acceleration; a path starts and ends at rest.
struct Schedule {
  std::vector<std::vector<Knot>> paths;  ///< times increasing from 0; at least one knot each
  double blend_time = 0;                 ///< [s]
  /// In-plane paths, one per gripper like `paths`; empty for rigs driven in z only.
  std::vector<std::vector<PlaneKnot>> plane_paths = {};
  /// When the suction of each gripper ends [s]; empty, or without a value: never.
  std::vector<std::optional<double>> release = {};

  /// Command of gripper g at time t [s]; before the first and after the last knot the path is at rest.
  [[nodiscard]] Command command(int gripper, double t) const;
  /// True if gripper g holds nothing any more at time t [s].
  [[nodiscard]] bool released(int gripper, double t) const;
  /// Time of the last knot, and the blend after it [s].
  [[nodiscard]] double duration() const;
  /// When the last commanded motion ends, its blend included [s].
  [[nodiscard]] double last_stroke() const;
  /// When the last commanded motion or release ends; then all joints rest [s].
  [[nodiscard]] double last_motion() const;
  /// Largest speed over all grippers, vertical or in-plane [m/s].
  [[nodiscard]] double largest_velocity() const;
};

}  // namespace drapeplan
