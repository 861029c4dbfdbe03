#include "planner/schedule/motion_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <random>

#include "planner/base/text.hpp"
#include "planner/schedule/motion.hpp"
#include "planner/schedule/robot_files.hpp"
#include "tests/planner/schedule/sequences.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

/// A file of its own for each test, removed at its end.
class MotionFile : public testing::Test {
 protected:
  MotionFile() : file_(fs::path(testing::TempDir()) / ("motion_" + std::to_string(::getpid()) + ".csv")) {
    rig_.columns = 2;
    rig_.rows = 1;
    rig_.spacing = 0.1;
  }
  ~MotionFile() override { fs::remove(file_); }

  ScheduleReading read(const std::string& content) {
    write_text(file_, content);
    return read_motion(file_, rig_);
  }

  /// The errors of a file with this content, one "line: column: message" per line.
  std::string errors_of(const std::string& content) {
    std::string text;
    for (const InputError& error : read(content).errors) {
      EXPECT_EQ(error.file, file_.string());
      text += std::to_string(error.line) + ": " + (error.path.empty() ? "" : error.path + ": ") +
              error.message + "\n";
    }
    return text;
  }

  fs::path file_;
  RigOptions rig_;
};

const std::string kLong = "gripper_i,gripper_j,time_s,z_m\n";
const std::string kBoth = kLong + "1,1,0,0.3\n2,1,0,0.3\n1,1,2,0.2\n2,1,2,0.25\n";

/// Largest difference of commanded heights at `times` [m].
double apart(const Schedule& a, const Schedule& b, const std::vector<double>& times) {
  double largest = 0;
  for (size_t g = 0; g < a.paths.size(); ++g) {
    for (const double time : times) {
      const double miss = std::abs(a.command(int(g), time).z - b.command(int(g), time).z);
      if (!(miss <= largest)) largest = miss;
    }
  }
  return largest;
}

TEST_F(MotionFile, OurOwnFilesGiveTheSameCommandsWithinRounding) {
  const SequenceFrame frame = test::article_frame();
  const Schedule schedule = to_schedule(frame, wave_strokes(frame));
  std::vector<double> between;  // not on the raster
  for (double time = 0; time < schedule.duration(); time += 0.00137) between.push_back(time);
  constexpr double kWritten = 0.5e-6, kChange = 2;  // [m]; [m/s^2], more than any change of acceleration here
  for (const double cycle : {0.010, 0.004}) {
    const std::vector<double> times = raster(schedule, cycle);
    write_schedule_csv(file_, schedule, frame.rig, cycle);
    const ScheduleReading tall = read_motion(file_, frame.rig);
    ASSERT_TRUE(tall.errors.empty()) << tall.errors.front().text();
    EXPECT_LE(apart(schedule, tall.value, times), kMotionTolerance + kWritten);
    // Between rows places are cubic: what is commanded has corners of its acceleration there.
    EXPECT_LE(apart(schedule, tall.value, between),
              kMotionTolerance + 2 * kWritten + 0.02 * kChange * cycle * cycle);
    write_schedule_wide(file_, schedule, frame.rig,
                        {.cycle = cycle, .case_name = "a, \"b\"", .case_hash = "0"});
    const ScheduleReading wide = read_motion(file_, frame.rig);
    ASSERT_TRUE(wide.errors.empty()) << wide.errors.front().text();
    EXPECT_LE(apart(schedule, wide.value, times), kMotionTolerance + kWritten);
    // Without velocities they are linear.
    EXPECT_LE(apart(schedule, wide.value, between),
              kMotionTolerance + 2 * kWritten + kChange * cycle * cycle / 8);
    RecordProperty("um_between_rows_at_" + std::to_string(std::lround(1e3 * cycle)) + "_ms",
                   std::to_string(1e6 * apart(schedule, tall.value, between)) + ", wide " +
                       std::to_string(1e6 * apart(schedule, wide.value, between)));
    EXPECT_LE(std::abs(tall.value.last_stroke() - schedule.last_stroke()), cycle);
    EXPECT_LE(std::abs(tall.value.duration() - schedule.duration()), cycle);
    for (const ScheduleReading* reading : {&tall, &wide}) {
      EXPECT_EQ(rig_refusals(reading->value, frame.rig, PathKind::sampled), std::vector<std::string>());
      for (const auto& path : reading->value.paths) EXPECT_LE(path.size(), 200u) << "is it thinned?";
    }
  }
}

