// Line charts and the picture of a draping sequence.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fem/rig/rig.hpp"
#include "fem/rig/schedule.hpp"

namespace drapeplan {

struct ChartSeries {
  std::string name;  ///< in the legend; empty: not listed
  std::vector<Eigen::Vector2d>
      points;          ///< in the chart's units; points that are not finite (failed runs) are left out
  bool dots = false;   ///< single points instead of a line
  bool steps = false;  ///< the value holds until the next point
  bool marks = false;  ///< every point of the line is marked
  bool rings = false;  ///< with a ring
  std::optional<double> shade = {};  ///< share of `sequential_colour`; absent: the chart chooses a colour
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<ChartSeries> series;
  double width = 640, height = 320;   ///< [px]
  bool log_x = false, log_y = false;  ///< points that are not > 0 are left out then
  bool side_legend = false;           ///< names in a column on the right, each series with a hue of its own
};

/// SVG of a chart; its axes hold all points, and y = 0 if the values come close to it.
std::string line_chart(const Chart& chart);

/// Height of every joint over time, one line per gripper [mm], [s], in the colour that the gripper has in
/// `schedule_picture`.
Chart height_chart(const Schedule& schedule, const RigOptions& rig, const std::string& title);

/// SVG of a draping sequence for a process engineer: one row per gripper with a bar for each stroke, from the
/// start of the movement to its end (blending included), in the order in which the grippers arrive; the last
/// stroke down is strong. Beside it the grid from above with the time of arrival in each gripper [s].
/// @throws std::invalid_argument if the schedule does not fit the rig.
std::string schedule_picture(const Schedule& schedule, const RigOptions& rig, const std::string& title);

}  // namespace drapeplan
