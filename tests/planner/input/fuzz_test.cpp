// Random damage to input files: no crash, and every error has its place.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "planner/base/json_text.hpp"
#include "planner/case/file.hpp"
#include "planner/schedule/file.hpp"
#include "planner/schedule/motion_file.hpp"
#include "planner/tables/test_table.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

const fs::path kCases = fs::path(DRAPEPLAN_SOURCE_DIR) / "cases";

/// A few changes at random places of a text.
std::string damaged(std::string text, std::mt19937& random) {
  static const std::string pieces[] = {
      "{",     "}",       "[",       "]",        ",",     ":",
      "\"",    "\\",      "null",    "-",        "1e400", "1e-400",
      "\xff",  "mm",      "0",       "\n",       "\0"s,   "\xEF\xBB\xBF",
      "true",  "\\u0000", "\\ud800", "\xC3\xA9", "{}",    "[[[[[[",
      "1e308", "-1",      "\"x\":",  "\"\"",     "/**/",  "99999999999999999999",
      "nan",   "inf",     ";",       "\t",       "\r",    "+-1"};
  const std::string original = text;
  for (int changes = 1 + int(random() % 3); changes > 0; --changes) {
    const size_t at = random() % text.size();
    switch (random() % 5) {
      case 0:
        text[at] = char(random() % 256);
        break;
      case 1:
        text.erase(at, 1 + random() % 20);
        break;
      case 2:
        text.insert(at, pieces[random() % std::size(pieces)]);
        break;
      case 3:
        text.replace(at, 1 + random() % 6, pieces[random() % std::size(pieces)]);
        break;
      default:
        text.insert(at, original.substr(random() % original.size(), random() % 40));
    }
    if (text.empty()) text.push_back(' ');
  }
  return text;
}

/// Damages `original` so often and hands each file to `read`, which gives the errors that it found.
/// @param fewest  share of files that must be refused: a text that says less of itself hides more damage.
template <class Read>
void damage_and_read(const std::string& original, int rounds, unsigned seed, const Read& read, double fewest = 0.5) {
  const fs::path file = fs::path(testing::TempDir()) / ("fuzz_test_" + std::to_string(::getpid()) + ".json");
  std::mt19937 random(seed);
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::string text = damaged(original, random);
    std::ofstream(file, std::ios::binary) << text;
    const std::vector<InputError> errors = read(file);
    refused += errors.empty() ? 0 : 1;
    for (const InputError& error : errors) {
      EXPECT_FALSE(error.file.empty() || error.message.empty()) << text;
      EXPECT_TRUE(error.line > 0 || !error.path.empty()) << error.text() << "\n" << text;
    }
  }
  fs::remove(file);
  EXPECT_GT(refused, fewest * rounds);
  EXPECT_LT(refused, rounds);
}

TEST(DamagedInput, CasesAreReadOrRefusedWithPlaces) {
  const std::string original =
      dump_json(resolved_case(read_case(kCases / "flexdraper-quick.json").definition), 1);
  damage_and_read(original, 600, 20240611, [](const fs::path& file) {
    const CaseReading reading = read_case(file);
    if (reading.errors.empty()) dump_json(resolved_case(reading.definition));
    return reading.errors;
  });
}