TEST_F(MotionFile, AMotionAtTheLimitsOfItsRigIsStillWithinThemWhenReadBack) {
  SequenceFrame frame = test::article_frame();
  frame.rig.max_velocity = 0.03;
  frame.options.uniform_duration = 0.5;  // stretched to what the rig can do
  const Schedule schedule = to_schedule(frame, uniform_strokes(frame));
  const double acceleration = frame.rig.max_velocity / frame.rig.blend_time;
  for (const double cycle : {0.010, 0.001}) {
    write_schedule_csv(file_, schedule, frame.rig, cycle);
    const Schedule read = read_motion(file_, frame.rig).value;
    const auto is_refused = [&](double velocity_limit, double acceleration_limit) {
      RigOptions rig = frame.rig;
      rig.max_velocity = velocity_limit;
      rig.max_acceleration = acceleration_limit;
      return !rig_refusals(read, rig, PathKind::sampled).empty();
    };
    EXPECT_FALSE(is_refused(frame.rig.max_velocity, acceleration));
    EXPECT_TRUE(is_refused(frame.rig.max_velocity, 0.97 * acceleration));
    EXPECT_TRUE(is_refused(0.97 * frame.rig.max_velocity, acceleration));
  }
}

TEST_F(MotionFile, InPlanePlacesAndTheEndOfSuctionAreReadBack) {
  rig_.driven = Driven::xyz;
  Schedule schedule{
      {{{0, 0.3}, {1, 0.2}}, {{0, 0.3}}}, 0.1, {{{0, {0, 0}}, {1, {0.05, -0.02}}}, {{0, {0.25, 1}}}}};
  schedule.release = {std::nullopt, 0.613};
  write_schedule_csv(file_, schedule, rig_);
  const Schedule tall = read_motion(file_, rig_).value;
  write_schedule_wide(file_, schedule, rig_, {});
  const Schedule wide = read_motion(file_, rig_).value;
  for (const Schedule& read : {tall, wide}) {
    ASSERT_EQ(read.plane_paths.size(), 2u);
    for (const double time : raster(schedule, kDefaultCycle)) {
      for (int g = 0; g < 2; ++g)
        EXPECT_LE((read.command(g, time).xy - schedule.command(g, time).xy).norm(), 3e-6) << time;
    }
    ASSERT_EQ(read.release.size(), 2u);
    EXPECT_FALSE(read.release[0]);
    EXPECT_EQ(read.release[1], 0.62) << "at the next cycle";
  }
}

TEST_F(MotionFile, RowsColumnsAndCyclesOfALogAreFree) {
  // Its own clock, mixed rows, uneven steps, another order of columns, Windows' ends of lines, semicolons.
  const std::string log =
      "# our rig\r\nz_m;time_s;gripper_j;gripper_i\r\n0.3;100;1;2\r\n0.3;100;1;1\r\n\r\n"
      "0.29;100.5;1;1\r\n0.28;101.5;1;2\r\n+0.28;101.25;1;1\r\n";
  const ScheduleReading reading = read(log);
  ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().text();
  EXPECT_EQ(reading.value.command(0, 0).z, 0.3);
  EXPECT_LE(std::abs(reading.value.command(0, 0.25).z - 0.295), 1e-12) << "without velocities it is linear";
  EXPECT_LE(std::abs(reading.value.command(0, 0.5).z - 0.29), 1e-12);
  EXPECT_EQ(reading.value.command(0, 9).z, 0.28);
  EXPECT_EQ(reading.value.command(1, 1.5).z, 0.28);
  EXPECT_EQ(reading.value.duration(), 1.5);
}

