#include "planner/exports/fibres.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/planner/exports/vtu_text.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;
using test::Folder;
using test::text_of;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kShear = 25 * kDegree, kTurn = 40 * kDegree, kSlope = 30 * kDegree;

/// A ply on a slope about its warp: the weft leans towards the warp by the shear, and all is turned about z.
struct Sheared {
  Scene scene;
  Snapshot ply;
  Vector3d warp, weft;

  Sheared() {
    scene.mesh = rectangle_mesh(0.3, 0.2, 0.1);
    scene.mesh.quads.push_back({0, 1, 5, 5});  // a triangle repeats one node
    scene.fabric.thickness = 0.0003;
    const Eigen::AngleAxisd turn(kTurn, Vector3d::UnitZ()), tilt(kSlope, Vector3d::UnitX());
    warp = turn * (tilt * Vector3d::UnitX());
    weft = turn * (tilt * Vector3d(std::sin(kShear), std::cos(kShear), 0));
    for (const Eigen::Vector2d& rest : scene.mesh.rest)
      ply.position.emplace_back(Vector3d(1, 2, 3) + 1.01 * rest.x() * warp + 0.98 * rest.y() * weft);
    ply.shear.assign(scene.mesh.quads.size(), kShear);
    ply.time = 14;
  }
};

std::vector<std::vector<double>> rows_of(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

TEST(Fibres, EveryElementHasItsPlaceDirectionsShearAndThickness) {
  const Folder folder;
  const Sheared sheared;
  EXPECT_EQ(write_fibres(folder.path(), sheared.scene, sheared.ply, "slope", "0123").size(), 2u);
  const std::string text = text_of(folder / "fibres.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "element,u_m,v_m,x_m,y_m,z_m,warp_x,warp_y,warp_z,weft_x,weft_y,weft_z,shear_deg,thickness_m");
  const auto rows = rows_of(text);
  ASSERT_EQ(rows.size(), sheared.scene.mesh.quads.size());
  for (size_t e = 0; e < rows.size(); ++e) {
    const std::vector<double>& row = rows[e];
    ASSERT_EQ(row.size(), 14u);
    EXPECT_EQ(row[0], double(e));
    Eigen::Vector2d middle(0, 0);
    for (const int node : sheared.scene.mesh.quads[e]) middle += 0.25 * sheared.scene.mesh.rest[size_t(node)];
    EXPECT_NEAR(row[1], middle.x(), 1e-9);
    EXPECT_NEAR(row[2], middle.y(), 1e-9);
    const Vector3d place =
        Vector3d(1, 2, 3) + 1.01 * middle.x() * sheared.warp + 0.98 * middle.y() * sheared.weft;
    const Vector3d warp(row[6], row[7], row[8]), weft(row[9], row[10], row[11]);
    EXPECT_LE((Vector3d(row[3], row[4], row[5]) - place).norm(), 1e-8);
    EXPECT_LE((warp - sheared.warp).norm(), 1e-8);
    EXPECT_LE((weft - sheared.weft).norm(), 1e-8);
    EXPECT_NEAR(row[12], 25, 1e-7);
    EXPECT_NEAR(90 - std::acos(warp.dot(weft)) / kDegree, row[12], 1e-5) << "shear fits the directions";
    EXPECT_NEAR(row[13], 0.0003 / std::cos(kShear), 1e-12);
  }
}

TEST(Fibres, ThePlyKeepsItsVolume) {
  EXPECT_EQ(sheared_thickness(0.3, 0), 0.3);
  EXPECT_NEAR(sheared_thickness(0.3, 60 * kDegree), 0.6, 1e-15);
  EXPECT_EQ(sheared_thickness(0.3, -0.5), sheared_thickness(0.3, 0.5));
}

TEST(Fibres, MetadataDescribeEveryColumn) {
  const Folder folder;
  const Sheared sheared;
  write_fibres(folder.path(), sheared.scene, sheared.ply, "slope", "0123");
  const auto about = nlohmann::json::parse(text_of(folder / "fibres.csv-metadata.json"));
  EXPECT_EQ(about.at("url"), "fibres.csv");
  EXPECT_EQ(about.at("dc:title"), "slope");
  EXPECT_EQ(about.at("dc:identifier"), "0123");
  std::string names, description;
  for (const auto& column : about.at("tableSchema").at("columns")) {
    names += (names.empty() ? "" : ",") + column.at("name").get<std::string>();
    EXPECT_FALSE(column.at("dc:description").get<std::string>().empty());
  }
  const std::string text = text_of(folder / "fibres.csv");
  EXPECT_EQ(names, text.substr(0, text.find('\n')));
  for (const auto& line : about.at("dc:description")) description += line.get<std::string>() + "\n";
  EXPECT_NE(description.find("at 14 s"), std::string::npos) << description;
  EXPECT_NE(description.find("thickness: 0.0003 m of the flat ply over the cosine"), std::string::npos);
}

TEST(Fibres, WhatIsNotFiniteIsNotWritten) {
  const Folder folder;
  Sheared sheared;
  sheared.ply.position[3].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_fibres(folder.path(), sheared.scene, sheared.ply, "slope", "0123"),
               std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace drapeplan
