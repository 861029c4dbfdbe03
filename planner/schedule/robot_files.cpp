#include "planner/schedule/robot_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "planner/base/text.hpp"
#include "planner/schedule/file.hpp"
#include "planner/tables/csv_metadata.hpp"

namespace drapeplan {
namespace {

constexpr int kMicro = 6, kNano = 9;  // decimals of metres and seconds
constexpr const char* kLongFile = "schedule.csv";
constexpr const char* kWideFile = "schedule_wide.csv";
constexpr const char* kRos2File = "schedule_ros2.yaml";

struct ColumnWords {
  MotionColumn column;
  const char* name;
  const char* unit;  ///< as part of a name; empty: none
  const char* doc;
};

const std::array<ColumnWords, 10>& all_columns() {
  static constexpr std::array<ColumnWords, 10> list{{
      {MotionColumn::gripper_i, "gripper_i", "", "column of the gripper along the warp, from 1"},
      {MotionColumn::gripper_j, "gripper_j", "", "row of the gripper along the weft, from 1"},
      {MotionColumn::time, "time", "_s", "from the start of the schedule, in seconds"},
      {MotionColumn::z, "z", "_m", "height of the gripper's joint, in metres"},
      {MotionColumn::vz, "vz", "_m_per_s", "velocity of the joint along z, in metres per second"},
      {MotionColumn::x, "x", "_m", "place of the joint along x, in metres"},
      {MotionColumn::y, "y", "_m", "place of the joint along y, in metres"},
      {MotionColumn::vx, "vx", "_m_per_s", "velocity of the joint along x, in metres per second"},
      {MotionColumn::vy, "vy", "_m_per_s", "velocity of the joint along y, in metres per second"},
      {MotionColumn::suction, "suction", "", "1: on, 0: off"},
  }};
  return list;
}

const ColumnWords& words_of(MotionColumn column) {
  return all_columns()[size_t(column)];
}

/// With so many decimals, always a floating-point number.
std::string with_decimals(double value, int decimals) {
  if (!std::isfinite(value)) throw std::invalid_argument("a schedule commands a number that is not finite");
  return fmt::format("{:.{}f}", value, decimals);
}

/// Rounded to so many decimals, without zeros at the end; never "-0".
std::string rounded(double value, int decimals) {
  std::string text = with_decimals(value, decimals);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

/// A name of a case in a comment: one line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return clean_text(text);
}

/// What a reader has to know, a sentence each.
std::vector<std::string> head(const Schedule& schedule, const RigOptions& rig,
                              const RobotFileOptions& options) {
  std::vector<std::string> lines{
      fmt::format("drapeplan {}: commanded motion of the grippers of a rig", DRAPEPLAN_VERSION),
      fmt::format("case: {}, hash {}", one_line(options.case_name), options.case_hash),
      fmt::format(
          "frame: the world of the case, z up, the frame in which the mold is given; z is the height of a "
          "gripper's joint, which is {} mm above the middle surface of the ply along the pad's normal",
          rounded(1e3 * rig.joint_offset, kMicro)),
      fmt::format("grippers: {} along the warp (i) by {} along the weft (j), counted from 1", rig.columns,
                  rig.rows),
      fmt::format("units: m, s, m/s, m/s^2; one row per cycle of {} ms, all grippers at the same instants",
                  rounded(1e3 * options.cycle, 3))};
  std::string releases;
  for (size_t g = 0; g < schedule.release.size(); ++g) {
    if (schedule.release[g])
      releases += fmt::format(" {} {} s", rig.name(int(g)), rounded(*schedule.release[g], kMicro));
  }
  lines.push_back(releases.empty() ? "suction: on to the end" : "suction ends:" + releases);
  return lines;
}

std::string comments(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += "# " + line + "\n";
  return text;
}

/// Columns of one gripper, in their order. @param wide  those of the table with a row per instant.
std::vector<MotionColumn> columns_of(const Schedule& schedule, bool wide) {
  std::vector<MotionColumn> columns{MotionColumn::z};
  if (!wide) columns.push_back(MotionColumn::vz);
  if (!schedule.plane_paths.empty()) {
    columns.insert(columns.end(), {MotionColumn::x, MotionColumn::y});
    if (!wide) columns.insert(columns.end(), {MotionColumn::vx, MotionColumn::vy});
  }
  const bool ends = std::any_of(schedule.release.begin(), schedule.release.end(),
                                [](const auto& time) { return time.has_value(); });
  if (wide || ends) columns.push_back(MotionColumn::suction);
  return columns;
}

double value_of(MotionColumn column, const Command& command, bool released) {
  switch (column) {
    case MotionColumn::z:
      return command.z;
    case MotionColumn::vz:
      return command.vz;
    case MotionColumn::x:
      return command.xy.x();
    case MotionColumn::y:
      return command.xy.y();
    case MotionColumn::vx:
      return command.v_plane.x();
    case MotionColumn::vy:
      return command.v_plane.y();
    default:
      return released ? 0 : 1;
  }
}

/// The cells of one gripper at one instant, each with a comma before it.
std::string cells(const Schedule& schedule, int gripper, double time,
                  const std::vector<MotionColumn>& columns) {
  const Command command = schedule.command(gripper, time);
  const bool released =
      schedule.released(gripper, time + 0.5 * kCycleStep);  // a release on the raster counts
  std::string text;
  for (const MotionColumn column : columns)
    text += "," + rounded(value_of(column, command, released), kMicro);
  return text;
}

/// One joint of the trajectory: an axis of a gripper.
struct Axis {
  int gripper;
  MotionColumn place, velocity;
};

std::vector<Axis> axes_of(const Schedule& schedule) {
  std::vector<Axis> axes;
  for (int g = 0; g < int(schedule.paths.size()); ++g) {
    axes.push_back({g, MotionColumn::z, MotionColumn::vz});
    if (schedule.plane_paths.empty()) continue;
    axes.push_back({g, MotionColumn::x, MotionColumn::vx});
    axes.push_back({g, MotionColumn::y, MotionColumn::vy});
  }
  return axes;
}

std::string list_text(const std::vector<std::string>& items) {
  return fmt::format("[{}]", fmt::join(items, ", "));
}

/// One point of the trajectory. @param last  it rests.
std::string point_text(const Schedule& schedule, const std::vector<Axis>& axes, double time, double cycle,
                       bool last) {
  std::vector<std::string> positions, velocities, accelerations;
  for (const Axis& axis : axes) {
    const auto at = [&](MotionColumn column, double t) {
      return value_of(column, schedule.command(axis.gripper, t), false);
    };
    const double change = at(axis.velocity, time + 0.5 * cycle) - at(axis.velocity, time - 0.5 * cycle);
    positions.push_back(with_decimals(at(axis.place, time), kNano));
    velocities.push_back(with_decimals(last ? 0.0 : at(axis.velocity, time), kNano));
    accelerations.push_back(with_decimals(last ? 0.0 : change / cycle, kNano));
  }
  const long long micro = std::llround(time / kCycleStep), second = std::llround(1 / kCycleStep);
  return fmt::format(
      "- positions: {}\n  velocities: {}\n  accelerations: {}\n  effort: []\n"
      "  time_from_start: {{sec: {}, nanosec: {}}}\n",
      list_text(positions), list_text(velocities), list_text(accelerations), micro / second,
      micro % second * 1000);
}

void write_metadata(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                    const RobotFileOptions& options) {
  std::vector<MotionColumn> columns{MotionColumn::gripper_i, MotionColumn::gripper_j, MotionColumn::time};
  const std::vector<MotionColumn> own = columns_of(schedule, false);
  columns.insert(columns.end(), own.begin(), own.end());
  CsvTable table{.file = kLongFile,
                 .case_name = options.case_name,
                 .case_hash = options.case_hash,
                 .description = head(schedule, rig, options),
                 .columns = {},
                 .key = {"gripper_i", "gripper_j", column_name(MotionColumn::time)}};
  for (const MotionColumn column : columns) {
    const bool whole = *words_of(column).unit == '\0';
    table.columns.push_back({column_name(column), whole ? "integer" : "decimal", words_of(column).doc});
  }
  write_text(file, metadata_text(table));
}

}  // namespace

std::string column_name(MotionColumn column) {
  return std::string(words_of(column).name) + words_of(column).unit;
}

std::string column_name(MotionColumn column, const std::array<int, 2>& gripper) {
  return fmt::format("{}_{}_{}{}", words_of(column).name, gripper[0], gripper[1], words_of(column).unit);
}

bool is_cycle(double time) {
  constexpr double kRoundOff = 1e-6;  // of a step
  const double steps = time / kCycleStep;
  return time >= kShortestCycle && time <= kLongestCycle && std::abs(steps - std::round(steps)) <= kRoundOff;
}

std::vector<double> raster(const Schedule& schedule, double cycle) {
  if (!is_cycle(cycle)) throw std::invalid_argument("a cycle of " + exact(cycle) + " s");
  constexpr double kRoundOff = 1e-9;  // [s], of the end: below it no further cycle is needed
  const double steps = std::round(cycle / kCycleStep);
  const double last = std::ceil((schedule.duration() - kRoundOff) / cycle);
  std::vector<double> times;
  for (int k = 0; k <= last; ++k) times.push_back(k * steps / std::round(1 / kCycleStep));
  return times;
}

void write_schedule_csv(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                        double cycle) {
  require_fit(schedule, rig);
  const std::vector<MotionColumn> columns = columns_of(schedule, false);
  std::string text = "gripper_i,gripper_j," + column_name(MotionColumn::time);
  for (const MotionColumn column : columns) text += "," + column_name(column);
  text += "\n";
  const std::vector<double> times = raster(schedule, cycle);
  for (int g = 0; g < rig.count(); ++g) {
    const auto [i, j] = rig.indices(g);
    for (const double time : times)
      text += fmt::format("{},{},{}{}\n", i, j, rounded(time, kMicro), cells(schedule, g, time, columns));
  }
  write_text(file, text);
}

void write_schedule_wide(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                         const RobotFileOptions& options) {
  require_fit(schedule, rig);
  const std::vector<MotionColumn> columns = columns_of(schedule, true);
  std::string text = comments(head(schedule, rig, options)) + column_name(MotionColumn::time);
  for (int g = 0; g < rig.count(); ++g) {
    for (const MotionColumn column : columns) text += "," + column_name(column, rig.indices(g));
  }
  text += "\n";
  for (const double time : raster(schedule, options.cycle)) {
    text += rounded(time, kMicro);
    for (int g = 0; g < rig.count(); ++g) text += cells(schedule, g, time, columns);
    text += "\n";
  }
  write_text(file, text);
}

void write_schedule_ros2(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                         const RobotFileOptions& options) {
  require_fit(schedule, rig);
  const std::vector<Axis> axes = axes_of(schedule);
  std::vector<std::string> names;
  for (const Axis& axis : axes) {
    const auto [i, j] = rig.indices(axis.gripper);
    names.push_back(fmt::format("gripper_{}_{}_{}", i, j, words_of(axis.place).name));
  }
  std::string text = comments(head(schedule, rig, options)) +
                     "# message: trajectory_msgs/msg/JointTrajectory; suction is no part of it\n"
                     "header:\n  stamp: {sec: 0, nanosec: 0}\n  frame_id: world\njoint_names: " +
                     list_text(names) + "\npoints:\n";
  const std::vector<double> times = raster(schedule, options.cycle);
  for (const double time : times)
    text += point_text(schedule, axes, time, options.cycle, time == times.back());
  write_text(file, text);
}

std::vector<std::string> write_robot_files(const std::filesystem::path& folder, const Schedule& schedule,
                                           const RigOptions& rig, const RobotFileOptions& options) {
  write_schedule_csv(folder / kLongFile, schedule, rig, options.cycle);
  write_metadata(folder / metadata_name(kLongFile), schedule, rig, options);
  write_schedule_wide(folder / kWideFile, schedule, rig, options);
  std::vector<std::string> refusals = rig_refusals(schedule, rig, options.kind);
  if (refusals.empty()) write_schedule_ros2(folder / kRos2File, schedule, rig, options);
  return refusals;
}

const std::vector<std::pair<std::string, std::string>>& robot_files() {
  static const std::vector<std::pair<std::string, std::string>> files{
      {kLongFile, "the same, sampled for a robot controller: a row per gripper and cycle"},
      {metadata_name(kLongFile), "what the columns of schedule.csv mean, for programs (CSV on the Web)"},
      {kWideFile, "the same, a row per cycle"},
      {kRos2File, "the same as a ROS 2 JointTrajectory, if the rig can follow it"}};
  return files;
}

}  // namespace drapeplan
