// What somebody must know before a schedule is played on a robot, as a table of a page.
#pragma once

#include <string>

#include "fem/rig/schedule.hpp"
#include "planner/case/case.hpp"
#include "planner/page/page.hpp"
#include "planner/score/score.hpp"

namespace drapeplan {

/// Frame and zero of the heights, their range, largest speed, force, lag and the end of suction, each beside
/// its limit; and whether there is a trajectory for ROS 2, or why not.
/// @param name  of the schedule;  @param score  of its drape.
ReportTable robot_table(const std::string& name, const Schedule& schedule, const Case& definition,
                        const Score& score);

}  // namespace drapeplan
