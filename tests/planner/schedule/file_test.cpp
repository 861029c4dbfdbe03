#include "planner/schedule/file.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

/// A file of its own for each test, removed at its end.
class ScheduleFile : public testing::Test {
 protected:
  ScheduleFile() : file_(std::filesystem::temp_directory_path() / ("drapeplan_" + name() + ".json")) {
    rig_.columns = 2;
    rig_.rows = 1;
    rig_.spacing = 0.1;
  }
  ~ScheduleFile() override { std::filesystem::remove(file_); }

  static std::string name() { return testing::UnitTest::GetInstance()->current_test_info()->name(); }

  /// The errors of a file with this content, one "path: message" per line.
  std::string errors_of(const std::string& content) {
    write_text(file_, content);
    std::string text;
    for (const InputError& error : read_schedule(file_, rig_).errors) {
      EXPECT_EQ(error.file, file_.string());
      text += error.path + ": " + error.message + "\n";
    }
    return text;
  }

  std::filesystem::path file_;
  RigOptions rig_;
};

std::string with_grippers(const std::string& grippers) {
  return "{\"format\": \"drapeplan-schedule 1\", \"blend_time\": 0.1, \"grippers\": [" + grippers + "]}";
}

const std::string kFirst = R"({"gripper": [1, 1], "knots": [{"time": 0, "z": 1}]})";
const std::string kSecond = R"({"gripper": [2, 1], "knots": [{"time": 0, "z": 1}, {"time": 2.5, "z": 0.5}]})";

TEST_F(ScheduleFile, RoundTripKeepsEveryBit) {
  const double tiny = std::numeric_limits<double>::denorm_min(), huge = std::numeric_limits<double>::max();
  const Schedule schedule{
      {{{0, 0.1 + 0.2}, {1.0 / 3, -0.0}, {5, 1e-300}}, {{0, tiny}, {0.7, huge}, {1e22, -2.0 / 3}}}, 0.1};
  write_schedule(file_, schedule, rig_);
  const ScheduleReading reading = read_schedule(file_, rig_);
  ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().message;
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  EXPECT_EQ(bits(reading.value.blend_time), bits(schedule.blend_time));
  ASSERT_EQ(reading.value.paths.size(), schedule.paths.size());
  for (size_t g = 0; g < schedule.paths.size(); ++g) {
    ASSERT_EQ(reading.value.paths[g].size(), schedule.paths[g].size());
    for (size_t k = 0; k < schedule.paths[g].size(); ++k) {
      EXPECT_EQ(bits(reading.value.paths[g][k].time), bits(schedule.paths[g][k].time));
      EXPECT_EQ(bits(reading.value.paths[g][k].z), bits(schedule.paths[g][k].z));
    }
  }
}

TEST_F(ScheduleFile, GrippersMayStandInAnyOrder) {
  EXPECT_EQ(errors_of(with_grippers(kSecond + "," + kFirst)), "");
  EXPECT_EQ(read_schedule(file_, rig_).value.paths[1].back().time, 2.5);
}

TEST_F(ScheduleFile, MissingAndDoubledGrippersAreNamed) {
  EXPECT_EQ(errors_of(with_grippers(kSecond)), "/grippers: no path for gripper [1, 1]\n");
  EXPECT_EQ(errors_of(with_grippers(kSecond + "," + kSecond)),
            "/grippers/1/gripper: [2,1]: this gripper has a path already\n"
            "/grippers: no path for gripper [1, 1]\n");
}

TEST_F(ScheduleFile, GripperThatTheRigDoesNotHaveIsRefused) {
  const std::pair<std::string, std::string> names[] = {
      {"[3, 1]", ": [3,1]: expected [i, j] from [1, 1] to [2, 1]"},
      {"[0, 1]", ": [0,1]: expected [i, j] from [1, 1] to [2, 1]"},
      {"[1]", ": [1]: expected a pair of whole numbers"},
      {"[1.5, 1]", "/0: 1.5: expected a whole number"},
      {"\"1,1\"", ": \"1,1\": expected a pair of whole numbers"},
      {"[99999999999999999999, 1]", "/0: 1e+20: expected a whole number"}};
  for (const auto& [name, fault] : names) {
    const std::string other = R"({"gripper": )" + name + R"(, "knots": [{"time": 0, "z": 1}]})";
    const std::string errors = errors_of(with_grippers(kFirst + "," + kSecond + "," + other));
    EXPECT_TRUE(errors.starts_with("/grippers/2/gripper" + fault)) << name << "\n" << errors;
  }
}

