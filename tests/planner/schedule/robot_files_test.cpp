#include "planner/schedule/robot_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "planner/base/text.hpp"
#include "planner/schedule/strategy.hpp"
#include "tests/planner/schedule/sequences.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::istringstream stream(text_of(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<double> numbers_of(std::string text, char separator) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string cell; std::getline(stream, cell, separator);) numbers.push_back(std::stod(cell));
  return numbers;
}

/// A folder of its own for each test, removed at its end.
class RobotFiles : public testing::Test {
 protected:
  RobotFiles() : folder_(fs::path(testing::TempDir()) / ("robot_files_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    rig_.columns = 2;
    rig_.rows = 1;
    rig_.spacing = 0.1;
    options_.case_name = "two\ngrippers";
    options_.case_hash = "0123456789abcdef";
  }
  ~RobotFiles() override { fs::remove_all(folder_); }

  fs::path folder_;
  RigOptions rig_;
  RobotFileOptions options_;
  /// Goes down at 0.1 m/s from a knot that lies between cycles; the other gripper rests.
  Schedule schedule_{{{{0, 0.3}, {0.5013, 0.3}, {1.0013, 0.25}, {1.2, 0.25}}, {{0, 0.3}}}, 0.1};
};

TEST_F(RobotFiles, AllGrippersAreOnOneRasterUntilTheScheduleEnds) {
  write_schedule_csv(folder_ / "a.csv", schedule_, rig_, 0.004);
  const std::vector<std::string> lines = lines_of(folder_ / "a.csv");
  ASSERT_EQ(lines.front(), "gripper_i,gripper_j,time_s,z_m,vz_m_per_s");
  std::map<double, std::vector<double>> times;
  for (size_t k = 1; k < lines.size(); ++k) {
    const std::vector<double> row = numbers_of(lines[k], ',');
    ASSERT_EQ(row.size(), 5u) << lines[k];
    EXPECT_EQ(row[1], 1);
    times[row[0]].push_back(row[2]);
    const Command command = schedule_.command(int(row[0]) - 1, row[2]);
    EXPECT_LE(std::abs(row[3] - command.z), 0.5001e-6);
    EXPECT_LE(std::abs(row[4] - command.vz), 0.5001e-6);
  }
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[1], times[2]);
  ASSERT_EQ(times[1].size(), 326u);  // 1.3 s
  for (size_t k = 0; k < times[1].size(); ++k) EXPECT_DOUBLE_EQ(times[1][k], 0.004 * double(k));
}

TEST_F(RobotFiles, TheRasterEndsAtOrAfterTheSchedule) {
  EXPECT_EQ(raster({{{{0, 1}, {1, 0.5}}}, 0.1}, 0.01).size(), 111u);
  EXPECT_EQ(raster({{{{0, 1}, {1.0001, 0.5}}}, 0.1}, 0.01).size(), 112u);
  EXPECT_EQ(raster({{{{0, 1}}}, 0}, 0.01).size(), 1u);
  for (const double cycle : {0.0, -0.01, 0.00005, 0.2, 0.0010005, std::nan("")})
    EXPECT_THROW(raster(schedule_, cycle), std::invalid_argument) << cycle;
}

TEST_F(RobotFiles, ColumnsAreThoseThatTheScheduleHas) {
  const auto header_and_last = [this](const Schedule& schedule) {
    write_schedule_csv(folder_ / "a.csv", schedule, rig_, 0.1);
    const std::vector<std::string> lines = lines_of(folder_ / "a.csv");
    return std::pair{lines.front(), lines.back()};
  };
  using Pair = std::pair<std::string, std::string>;
  Schedule schedule{{{{0, 1}}, {{0, 1}, {2, 0.5}}}, 0.5};
  schedule.release = {std::nullopt, 2.5};
  EXPECT_EQ(header_and_last(schedule),
            (Pair{"gripper_i,gripper_j,time_s,z_m,vz_m_per_s,suction", "2,1,2.5,0.5,0,0"}));
  schedule.release.clear();
  rig_.driven = Driven::xyz;
  schedule.plane_paths = {{{0, {0, 0}}}, {{0, {0.25, -1e-9}}}};
  EXPECT_EQ(header_and_last(schedule),
            (Pair{"gripper_i,gripper_j,time_s,z_m,vz_m_per_s,x_m,y_m,vx_m_per_s,vy_m_per_s",
                  "2,1,2.5,0.5,0,0.25,0,0,0"}));
}

