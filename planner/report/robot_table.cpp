#include "planner/report/robot_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "planner/base/text.hpp"
#include "planner/schedule/check.hpp"

namespace drapeplan {
namespace {

std::string millimetres(double metres) {
  return fixed(1e3 * metres, 1) + " mm";
}

std::string suction_text(const Schedule& schedule) {
  double first = std::numeric_limits<double>::infinity(), last = 0;
  for (const std::optional<double>& release : schedule.release) {
    if (!release) continue;
    first = std::min(first, *release);
    last = std::max(last, *release);
  }
  if (last <= 0) return "on to the end";
  return first < last ? fmt::format("ends from {:.2f} s to {:.2f} s", first, last)
                      : fmt::format("ends at {:.2f} s", last);
}

}  // namespace

ReportTable robot_table(const std::string& name, const Schedule& schedule, const Case& definition,
                        const Score& score) {
  const RigOptions& rig = *definition.grippers;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const std::vector<Knot>& path : schedule.paths) {
    for (const Knot& knot : path) {
      lowest = std::min(lowest, knot.z);
      highest = std::max(highest, knot.z);
    }
  }
  const std::vector<std::string> refusals = rig_refusals(schedule, rig);
  ReportTable table{
      .title = "For the robot",
      .caption =
          "schedule.csv, schedule_wide.csv and schedule_ros2.yaml hold this sequence. Heights are those of "
          "the "
          "joints, in metres, upwards; their zero is that of the mold's z in the case. Gripper [i, j] is "
          "the i-th along the warp and the j-th along the weft, from 1. The cycle stands in the head of each "
          "file, that of schedule.csv in its metadata.",
      .head = {"what", "here", "limit"},
      .rows = {}};
  const auto row = [&table](const std::string& what, const std::string& here, const std::string& limit,
                            bool failed = false) {
    table.rows.push_back({.cells = {what, here, limit}, .failed = failed});
  };
  row("sequence", fmt::format("{}, {:.2f} s", name, schedule.duration()), "");
  row("heights of the joints", fmt::format("{} to {}", millimetres(lowest), millimetres(highest)), "");
  row("largest speed", fmt::format("{:.0f} mm/s", 1e3 * schedule.largest_velocity()),
      fmt::format("{:g} mm/s", 1e3 * rig.max_velocity));
  row("largest force of an actuator, simulated", fmt::format("{:.1f} N", score.max_actuator_force),
      fmt::format("{:g} N", rig.actuator_force_limit));
  row("joints behind their commands, simulated", millimetres(score.max_lag),
      millimetres(definition.score.lag_tolerance), score.max_lag > definition.score.lag_tolerance);
  row("suction", suction_text(schedule), "");
  row("trajectory for ROS 2", refusals.empty() ? "schedule_ros2.yaml" : "none: " + refusals.front(), "",
      !refusals.empty());
  return table;
}

}  // namespace drapeplan
