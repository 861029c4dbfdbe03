// Schedules as files: JSON for us, CSV for a robot controller.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/rig/rig.hpp"
#include "fem/rig/schedule.hpp"
#include "planner/input/error.hpp"

namespace drapeplan {

inline constexpr const char* kScheduleFormat = "drapeplan-schedule 1";

/// Writes schedule.json: the knots of every gripper's joint [s], [m]; `plane_knots` (x, y) if the rig drives
/// these; `release` [s] where the suction ends. Reading it again gives the same bits.
/// @throws std::invalid_argument if the schedule does not fit the rig or is not finite; std::runtime_error if
/// writing fails.
void write_schedule(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig);

struct ScheduleReading {
  Schedule value;                  ///< only meaningful without errors
  std::vector<InputError> errors;  ///< all of them, in the order of the file
};

/// Reads a schedule for a rig; grippers may stand in any order. Refused: another format, unknown keys, a
/// gripper that is missing, doubled or not of the rig, in-plane paths that are missing or not of the rig,
/// times that do not increase from 0, and all that parse_json_text refuses. The rig's velocity limit is not
/// checked here. Never throws for bad input.
ScheduleReading read_schedule(const std::filesystem::path& file, const RigOptions& rig);

/// Writes schedule.csv: `gripper_i,gripper_j,time_s,z_m,vz_m_per_s`, gripper by gripper, times increasing.
/// Then `x_m,y_m,vx_m_per_s,vy_m_per_s` if the rig drives x and y, and `suction` (1 or 0) if it ever ends.
/// Samples: each knot and the end of its blend (between them z is a parabola), and in between every 1 /
/// `rate`.
/// @param rate  [1/s], > 0.
void write_schedule_csv(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                        double rate = 100);

}  // namespace drapeplan