TEST_F(MotionFile, ALogThatScattersStartsLevelAndIsPlayable) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-1e-5, 1e-5);  // [m]
  std::string log = kLong;
  const Schedule schedule{{{{0, 0.3}, {1, 0.3}, {3, 0.22}}, {{0, 0.3}}}, 0.1};
  for (int k = 0; k <= 3100; ++k) {
    for (int g : {0, 1})
      log += std::to_string(g + 1) + ",1," + exact(1e-3 * k) + "," +
             exact(schedule.command(g, 1e-3 * k).z + noise(random)) + "\n";
  }
  ScheduleReading reading = read(log);
  ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().text();
  EXPECT_NE(reading.value.paths[0].front().z, reading.value.paths[1].front().z);
  level_start({}, reading.value);
  EXPECT_EQ(reading.value.paths[0].front().z, reading.value.paths[1].front().z);
  EXPECT_EQ(rig_refusals(reading.value, rig_, PathKind::sampled), std::vector<std::string>());
  EXPECT_LE(apart(schedule, reading.value, raster(schedule, 0.01)), 1.1e-5);
  reading.value.paths[0].front().z += 0.001;
  level_start({}, reading.value);
  EXPECT_NE(reading.value.paths[0].front().z, reading.value.paths[1].front().z) << "1 mm is no noise";
}

TEST_F(MotionFile, NumbersThatAreNoneAreNamedWithTheirLineAllOfThem) {
  EXPECT_EQ(errors_of(kBoth + "1,1,3,nan\n2,1,3,low\n1,1,four,0.1\n1,1,5\n1,1,6,\n2,1,1e999,-inf\n"),
            "6: z_m: \"nan\" is no finite number\n"
            "7: z_m: \"low\" is no number\n"
            "8: time_s: \"four\" is no number\n"
            "9: has 3 cells, but line 1 names 4 columns\n"
            "10: z_m: has no number in this row\n"
            "11: time_s: \"1e999\" is no number\n"
            "11: z_m: \"-inf\" is no finite number\n");
}

TEST_F(MotionFile, TimesThatDoNotIncreaseAreRefused) {
  EXPECT_EQ(errors_of(kBoth + "1,1,1.5,0.2\n2,1,2,0.2\n2,1,3,0.2\n"),
            "6: time_s: 1.5: times must increase; [1, 1] was at 2 before\n"
            "7: time_s: 2: times must increase; [2, 1] was at 2 before\n");
  EXPECT_EQ(errors_of("time_s,z_1_1_m,z_2_1_m\n0,1,1\n1,1,1\n0.5,1,1\n"),
            "4: time_s: 0.5: times must increase; [1, 1] was at 1 before\n");
}

TEST_F(MotionFile, GrippersAreThoseOfTheRig) {
  EXPECT_EQ(errors_of(kLong + "1,1,0,0.3\n3,1,0,0.3\n1.5,1,0,0.3\n0,1,0,0.3\n"),
            "3: gripper_i, gripper_j: there is no gripper [3, 1]; the rig has grippers [1, 1] to [2, 1]\n"
            "4: gripper_i, gripper_j: there is no gripper [1.5, 1]; the rig has grippers [1, 1] to [2, 1]\n"
            "5: gripper_i, gripper_j: there is no gripper [0, 1]; the rig has grippers [1, 1] to [2, 1]\n");
  EXPECT_EQ(errors_of(kLong + "1,1,0,0.3\n"), "1: no row for gripper [2, 1]\n");
  EXPECT_EQ(errors_of(kLong), "1: no row for gripper [1, 1] [2, 1]\n");
  const std::string wide = errors_of("time_s,z_1_1_m,z_3_1_m\n0,1,1\n");
  EXPECT_NE(wide.find("1: z_3_1_m: unknown column; did you mean \"z_1_1_m\"?"), std::string::npos) << wide;
  EXPECT_NE(wide.find("1: no column z_2_1_m;"), std::string::npos) << wide;
}

TEST_F(MotionFile, OtherUnitsAreFound) {
  const std::string names = errors_of("gripper_i,gripper_j,time_s,z_mm\n1,1,0,300\n2,1,0,300\n");
  EXPECT_NE(names.find("1: z_mm: unknown column; did you mean \"z_m\"?"), std::string::npos) << names;
  EXPECT_NE(names.find("1: no column z_m;"), std::string::npos) << names;
  EXPECT_EQ(errors_of(kLong + "1,1,0,300\n2,1,0,0.3\n"), "2: z_m: 300 m: farther than 100 m; is it in mm?\n");
  EXPECT_EQ(errors_of(kLong + "1,1,0,0.3\n2,1,0,0.3\n1,1,5000,0.3\n1,1,5010,0.3\n"),
            "4: time_s: 5000 s after the first row: longer than 3600 s; is it in ms?\n");
  const std::string velocities = errors_of(
      "gripper_i,gripper_j,time_s,z_m,vz_m_per_s\n2,1,0,0.3,0\n1,1,0,0.3,0\n1,1,1000,0.25,-0.1\n1,1,2000,0.2,"
      "0\n");
  EXPECT_EQ(
      velocities,
      "4: vz_m_per_s: leads gripper [1, 1] to -49.7 m, but z_m says 0.25 m: is one of them, or the time, in "
      "another unit?\n");
}