TEST_F(RobotFiles, TheWideTableHasARowPerCycleAndSaysWhatItIs) {
  schedule_.release = {1.25, std::nullopt};
  options_.cycle = 0.05;
  write_schedule_wide(folder_ / "a.csv", schedule_, rig_, options_);
  std::vector<std::string> lines = lines_of(folder_ / "a.csv"), head;
  while (!lines.empty() && lines.front().starts_with("# "))
    head.push_back(lines.front()), lines.erase(lines.begin());
  ASSERT_EQ(head.size(), 6u);
  EXPECT_EQ(head[1], "# case: two grippers, hash 0123456789abcdef");
  EXPECT_NE(head[2].find("height of a gripper's joint, which is 5 mm above the middle surface"),
            std::string::npos);
  EXPECT_NE(head[4].find("cycle of 50 ms"), std::string::npos);
  EXPECT_EQ(head[5], "# suction ends: [1, 1] 1.25 s");
  ASSERT_EQ(lines.size(), 28u);
  EXPECT_EQ(lines[0], "time_s,z_1_1_m,suction_1_1,z_2_1_m,suction_2_1");
  EXPECT_EQ(lines[1], "0,0.3,1,0.3,1");
  EXPECT_EQ(lines[25], "1.2,0.25,1,0.3,1");
  EXPECT_EQ(lines[26], "1.25,0.25,0,0.3,1");
  rig_.driven = Driven::xyz;
  schedule_.plane_paths = {{{0, {0, 0}}}, {{0, {0.25, 1}}}};
  write_schedule_wide(folder_ / "a.csv", schedule_, rig_, options_);
  EXPECT_NE(text_of(folder_ / "a.csv").find("time_s,z_1_1_m,x_1_1_m,y_1_1_m,suction_1_1,z_2_1_m,x_2_1_m"),
            std::string::npos);
}

/// A point of a trajectory, as read from its file.
struct Point {
  double time = 0;
  std::vector<double> position, velocity, acceleration;
};

struct Trajectory {
  std::vector<std::string> joints;
  std::vector<Point> points;
};

Trajectory trajectory_of(const fs::path& file) {
  Trajectory result;
  const auto list = [](const std::string& line) {
    const size_t open = line.find('[');
    return line.substr(open + 1, line.rfind(']') - open - 1);
  };
  static const std::regex kTime("  time_from_start: \\{sec: (\\d+), nanosec: (\\d+)\\}");
  std::smatch match;
  for (const std::string& line : lines_of(file)) {
    if (line.starts_with("joint_names: [")) {
      std::istringstream stream(list(line));
      for (std::string name; stream >> name;) result.joints.push_back(name.substr(0, name.find(',')));
    }
    if (line.starts_with("- positions: [")) {
      result.points.emplace_back();
      result.points.back().position = numbers_of(list(line), ',');
    }
    if (line.starts_with("  velocities: [")) result.points.back().velocity = numbers_of(list(line), ',');
    if (line.starts_with("  accelerations: ["))
      result.points.back().acceleration = numbers_of(list(line), ',');
    if (std::regex_match(line, match, kTime))
      result.points.back().time = std::stod(match[1]) + 1e-9 * std::stod(match[2]);
  }
  return result;
}

