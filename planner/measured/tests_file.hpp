// What a file of tests says: which tests were made, on what, and where their data are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planner/case/fields.hpp"
#include "planner/measured/strip_image.hpp"
#include "planner/tables/test_table.hpp"
#include "planner/input/error.hpp"

namespace drapeplan {

inline constexpr const char* kTestsFormat = "drapeplan-tests 1";

/// Names of columns in a test's file; empty: the usual names are looked for.
struct ColumnNames {
  std::string time, displacement, force, angle, deflection, distance;
};

/// A strip in a tensile test machine: along the fibres (tension) or at 45 degrees to them (bias extension).
struct StripTest {
  std::string file;
  double width = 0;   ///< [m]
  double height = 0;  ///< between the clamps, before the test [m]
  double rate = 0;    ///< of the crosshead [m/s]
  ColumnNames columns;
  TestTable table;
};

/// A stiff specimen in the same machine and clamps: what moves is the machine.
struct ComplianceTest {
  std::string file;
  ColumnNames columns;
  TestTable table;
};

/// A square fabric in a frame of four bars, pulled at two opposite corners.
struct FrameTest {
  std::string file;
  double side = 0;                 ///< of the frame, between its hinges [m]
  std::optional<double> specimen;  ///< side of the fabric; absent: that of the frame [m]
  double rate = 0;                 ///< of the crosshead [m/s]
  ColumnNames columns;
  TestTable table;
};

/// A picture of a strip at an instant.
struct StripFrame {
  std::string file;
  double time = 0;                     ///< since it was let go [s]
  std::vector<Eigen::Vector2d> line;   ///< its middle, see strip_midline
};

/// Rows of a profile: each fourth one is a piece of its law.
inline constexpr size_t kFewestProfileRows = 20;

/// A strip that is clamped at one end and bends under its weight: pictures, a table of its tip, or its shape at rest.
struct CantileverTest {
  double length = 0, width = 0;  ///< free length and width [m]
  std::string file;              ///< table of times and deflections; may be empty
  std::string profile;           ///< table of distances and deflections at rest; may be empty
  ColumnNames columns;
  TestTable table;
  std::vector<StripFrame> frames;  ///< in the order of time; may be empty
  StripImageOptions image;
};

struct Tests {
  std::string name, source;
  double thickness = 0;      ///< [m]
  double areal_density = 0;  ///< [kg/m^2]
  std::vector<ComplianceTest> compliance;
  std::vector<StripTest> tension, bias_extension;
  std::vector<FrameTest> picture_frame;
  std::vector<CantileverTest> cantilever;
  std::optional<double> transverse_shear_modulus;  ///< chosen; absent: the assumed one [Pa]
  double gravity = 9.81;                           ///< [m/s^2]
  int section_points = FemOptions().section_points;  ///< of simulated cantilevers
  int shear_measure = 0;                   ///< index of ShearMeasure
  int shear_rates = 0;                     ///< 0 by the law, 1 as in the article; see bias_extension_law
  std::optional<MaterialFields> assumed;   ///< what is not tested
};

struct TestsReading {
  Tests tests;                     ///< only meaningful without errors
  std::vector<InputError> errors;  ///< of the file and of all data files
};

/// Reads a file of tests with its `path=value` overrides, and the data files that it names, relative to it.
/// Never throws for bad input.
TestsReading read_tests(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

}  // namespace drapeplan
