#include "planner/exports/vtk_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "mapping/error.hpp"
#include "tests/planner/exports/vtu_text.hpp"

namespace drapeplan {
namespace {

using test::Folder;
using test::text_of;
using test::values_of;

/// A quadrilateral beside a triangle.
VtkGrid two_cells() {
  VtkGrid grid;
  grid.points = {{0, 0, 1.0 / 3}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.5, -1e-300}};
  grid.cells = {{VtkKind::quad, {0, 1, 2, 3}}, {VtkKind::triangle, {1, 4, 2}}};
  grid.point_fields = {{"gap_m", {0.1, std::numeric_limits<double>::denorm_min(), 3, std::nan(""), 5}}};
  grid.cell_fields = {{"shear_deg", {-1, 2}}, vtk_vectors("warp", {{1, 2, 3}, {4, 5, 6}})};
  return grid;
}

TEST(VtkFile, GridReadsBackBitForBit) {
  const Folder folder;
  const VtkGrid grid = two_cells();
  write_vtu(folder / "a.vtu", grid);
  const std::string text = text_of(folder / "a.vtu");
  EXPECT_NE(text.find("NumberOfPoints=\"5\" NumberOfCells=\"2\""), std::string::npos);
  const std::vector<double> points = values_of(text, "points");
  ASSERT_EQ(points.size(), 15u);
  for (size_t k = 0; k < 15; ++k) EXPECT_EQ(points[k], grid.points[k / 3][Eigen::Index(k % 3)]);
  const std::vector<double> gap = values_of(text, "gap_m");
  ASSERT_EQ(gap.size(), 5u);
  for (const size_t k : {0u, 1u, 2u, 4u}) EXPECT_EQ(gap[k], grid.point_fields[0].values[k]);
  EXPECT_TRUE(std::isnan(gap[3]));
  EXPECT_EQ(values_of(text, "shear_deg"), grid.cell_fields[0].values);
  EXPECT_EQ(values_of(text, "warp"), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_NE(text.find("Name=\"warp\" NumberOfComponents=\"3\""), std::string::npos);
  EXPECT_EQ(values_of<std::int64_t>(text, "connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3, 1, 4, 2}));
  EXPECT_EQ(values_of<std::int64_t>(text, "offsets"), (std::vector<std::int64_t>{4, 7}));
  EXPECT_EQ(values_of<std::uint8_t>(text, "types"), (std::vector<std::uint8_t>{9, 5}));
  EXPECT_EQ(test::arrays_of(text, "PointData"), std::vector<std::string>{"gap_m"});
  EXPECT_EQ(test::arrays_of(text, "CellData"), (std::vector<std::string>{"shear_deg", "warp"}));
}

TEST(VtkFile, WhatDoesNotFitIsRefusedAndNotWritten) {
  const Folder folder;
  VtkGrid grid = two_cells();
  grid.point_fields[0].values.pop_back();
  EXPECT_THROW(write_vtu(folder / "a.vtu", grid), std::invalid_argument);
  grid = two_cells();
  grid.cell_fields[1].width = 2;
  EXPECT_THROW(write_vtu(folder / "a.vtu", grid), std::invalid_argument);
  grid = two_cells();
  grid.cells[1].points[1] = 5;
  EXPECT_THROW(write_vtu(folder / "a.vtu", grid), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.vtu"));
}

TEST(VtkFile, FolderThatDoesNotExistIsNamed) {
  try {
    write_vtu("no_such_folder/ply.vtu", two_cells());
    FAIL() << "should have thrown";
  } catch (const NotFinished& error) {
    EXPECT_NE(std::string(error.what()).find("no_such_folder/ply.vtu"), std::string::npos) << error.what();
  }
}

TEST(VtkFile, CollectionKeepsAllDigitsOfItsTimes) {
  const Folder folder;
  const double later = 1 + std::numeric_limits<double>::epsilon();
  write_pvd(folder / "a.pvd", {{1e-7, "a.vtu"}, {later, "b & \"c\".vtu"}});
  const std::string text = text_of(folder / "a.pvd");
  EXPECT_NE(text.find("timestep=\"1e-07\""), std::string::npos) << text;
  EXPECT_NE(text.find("timestep=\"1.0000000000000002\""), std::string::npos) << text;
  EXPECT_NE(text.find("file=\"b &amp; &quot;c&quot;.vtu\""), std::string::npos) << text;
}

TEST(VtkFile, CollectionsHaveTheSameFieldsAtAllTimes) {
  const Folder folder;
  write_over_time(folder.path(), "same", {0, 0.5}, [](size_t /*k*/) { return two_cells(); });
  for (const char* name : {"same_000.vtu", "same_001.vtu", "same.pvd"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  const auto second = [](const auto& change) {
    return [&change](size_t k) {
      VtkGrid grid = two_cells();
      if (k == 1) change(grid);
      return grid;
    };
  };
  const auto refused = [&](const auto& change) {
    EXPECT_THROW(write_over_time(folder.path(), "other", {0, 1}, second(change)), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(folder / "other.pvd"));
  };
  refused([](VtkGrid& grid) { grid.cell_fields.pop_back(); });
  refused([](VtkGrid& grid) { grid.cell_fields[0].name = "shear"; });
  refused([](VtkGrid& grid) { grid.point_fields.push_back(grid.point_fields[0]); });
}

}  // namespace
}  // namespace drapeplan
