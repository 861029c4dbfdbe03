// Tables of a test machine: text with columns of numbers, as its program exports them.
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
  deflection,    ///< of a strip's tip, downwards [m]
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

/// Reads a table. Lines before the row of names are the machine's notes. Units stand behind the names, in
/// brackets ("Load (kN)", "Kraft [N]"), or in the row below. Columns are separated by semicolons, tabs or
/// commas; where commas do not separate, they may be decimal points. Never throws for bad input.
TableReading read_test_table(const std::filesystem::path& file, const std::vector<WantedColumn>& wanted);

/// "force": as fields of a file and messages call it.
std::string quantity_name(TestQuantity quantity);

}  // namespace drapeplan