/// The quintic between two points with positions, velocities and accelerations, and its second derivative.
struct Quintic {
  double c[6];
  Quintic(const Point& a, const Point& b, size_t joint) {
    const double t = b.time - a.time, p0 = a.position[joint], p1 = b.position[joint];
    const double v0 = a.velocity[joint], v1 = b.velocity[joint];
    const double a0 = a.acceleration[joint], a1 = b.acceleration[joint];
    const double d = p1 - p0 - v0 * t - 0.5 * a0 * t * t, dv = (v1 - v0 - a0 * t) * t, da = (a1 - a0) * t * t;
    c[0] = p0, c[1] = v0, c[2] = 0.5 * a0;
    c[3] = (10 * d - 4 * dv + 0.5 * da) / (t * t * t);
    c[4] = (-15 * d + 7 * dv - da) / (t * t * t * t);
    c[5] = (6 * d - 3 * dv + 0.5 * da) / (t * t * t * t * t);
  }
  [[nodiscard]] double at(double s) const {
    return c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5]))));
  }
  [[nodiscard]] double acceleration(double s) const {
    return 2 * c[2] + s * (6 * c[3] + s * (12 * c[4] + s * 20 * c[5]));
  }
};

/// Largest difference of the quintics through the points of a file from the commanded heights [m].
/// @param fastest_change  largest acceleration on the way [m/s^2].
double quintic_error(const Trajectory& trajectory, const Schedule& schedule, double& fastest_change) {
  double error = 0;
  for (size_t k = 1; k < trajectory.points.size(); ++k) {
    const Point &a = trajectory.points[k - 1], &b = trajectory.points[k];
    for (size_t g = 0; g < trajectory.joints.size(); ++g) {
      const Quintic quintic(a, b, g);
      for (int step = 0; step <= 16; ++step) {
        const double s = step * (b.time - a.time) / 16;
        const double miss = std::abs(quintic.at(s) - schedule.command(int(g), a.time + s).z);
        if (!(miss <= error)) error = miss;
        fastest_change = std::max(fastest_change, std::abs(quintic.acceleration(s)));
      }
    }
  }
  return error;
}

/// Where both points have one acceleration, the quintic between them has it, too, as far as rounding lets it.
/// @return intervals of this kind in which it is not zero.
int steady_intervals(const Trajectory& trajectory, double cycle) {
  constexpr double kNoise = 2e-7;  // [m/s^2], of two accelerations that are equal
  const double rounding = 12 * 1e-9 / (cycle * cycle);
  int count = 0;
  for (size_t k = 1; k < trajectory.points.size(); ++k) {
    const Point &a = trajectory.points[k - 1], &b = trajectory.points[k];
    for (size_t g = 0; g < trajectory.joints.size(); ++g) {
      if (std::abs(a.acceleration[g] - b.acceleration[g]) > kNoise) continue;
      for (const double share : {0.0, 0.3, 0.5, 0.9})
        EXPECT_LE(std::abs(Quintic(a, b, g).acceleration(share * cycle) - a.acceleration[g]), rounding)
            << a.time;
      count += std::abs((b.velocity[g] - a.velocity[g]) / cycle) > 0.01 ? 1 : 0;
    }
  }
  return count;
}

TEST_F(RobotFiles, QuinticsThroughTheTrajectoryAreTheCommandedHeights) {
  SequenceFrame frame = test::article_frame();
  frame.rig.max_acceleration = 2;
  const Schedule schedule = to_schedule(frame, wave_strokes(frame));
  ASSERT_EQ(rig_refusals(schedule, frame.rig), std::vector<std::string>());
  double largest = 0;  // acceleration that is commanded [m/s^2]
  for (const double time : raster(schedule, 0.001)) {
    for (int g = 0; g < 25; ++g) {
      const double change = schedule.command(g, time + 1e-3).vz - schedule.command(g, time).vz;
      largest = std::max(largest, std::abs(change) / 1e-3);
    }
  }
  for (const double cycle : {0.010, 0.004, 0.001}) {
    options_.cycle = cycle;
    write_schedule_ros2(folder_ / "a.yaml", schedule, frame.rig, options_);
    const Trajectory trajectory = trajectory_of(folder_ / "a.yaml");
    ASSERT_EQ(trajectory.joints.size(), 25u);
    EXPECT_EQ(trajectory.joints[7], "gripper_3_2_z");
    ASSERT_EQ(trajectory.points.size(), raster(schedule, cycle).size());
    double fastest = 0;
    const double error = quintic_error(trajectory, schedule, fastest);
    RecordProperty("error_nm_at_" + std::to_string(std::lround(1e6 * cycle)) + "_us",
                   std::to_string(1e9 * error));
    EXPECT_LE(error, 0.02 * largest * cycle * cycle + 2e-9) << cycle;
    EXPECT_GT(error, 0) << "nothing was compared";
    if (cycle > 0.001) {  // below, rounding hides them
      EXPECT_GT(steady_intervals(trajectory, cycle), 100);
    }
    EXPECT_LE(fastest, 1.2 * largest + 8 * 1e-9 / (cycle * cycle)) << "between points, too";
    for (const Point& point : trajectory.points) {
      for (const double velocity : point.velocity) EXPECT_LE(std::abs(velocity), frame.rig.max_velocity);
      for (const double acceleration : point.acceleration)
        EXPECT_LE(std::abs(acceleration), largest * 1.0001);
    }
    for (const double velocity : trajectory.points.back().velocity) EXPECT_EQ(velocity, 0);
  }
}

