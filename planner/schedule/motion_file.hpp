// Sampled motions of a rig from tables: our own files for a robot, and logs with the same columns.
#pragma once

#include <filesystem>

#include "fem/rig/rig.hpp"
#include "planner/schedule/file.hpp"

namespace drapeplan {

/// Whether a file of this name is a table (.csv) and not schedule.json.
bool is_motion_file(const std::filesystem::path& file);

/// Reads schedule.csv or schedule_wide.csv, or a log with their columns, and makes a schedule of it
/// (schedule_through). Columns may stand in any order; velocities and suction may be absent; rows of several
/// grippers may be mixed; the cycle is free, and need not be even. Lines that begin with # are comments.
/// Refused, with the line, up to 100 of them: unknown, doubled and missing columns, cells that are no finite
/// number, times that do not increase, grippers that the rig does not have or that have no row, places beyond
/// 100 m and motions longer than an hour (another unit), velocities that do not lead from height to height,
/// suction that comes back, a last line without its end (a file that was cut off). What a rig cannot do is
/// not checked here. Never throws for bad input.
ScheduleReading read_motion(const std::filesystem::path& file, const RigOptions& rig);

}  // namespace drapeplan