TEST_F(ScheduleFile, TimesThatDoNotIncreaseFromZeroAreRefused) {
  const std::string late = R"({"gripper": [1, 1], "knots": [{"time": 0.5, "z": 1}]})";
  EXPECT_EQ(errors_of(with_grippers(late + "," + kSecond)),
            "/grippers/0/knots/0/time: 0.5: the first knot is at time 0\n");
  const std::string back =
      R"({"gripper": [1, 1], "knots": [{"time": 0, "z": 1}, {"time": 2, "z": 1}, {"time": 2, "z": 0}]})";
  EXPECT_EQ(errors_of(with_grippers(back + "," + kSecond)),
            "/grippers/0/knots/2/time: 2: times must increase; the knot before is at 2\n");
}

TEST_F(ScheduleFile, AllErrorsComeAtOnce) {
  const std::string bad = R"({"gripper": [1, 1], "knots": [{"time": 0, "z": "low"}, {"time": 1, "tme": 0}]})";
  const std::string errors = errors_of(with_grippers(bad + ", 7"));
  EXPECT_EQ(errors,
            "/grippers/0/knots/0/z: \"low\": expected a bare number, e.g. 0.5\n"
            "/grippers/0/knots/1: \"z\" is missing (height of the joint [m])\n"
            "/grippers/0/knots/1/tme: unknown key \"tme\"; did you mean \"time\"?\n"
            "/grippers/1: 7: expected an object { ... }\n"
            "/grippers: no path for gripper [2, 1]\n");
}

TEST_F(ScheduleFile, ForeignFilesAreRefused) {
  EXPECT_NE(errors_of("{}").find("\"format\" is missing"), std::string::npos);
  const std::string other = errors_of(R"({"format": "drapeplan-schedule 2"})");
  EXPECT_TRUE(other.starts_with("/format: \"drapeplan-schedule 2\": unknown word; did you mean")) << other;
  EXPECT_EQ(errors_of("[]"), ": expected an object { ... }\n");
  EXPECT_EQ(errors_of("null"), ": null: expected an object { ... }\n");
  EXPECT_NE(errors_of(with_grippers(R"({"gripper": [1, 1], "knots": [{"time": 0, "z": 1e999}]})")), "");
  EXPECT_NE(errors_of(""), "");
  std::filesystem::remove(file_);
  EXPECT_EQ(read_schedule(file_, rig_).errors.front().message, "cannot be read: No such file or directory");
}

TEST_F(ScheduleFile, BrokenJsonNamesItsLine) {
  write_text(file_, "{\n  \"format\": \"drapeplan-schedule 1\",\n  oops\n}\n");
  const ScheduleReading reading = read_schedule(file_, rig_);
  ASSERT_EQ(reading.errors.size(), 1u);
  EXPECT_EQ(reading.errors.front().line, 3);
}

TEST_F(ScheduleFile, FaultsOfTheTextAreThoseOfEveryInput) {
  EXPECT_EQ(
      errors_of(
          "{\"format\": \"drapeplan-schedule 1\", \"blend_time\": 0.1, \"blend_time\": 5, \"grippers\": [" +
          kFirst + "," + kSecond + "]}"),
      "/blend_time: the key \"blend_time\" appears twice in this object; first on line 1\n");
  EXPECT_NE(errors_of(std::string(65, '[')).find("nested deeper than 64 levels"), std::string::npos);
  EXPECT_NE(errors_of("\xEF\xBB\xBF" + with_grippers(kFirst + "," + kSecond)).find("byte order mark"),
            std::string::npos);
  EXPECT_NE(errors_of(with_grippers(kFirst + "," + kSecond) + '\0' + "x").find("the byte 0x00"),
            std::string::npos);
  EXPECT_NE(errors_of(with_grippers(kFirst + ", \"\xe9\"")).find("the byte 0xE9"), std::string::npos);
}