TEST(DamagedInput, SchedulesAreReadOrRefusedWithPlaces) {
  RigOptions rig;
  rig.columns = rig.rows = 2;
  rig.spacing = 0.1;
  rig.driven = Driven::xyz;
  const std::string original = R"({
  "format": "drapeplan-schedule 1",
  "blend_time": 0.1,
  "grippers": [
    {"gripper": [1, 1], "knots": [{"time": 0, "z": 1}, {"time": 2.5, "z": 0.5}], "plane_knots": [{"time": 0, "x": 0, "y": 1}]},
    {"gripper": [2, 1], "knots": [{"time": 0, "z": 1}], "plane_knots": [{"time": 0, "x": 0, "y": 1}], "release": 2},
    {"gripper": [1, 2], "knots": [{"time": 0, "z": 1}], "plane_knots": [{"time": 0, "x": 0, "y": 1}]},
    {"gripper": [2, 2], "knots": [{"time": 0, "z": 1}],
     "plane_knots": [{"time": 0, "x": 0, "y": 1}, {"time": 1e-3, "x": -0.25, "y": 1}]}
  ]
}
)";
  damage_and_read(original, 1400, 7, [&rig](const fs::path& file) {
    const ScheduleReading reading = read_schedule(file, rig);
    if (reading.errors.empty()) {
      write_schedule(file, reading.value, rig);
      EXPECT_TRUE(read_schedule(file, rig).errors.empty());
    }
    return reading.errors;
  });
}

TEST(DamagedInput, MotionsAreReadOrRefusedWithTheirLine) {
  RigOptions rig;
  rig.columns = 2;
  rig.rows = 1;
  std::string tall = "gripper_i,gripper_j,time_s,z_m,vz_m_per_s,suction\n",
              wide = "# ours\ntime_s;z_1_1_m;z_2_1_m\r\n";
  for (int k = 0; k < 8; ++k) {
    const std::string n = std::to_string(k);
    tall += "1,1,0.0" + n + ",0.3,0,1\n2,1,0.0" + n + ",0.2" + n + ",1e0,0\n";
    wide += n + ".5;0.3;+0.0" + n + "\r\n";
  }
  unsigned seed = 23;
  for (const std::string& original : {tall, wide}) {
    damage_and_read(original, 700, seed++, [&rig](const fs::path& file) {
      const ScheduleReading reading = read_motion(file, rig);
      for (const InputError& error : reading.errors)
        EXPECT_TRUE(error.file == file.string() && error.line > 0);
      if (reading.errors.empty()) {
        for (const double time : {-1.0, 0.0, 0.031, 1e4})
          EXPECT_TRUE(std::isfinite(reading.value.command(0, time).z + reading.value.command(1, time).vz));
      }
      return reading.errors;
    });
  }
}

TEST(DamagedInput, TablesAreFiniteOrRefusedWithTheirLine) {
  const std::vector<WantedColumn> wanted{
      {TestQuantity::time}, {TestQuantity::displacement, true}, {TestQuantity::force, true}};
  std::string points = "Specimen,A 1\r\n\r\n\"Time\",\"Extension\",\"Load\"\r\n\"(s)\",\"(mm)\",\"(kN)\"\r\n";
  std::string commas = "Notiz\nZeit [s];Standardweg [mm];Standardkraft [N]\n";
  std::string tabs = "Load\tTime\tCrosshead\nN\tsec\tmm\n";
  for (int k = 0; k < 12; ++k) {
    const std::string n = std::to_string(k);
    points += "\"" + n + ".5\",\"1e-" + n + "\",\"-0.0" + n + "\"\r\n";
    commas += n + ",25;0," + n + ";+" + n + "\n";
    tabs += n + "\t" + n + ".5\t-" + n + "e2\n";
  }
  unsigned seed = 11;
  for (const std::string& original : {points, commas, tabs}) {
    damage_and_read(original, 500, seed++, [&wanted](const fs::path& file) {
      const TableReading reading = read_test_table(file, wanted);
      for (const InputError& error : reading.errors) EXPECT_TRUE(error.file == file.string() && error.line > 0);
      if (!reading.errors.empty()) return reading.errors;
      EXPECT_GE(reading.table.rows(), kFewestTestRows);
      for (const auto& [quantity, column] : reading.table.columns) {
        EXPECT_EQ(column.size(), reading.table.rows());
        for (const double value : column) EXPECT_TRUE(std::isfinite(value));
      }
      return reading.errors;
    }, 0.3);
  }
}

}  // namespace
}  // namespace drapeplan