TEST_F(MotionFile, ColumnsAreKnownAndNamedOnce) {
  EXPECT_NE(errors_of("gripper_i,gripper_j,time_s,z_m,sucton\n")
                .find("1: sucton: unknown column; did you mean \"suction\"?"),
            std::string::npos);
  EXPECT_NE(errors_of("gripper_i,gripper_j,time_s,z_m,z_m\n").find("1: z_m: this column appears twice"),
            std::string::npos);
  EXPECT_NE(errors_of("gripper_i,gripper_j,time_s,z_m,x_m,y_m\n")
                .find("1: x_m: belongs to rigs that drive x and y"),
            std::string::npos);
  EXPECT_NE(errors_of("gripper_i,gripper_j,time_s,z_m,z_1_1_m\n")
                .find("1: z_1_1_m: belongs to a table with a row per instant"),
            std::string::npos);
  rig_.driven = Driven::xyz;
  EXPECT_NE(errors_of(kBoth).find("1: no columns x_m, y_m;"), std::string::npos);
}

TEST_F(MotionFile, SuctionIsOnOrOffAndDoesNotComeBack) {
  const std::string names = "gripper_i,gripper_j,time_s,z_m,suction\n";
  EXPECT_EQ(errors_of(names + "1,1,0,0.3,2\n2,1,0,0.3,1\n"), "2: suction: 2: expected 1 (on) or 0 (off)\n");
  EXPECT_EQ(errors_of(names + "1,1,0,0.3,1\n2,1,0,0.3,1\n1,1,1,0.3,0\n1,1,2,0.3,1\n"),
            "5: suction: comes back at gripper [1, 1]: the ply that it has let go is not taken again\n");
}

TEST_F(MotionFile, FilesThatAreCutOffOrNoTablesAreRefused) {
  EXPECT_EQ(errors_of(""), "1: is empty\n");
  EXPECT_EQ(errors_of("\n \r\n"), "1: is empty\n");
  EXPECT_EQ(errors_of("# nothing but words\n"), "1: has comments only\n");
  EXPECT_EQ(errors_of(kBoth + "1,1,3,0."),
            "6: the last line does not end: the file may be cut off; if it is whole, add an end of line\n");
  EXPECT_NE(errors_of(kBoth + std::string("\0", 1)).find("6: has a NUL byte"), std::string::npos);
  EXPECT_NE(errors_of("\xFF\xFEg\n").find("1: is UTF-16"), std::string::npos);
  EXPECT_NE(errors_of("{\"format\": 1}\n").find("unknown column"), std::string::npos);
  EXPECT_EQ(errors_of("\xEF\xBB\xBF" + kBoth), "") << "a byte order mark is no fault";
  fs::remove(file_);
  EXPECT_EQ(read_motion(file_, rig_).errors.front().message, "cannot be read: No such file or directory");
}

TEST_F(MotionFile, AHundredErrorsAreEnough) {
  std::string text = kBoth;
  for (int k = 0; k < 500; ++k) text += "1,1,x,0\n";
  const std::vector<InputError> errors = read(text).errors;
  ASSERT_EQ(errors.size(), 101u);
  EXPECT_EQ(errors.back().message, "and 400 further errors");
}

TEST_F(MotionFile, OnlyTheNameSaysThatAFileIsATable) {
  EXPECT_TRUE(is_motion_file("out/schedule.csv"));
  EXPECT_TRUE(is_motion_file("LOG.CSV"));
  EXPECT_FALSE(is_motion_file("schedule.json"));
  EXPECT_FALSE(is_motion_file("uniform"));
}

}  // namespace
}  // namespace drapeplan
