// Tables of numbers: text with columns, as programs of test machines and of spreadsheets write them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "planner/input/error.hpp"

namespace drapeplan {

/// What a column holds.
enum class TestQuantity {
  time,          ///< [s]
  displacement,  ///< of the crosshead [m]
  force,         ///< [N]
  angle,         ///< measured shear angle [rad]
  deflection,    ///< of a strip, downwards [m]
  distance,      ///< of a place of a strip from its clamp, horizontal [m]
  strain,        ///< nominal [-]
  stress,        ///< nominal [Pa]
};

/// A column that is asked for.
struct WantedColumn {
  TestQuantity quantity = TestQuantity::time;
  bool required = false;
  std::string header = {};  ///< the column's name in the file; empty: one of the usual names is looked for
};

struct TestTable {
  std::map<TestQuantity, std::vector<double>> columns;  ///< SI, all of one length
  std::vector<int> lines;                               ///< of the rows in the file, from 1

  [[nodiscard]] const std::vector<double>& operator[](TestQuantity quantity) const {
    return columns.at(quantity);
  }
  [[nodiscard]] bool has(TestQuantity quantity) const { return columns.contains(quantity); }
  [[nodiscard]] size_t rows() const { return lines.size(); }
};

struct TableReading {
  TestTable table;                 ///< only meaningful without errors
  std::vector<InputError> errors;  ///< with file and line
};

/// Rows of numbers that the record of a test has at least.
inline constexpr size_t kFewestTestRows = 10;

/// Reads a table. Lines before the row of names are the machine's notes. Units stand behind the names, in
/// brackets ("Load (kN)", "Kraft [N]"), or in the row below. Columns are separated by semicolons, tabs or
/// commas; where commas do not separate, they may be decimal points. Never throws for bad input.
/// @param fewest  rows of numbers that it must have.
TableReading read_test_table(const std::filesystem::path& file, const std::vector<WantedColumn>& wanted,
                             size_t fewest = kFewestTestRows);

/// "force": as fields of a file and messages call it.
std::string quantity_name(TestQuantity quantity);

}  // namespace drapeplan