TEST_F(RobotFiles, ATrajectoryOfARigThatDrivesXAndYHasThreeJointsPerGripper) {
  rig_.driven = Driven::xyz;
  schedule_.plane_paths = {{{0, {0, 0}}, {1, {0.05, -0.02}}}, {{0, {0.25, 1}}}};
  write_schedule_ros2(folder_ / "a.yaml", schedule_, rig_, options_);
  const Trajectory trajectory = trajectory_of(folder_ / "a.yaml");
  EXPECT_EQ(trajectory.joints, (std::vector<std::string>{"gripper_1_1_z", "gripper_1_1_x", "gripper_1_1_y",
                                                         "gripper_2_1_z", "gripper_2_1_x", "gripper_2_1_y"}));
  EXPECT_LE(std::abs(trajectory.points.back().position[1] - 0.05), 1e-9);
  EXPECT_LE(std::abs(trajectory.points[50].velocity[2] + 0.02), 1e-9);
}

TEST_F(RobotFiles, ATrajectoryThatTheRigCannotFollowIsNotWritten) {
  EXPECT_EQ(write_robot_files(folder_, schedule_, rig_, options_), std::vector<std::string>());
  for (const auto& [name, words] : robot_files()) EXPECT_TRUE(fs::exists(folder_ / name)) << name << words;
  fs::remove(folder_ / "schedule_ros2.yaml");
  rig_.max_velocity = 0.05;
  EXPECT_EQ(write_robot_files(folder_, schedule_, rig_, options_).size(), 1u);
  EXPECT_TRUE(fs::exists(folder_ / "schedule.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "schedule_ros2.yaml"));
}

TEST_F(RobotFiles, MetadataDescribeEveryColumn) {
  write_robot_files(folder_, schedule_, rig_, options_);
  const nlohmann::json about = nlohmann::json::parse(text_of(folder_ / "schedule.csv-metadata.json"));
  EXPECT_EQ(about.at("url"), "schedule.csv");
  EXPECT_EQ(about.at("dc:identifier"), options_.case_hash);
  std::string names;
  for (const auto& column : about.at("tableSchema").at("columns")) {
    names += (names.empty() ? "" : ",") + column.at("name").get<std::string>();
    EXPECT_FALSE(column.at("dc:description").get<std::string>().empty());
  }
  EXPECT_EQ(names, lines_of(folder_ / "schedule.csv").front());
}

TEST_F(RobotFiles, NothingIsWrittenThatIsNotFiniteOrDoesNotFit) {
  schedule_.paths[0][1].z = std::nan("");
  EXPECT_THROW(write_schedule_csv(folder_ / "a.csv", schedule_, rig_), std::invalid_argument);
  EXPECT_THROW(write_schedule_wide(folder_ / "a.csv", schedule_, rig_, options_), std::invalid_argument);
  EXPECT_THROW(write_schedule_ros2(folder_ / "a.yaml", schedule_, rig_, options_), std::invalid_argument);
  schedule_.paths[0][1].z = 0.3;
  rig_.columns = 3;
  EXPECT_THROW(write_schedule_ros2(folder_ / "a.yaml", schedule_, rig_, options_), std::invalid_argument);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace drapeplan
