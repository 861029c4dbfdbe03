// Schedules as JSON, by their knots.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/rig/rig.hpp"
#include "fem/rig/schedule.hpp"
#include "planner/input/error.hpp"

namespace drapeplan {

inline constexpr const char* kScheduleFormat = "drapeplan-schedule 1";

/// @throws std::invalid_argument unless a schedule has one path with knots per gripper of the rig, in-plane
/// ones where the rig drives x and y and nowhere else.
void require_fit(const Schedule& schedule, const RigOptions& rig);

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

}  // namespace drapeplan
