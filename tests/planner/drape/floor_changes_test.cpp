#include "planner/drape/floor_changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

/// The grid that a case with so many grippers is given when it is made denser.
RigOptions denser_than(int columns, int rows, const std::array<int, 2>& fixed) {
  CaseReading reading = read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-5x5.json",
                                  {"grippers.columns=" + std::to_string(columns),
                                   "grippers.rows=" + std::to_string(rows), "grippers.spacing=0.1 m"});
  Case& definition = reading.definition;
  definition.grippers->fixed = fixed;
  for (const FloorChange& change : floor_changes(definition)) {
    if (change.name == "more_grippers") return *change.definition.grippers;
  }
  ADD_FAILURE() << "no change of that name";
  return {};
}

TEST(FloorChanges, MoreGrippersStayWithinTheExtentOfTheGrid) {
  const RigOptions square = denser_than(5, 5, {3, 3});
  EXPECT_EQ(square.columns, 6);
  EXPECT_EQ(square.rows, 6);
  EXPECT_DOUBLE_EQ(square.spacing, 0.08);
  const std::array<std::array<int, 2>, 5> sizes{{{6, 3}, {3, 6}, {4, 3}, {4, 1}, {2, 2}}};
  for (const auto& [columns, rows] : sizes) {
    const RigOptions rig = denser_than(columns, rows, {columns, rows});
    EXPECT_LE((rig.columns - 1) * rig.spacing, (columns - 1) * 0.1 + 1e-12) << columns << " x " << rows;
    EXPECT_LE((rig.rows - 1) * rig.spacing, (rows - 1) * 0.1 + 1e-12) << columns << " x " << rows;
    EXPECT_GT(rig.count(), columns * rows);
    EXPECT_EQ(*rig.fixed, (std::array<int, 2>{rig.columns, rig.rows})) << columns << " x " << rows;
  }
}

}  // namespace
}  // namespace drapeplan
