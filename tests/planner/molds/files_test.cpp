// Files of triangles and of heights: what is read, and what is refused with its place.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planner/molds/height_file.hpp"
#include "planner/molds/mold_file.hpp"
#include "planner/molds/spline_text.hpp"
#include "tests/mapping/surface/meshes.hpp"
#include "tests/planner/molds/kit.hpp"

namespace drapeplan {
namespace {

/// In millimetres.
double dish(double x, double y) {
  return 0.001 * (x * x + 2 * y * y) - 0.1 * x;
}

const Extent kBox{{-20, 10}, {40, 50}};

void expect_same(const TriangleReading& reading, const Triangles& mesh) {
  ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().text();
  ASSERT_EQ(reading.triangles.corners.size(), mesh.corners.size());
  const VerticalLines read(reading.triangles), written(mesh);
  for (double x = -19; x < 40; x += 3.7) {
    for (double y = 11; y < 50; y += 3.1) EXPECT_NEAR(read.top(x, y), written.top(x, y), 1e-5);
  }
}

void expect_error(const TriangleReading& reading, const std::string& part) {
  ASSERT_EQ(reading.errors.size(), 1u);
  EXPECT_NE(reading.errors.front().text().find(part), std::string::npos) << reading.errors.front().text();
}

TEST(TriangleFile, EveryFormatHoldsTheSameTriangles) {
  const ScratchFolder folder;
  const Triangles mesh = triangulated(dish, kBox, 6, 4);
  expect_same(read_triangles(folder.write("text.stl", text_stl(mesh))), mesh);
  expect_same(read_triangles(folder.write("binary.STL", binary_stl(mesh))), mesh);
  expect_same(read_triangles(folder.write("mesh.obj", obj(mesh))), mesh);
}

TEST(TriangleFile, WhatIsNoneIsRefusedWithItsName) {
  const ScratchFolder folder;
  expect_error(read_triangles(folder.path / "nowhere.stl"), "nowhere.stl: cannot be read: No such file");
  expect_error(read_triangles(folder.write("mold.step", "ISO-10303-21;")), "expected .stl or .obj");
  expect_error(read_triangles(folder.write("empty.stl", "")), "empty.stl: ");
  const std::string whole = binary_stl(triangulated(dish, kBox, 6, 4));
  expect_error(read_triangles(folder.write("cut.stl", whole.substr(0, 500))), "cut.stl: is no .stl file");
  expect_error(read_triangles(folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "points.obj: ");
}

TEST(HeightFile, PointsMatrixAndGridHoldTheSameHeights) {
  const ScratchFolder folder;
  const Triangles mesh = triangulated(dish, kBox, 6, 4);  // crossings 10 mm apart
  std::string points = "x [mm];y [mm];z [mm]\n", matrix = "y/x",
              grid =
                  "ncols 7\nnrows 5\nxllcenter -20\nyllcenter 10\n"
                  "cellsize 10\nNODATA_value -9999\n";
  for (int i = 6; i >= 0; --i) {
    for (int j = 0; j < 5; ++j) {
      std::string z = fmt::format("{:.9g}", dish(-20 + 10 * i, 10 + 10 * j));
      std::replace(z.begin(), z.end(), '.', ',');  // decimal commas between semicolons
      points += fmt::format("{};{};{}\n", -20 + 10 * i, 10 + 10 * j, z);
    }
  }
  for (int i = 0; i < 7; ++i) matrix += fmt::format(",{}", -20 + 10 * i);
  for (int j = 4; j >= 0; --j) {
    matrix += fmt::format("\n{}", 10 + 10 * j);
    for (int i = 0; i < 7; ++i) {
      const std::string z = fmt::format("{:.9g}", dish(-20 + 10 * i, 10 + 10 * j));
      matrix += "," + z;
      grid += z + " ";
    }
    grid += "\n";
  }
  expect_same(read_heights(folder.write("points.csv", points)), mesh);
  expect_same(read_heights(folder.write("matrix.csv", matrix)), mesh);
  expect_same(read_heights(folder.write("grid.asc", grid)), mesh);
}

TEST(HeightFile, PlacesWithoutHeightAreHoles) {
  const ScratchFolder folder;
  const TriangleReading reading =
      read_heights(folder.write("holes.csv", "y,0,1,2,3\n0,1,1,1,1\n1,1,,1,nan\n2,1,1,1,1\n3,1,1,1,1\n"));
  ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().text();
  EXPECT_EQ(reading.triangles.corners.size(), 2u * 3);  // of nine rectangles six touch a hole
}

TEST(HeightFile, FaultsNameFileAndLine) {
  const ScratchFolder folder;
  const auto read = [&](const std::string& text) { return read_heights(folder.write("bad.csv", text)); };
  expect_error(read(""), "bad.csv: is empty");
  expect_error(read("x,y,z\n0,0,1\n1,0,one\n0,1,1\n1,1,1\n"), "bad.csv:3: \"one\" in column 3 is no number");
  expect_error(read("0,0,1\n1,0,1\n0,1\n1,1,1\n"), "bad.csv:3: has 2 columns, the lines before it have 3");
  expect_error(read("0 0 1\n1 0 1\n0 1 1\n1 1 1\n1 1 2\n"), "bad.csv:5: a second height at x = 1, y = 1");
  expect_error(read("y,0,2,1\n0,1,1,1\n1,1,1,1\n"), "bad.csv:1: places along x are not in order: 1 after 2");
  expect_error(read("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\n1 1 1\n1 1 1\n"), "has no cellsize");
  expect_error(read("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1 1\n1 1 1\n"),
               "and 2 rows follow");
  std::string scattered;
  for (int k = 0; k < 60; ++k) scattered += fmt::format("{} {} 1\n", std::sin(k), std::cos(3 * k));
  expect_error(read(scattered), "they lie on no rectangular grid");
}

TEST(DamagedMold, IsReadOrRefusedWithItsName) {
  const ScratchFolder folder;
  const Triangles mesh = triangulated(dish, kBox, 6, 4);
  std::mt19937 random(5);
  int good = 0, refused = 0;
  for (const auto& [name, text] : {std::pair("a.stl", text_stl(mesh)), std::pair("b.stl", binary_stl(mesh)),
                                   std::pair("c.obj", obj(mesh)), std::pair("e.csv", points_csv(mesh))}) {
    for (int k = 0; k < 60; ++k) {
      std::string damaged = text;
      for (int change = 0; change < 3; ++change) damaged[random() % damaged.size()] = char(random() % 256);
      if (k % 5 == 0) damaged.resize(random() % damaged.size());
      const auto file = folder.write(name, damaged);
      const MoldReading reading = read_mold_file(file, name, {.heights = file.extension() == ".csv"});
      (reading.errors.empty() ? good : refused) += 1;
      for (const InputError& error : reading.errors) EXPECT_NE(error.text().find(name), std::string::npos);
      if (reading.errors.empty()) {
        EXPECT_STREQ(spline_fault(reading.surface.spline), "");
      }
    }
  }
  EXPECT_GT(good, 10);
  EXPECT_GT(refused, 10);
}

TEST(SplineText, KeepsEveryBitAndRefusesWhatItDidNotWrite) {
  Eigen::MatrixXd numbers(4, 5);
  for (int k = 0; k < 20; ++k) numbers(k % 4, k / 4) = std::sin(k) * std::pow(10, k - 10);
  const std::string text = coefficient_text(numbers);
  ASSERT_TRUE(coefficients_of(text, 4, 5));
  EXPECT_EQ(*coefficients_of(text, 4, 5), numbers);
  EXPECT_FALSE(coefficients_of(text, 4, 4));
  EXPECT_FALSE(coefficients_of(text + "=", 4, 5));
  EXPECT_FALSE(coefficients_of("no base64", 4, 5));
  numbers(2, 2) = std::nan("");
  EXPECT_FALSE(coefficients_of(coefficient_text(numbers), 4, 5));
}

}  // namespace
}  // namespace drapeplan