TEST_F(ScheduleFile, ErrorsHaveTheLineOfTheirValue) {
  write_text(file_, "{\"format\": \"drapeplan-schedule 1\",\n\"blend_time\": -1,\n\"grippers\": [\n" +
                        kFirst + ",\n" + R"({"gripper": [2, 1], "knots": [{"time": 0, "z": 1},)" + "\n" +
                        R"({"time": 0, "z": 1}]})" + "]}");
  std::vector<int> lines;
  for (const InputError& error : read_schedule(file_, rig_).errors) lines.push_back(error.line);
  EXPECT_EQ(lines, (std::vector<int>{2, 6}));
}

TEST_F(ScheduleFile, NotFiniteOrWrongSizedSchedulesAreNotWritten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_schedule(file_, {{{{0, 1}}}, 0.1}, rig_), std::invalid_argument);
  EXPECT_THROW(write_schedule(file_, {{{{0, 1}}, {}}, 0.1}, rig_), std::invalid_argument);
  EXPECT_THROW(write_schedule(file_, {{{{0, 1}}, {{0, nan}}}, 0.1}, rig_), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(file_));
}

const std::string kPlane = R"(, "plane_knots": [{"time": 0, "x": 0.1, "y": 0.2}])";
const std::string kThird = R"({"gripper": [1, 1], "knots": [{"time": 0, "z": 1}])" + kPlane;

TEST_F(ScheduleFile, RoundTripKeepsInPlanePathsAndReleases) {
  rig_.driven = Driven::xyz;
  const Schedule schedule{.paths = {{{0, 1}}, {{0, 1}, {2, 0.5}}},
                          .blend_time = 0.1,
                          .plane_paths = {{{0, {0.1, 1.0 / 3}}, {3, {-0.1, 0.2}}}, {{0, {0.3, 0.1}}}},
                          .release = {std::nullopt, 2.5}};
  write_schedule(file_, schedule, rig_);
  const ScheduleReading reading = read_schedule(file_, rig_);
  ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().message;
  ASSERT_EQ(reading.value.plane_paths.size(), 2u);
  ASSERT_EQ(reading.value.plane_paths[0].size(), 2u);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(reading.value.plane_paths[0][k].time, schedule.plane_paths[0][k].time);
    EXPECT_EQ(reading.value.plane_paths[0][k].xy, schedule.plane_paths[0][k].xy);
  }
  EXPECT_EQ(reading.value.release, schedule.release);
}

TEST_F(ScheduleFile, InPlanePathsBelongToRigsThatDriveXAndY) {
  EXPECT_EQ(errors_of(with_grippers(kThird + "}," + kSecond)),
            "/grippers/0/plane_knots: [{\"time\":0,\"x\":0.1,\"y\":0.2}]: belongs to \"grippers.driven\": "
            "\"xyz\" only\n");
  EXPECT_THROW(write_schedule(file_, {{{{0, 1}}, {{0, 1}}}, 0.1, {{{0, {0, 0}}}, {{0, {0, 0}}}}}, rig_),
               std::invalid_argument);
  rig_.driven = Driven::xyz;
  EXPECT_EQ(errors_of(with_grippers(kThird + "}," + kSecond)),
            "/grippers/1: \"plane_knots\" is missing (where its joint goes in-plane)\n");
  EXPECT_THROW(write_schedule(file_, {{{{0, 1}}, {{0, 1}}}, 0.1}, rig_), std::invalid_argument);
  const std::string bad =
      R"({"gripper": [2, 1], "knots": [{"time": 0, "z": 1}], "release": -1,
          "plane_knots": [{"time": 0, "x": "left", "y": 0}, {"time": 0, "x": 1, "y": 2, "z": 3}]})";
  EXPECT_EQ(errors_of(with_grippers(kThird + R"(, "release": "soon"},)" + bad)),
            "/grippers/0/release: \"soon\": expected a bare number, e.g. 0.5; allowed: >= 0\n"
            "/grippers/1/release: -1: out of range; allowed: >= 0\n"
            "/grippers/1/plane_knots/0/x: \"left\": expected a bare number, e.g. 0.5\n"
            "/grippers/1/plane_knots/1/z: unknown key \"z\"; known: \"time\", \"x\" or \"y\"\n"
            "/grippers/1/plane_knots/1/time: 0: times must increase; the knot before is at 0\n");
}

}  // namespace
}  // namespace drapeplan
