// Schedules as files for a robot's controller: commands at its cycle, on one raster for all grippers.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "fem/rig/rig.hpp"
#include "fem/rig/schedule.hpp"
#include "planner/schedule/check.hpp"

namespace drapeplan {

/// Cycle of a controller where none is named [s].
inline constexpr double kDefaultCycle = 0.010;
/// Shortest and longest cycle, and what it is a multiple of [s].
inline constexpr double kShortestCycle = 1e-4, kLongestCycle = 0.1, kCycleStep = 1e-6;
/// Whether a time [s] is within these limits and a multiple of that step.
bool is_cycle(double time);

/// What columns of a table hold. World frame; the places are those of the grippers' joints.
enum class MotionColumn { gripper_i, gripper_j, time, z, vz, x, y, vx, vy, suction };
/// "vz_m_per_s", in a table with a row per gripper and instant.
std::string column_name(MotionColumn column);
/// "vz_1_2_m_per_s", in a table with a row per instant. @param gripper  [i, j], from 1.
std::string column_name(MotionColumn column, const std::array<int, 2>& gripper);

/// Where the files come from and how they are sampled.
struct RobotFileOptions {
  double cycle = kDefaultCycle;      ///< [s]
  std::string case_name, case_hash;  ///< of the case whose rig is to move
  PathKind kind = PathKind::blended;
};

/// Instants at which all grippers are commanded: multiples of the cycle from 0 to the first one at or after
/// the end of the schedule [s]. @throws std::invalid_argument unless is_cycle(cycle).
std::vector<double> raster(const Schedule& schedule, double cycle);

/// Writes schedule.csv: `gripper_i,gripper_j,time_s,z_m,vz_m_per_s`, gripper by gripper, all on the raster.
/// Then `x_m,y_m,vx_m_per_s,vy_m_per_s` if the rig drives x and y, and `suction` (1 or 0) if it ever ends.
/// Values are rounded to micrometres, microseconds and micrometres per second.
/// @throws as write_schedule, all of these.
void write_schedule_csv(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                        double cycle = kDefaultCycle);

/// Writes schedule_wide.csv: a head of comments (#), then `time_s` and for each gripper `z_1_1_m`, `x_1_1_m`
/// and `y_1_1_m` if the rig drives x and y, and `suction_1_1`; a row per cycle.
void write_schedule_wide(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                         const RobotFileOptions& options);

/// Writes schedule_ros2.yaml: a trajectory_msgs/JointTrajectory with positions, velocities and accelerations
/// of joints `gripper_1_1_z` (then `_x` and `_y` where they are driven), a point per cycle, in nanometres:
/// quintics between points differentiate them twice. What is commanded changes its acceleration at once; a
/// point has the mean over one cycle about it, and the last one rests. The quintics then differ from the
/// commanded heights by 2 % of (change of acceleration x cycle^2) at most.
void write_schedule_ros2(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                         const RobotFileOptions& options);

/// Writes all of these into a folder, and schedule.csv-metadata.json, which says of schedule.csv (CSV on the
/// Web, W3C) what the other two say in comments: schedule.csv itself begins with the names of its columns.
/// The trajectory is only written if the rig can follow it.
/// @return what the rig cannot do, see rig_refusals; empty if all files were written.
std::vector<std::string> write_robot_files(const std::filesystem::path& folder, const Schedule& schedule,
                                           const RigOptions& rig, const RobotFileOptions& options);

/// Names of these files and what they are, for a list of results.
const std::vector<std::pair<std::string, std::string>>& robot_files();

}  // namespace drapeplan
