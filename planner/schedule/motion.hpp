// Sampled motions as schedules: what was commanded or logged at a controller's cycles, made paths again.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/rig/rig.hpp"
#include "fem/rig/schedule.hpp"

namespace drapeplan {

/// A path through samples stays this close to them and to the curve between them [m]. Heights in our files
/// are rounded to 1 um; less would keep every row of a straight line.
inline constexpr double kMotionTolerance = 1.5e-6;

/// Samples of one gripper, all lists of one length but for those that may be empty; world frame.
struct GripperMotion {
  std::vector<double> time;              ///< increasing [s]
  std::vector<double> z;                 ///< height of the joint [m]
  std::vector<double> vz;                ///< [m/s]; empty: not given
  std::vector<Eigen::Vector2d> xy;       ///< of the joint [m]; empty: not driven
  std::vector<Eigen::Vector2d> v_plane;  ///< [m/s]; empty: not given
  std::vector<bool> suction;             ///< on or off; empty: always on
};

/// The schedule that passes through the samples of all grippers of a rig. Its clock starts at the earliest
/// sample, and a gripper rests before its first and after its last one. Between samples places are cubic
/// where velocities are given, else linear, as ros2_control interpolates. The schedule has no blends of its
/// own: its paths are polygons with as few knots as kMotionTolerance allows. Suction ends at the first sample
/// at which it is off.
/// @param motions  one per gripper, in the order of the grid; one sample each at least.
Schedule schedule_through(const std::vector<GripperMotion>& motions);

/// Joints as the flat ply holds them at the start: logged starts that are within 0.1 mm of it are moved
/// there. All heights become their median.
/// @param start_xy  of each joint [m]; empty if only z is driven.
void level_start(const std::vector<Eigen::Vector2d>& start_xy, Schedule& schedule);

}  // namespace drapeplan
