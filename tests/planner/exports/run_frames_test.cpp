#include "planner/exports/run_frames.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

#include "planner/exports/mapped_files.hpp"
#include "tests/mapping/molds.hpp"
#include "tests/planner/exports/vtu_text.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;
using test::Folder;
using test::text_of;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kHeight = 0.01;  // of the ply's middle above the mold [m]

/// Two grippers side by side over a plane; each pad is tilted about y by 30 degrees.
struct Drape {
  Scene scene;
  Schedule schedule;
  MapResult mapping;
  std::vector<Snapshot> frames;

  Drape() {
    scene.mesh = rectangle_mesh(0.2, 0.1, 0.05);
    scene.mesh.quads.push_back({0, 1, 6, 6});  // a triangle repeats one node
    scene.fabric.thickness = 0.002;
    scene.mold = Mold(PlaneShape{}, {{-0.2, -0.2}, {0.2, 0.2}});
    scene.rig.emplace();
    scene.rig->columns = 2;
    scene.rig->rows = 1;
    scene.rig->spacing = 0.1;
    scene.rig->pad_radius = 0.02;
    schedule = {{{{0, 0.1}, {2, 0.05}}, {{0, 0.1}}}, 0};
    schedule.release = {1.5, std::nullopt};
    mapping.net.u = {-0.1, 0.1};
    mapping.net.v = {-0.05, 0.05};
    mapping.net.nodes = {{-0.1, -0.05, 0}, {0.1, -0.05, 0}, {-0.1, 0.05, 0}, {0.1, 0.05, 0}};
    mapping.boundary = {{-0.1, -0.05, 0}, {0.1, -0.05, 0}, {0.1, 0.05, 0}, {-0.1, -0.05, 0}};
    for (const double time : {0.0, 1.0, 2.0}) frames.push_back(at(time));
  }

  /// Turned about z by 3 degrees for each second.
  [[nodiscard]] Snapshot at(double time) const {
    Snapshot ply;
    ply.time = time;
    for (const Eigen::Vector2d& rest : scene.mesh.rest) {
      const Eigen::Vector2d turned = Eigen::Rotation2Dd(3 * kDegree * time) * rest;
      ply.position.emplace_back(turned.x(), turned.y(), kHeight);
    }
    ply.director.assign(scene.mesh.rest.size(), Vector3d::UnitZ());
    ply.shear.assign(scene.mesh.quads.size(), 10 * kDegree);
    ply.warp_strain.assign(scene.mesh.quads.size(), 0.001);
    ply.weft_strain.assign(scene.mesh.quads.size(), -0.002);
    ply.pad = {{-0.05, 0, kHeight}, {0.05, 0, kHeight}};
    const Vector3d arm = 0.005 * Vector3d(std::sin(30 * kDegree), 0, std::cos(30 * kDegree));
    ply.joint = {ply.pad[0] + arm, ply.pad[1] + arm};
    ply.actuator_force = {-50, 7};
    return ply;
  }
  [[nodiscard]] RunFrames run() const { return {&scene, &frames, &schedule, &mapping}; }
};

const std::vector<double>& field_of(const std::vector<VtkField>& fields, const std::string& name) {
  static const std::vector<double> none;
  for (const VtkField& field : fields)
    if (field.name == name) return field.values;
  ADD_FAILURE() << "no field " << name;
  return none;
}

void expect_all(const std::vector<double>& values, size_t count, double value) {
  EXPECT_EQ(values.size(), count);
  for (const double one : values) EXPECT_NEAR(one, value, 1e-9);
}

TEST(RunFrames, PlyHasItsFieldsInSiUnitsAndDegrees) {
  const Drape drape;
  const VtkGrid grid = ply_grid(drape.run(), drape.frames[1]);
  const size_t nodes = drape.scene.mesh.rest.size(), cells = drape.scene.mesh.quads.size();
  EXPECT_EQ(grid.points, drape.frames[1].position);
  ASSERT_EQ(grid.cells.size(), cells);
  for (size_t k = 0; k + 1 < cells; ++k) EXPECT_EQ(grid.cells[k].kind, VtkKind::quad);
  EXPECT_EQ(grid.cells.back().kind, VtkKind::triangle);
  EXPECT_EQ(grid.cells.back().points, (std::vector<std::int64_t>{0, 1, 6}));
  expect_all(field_of(grid.point_fields, "gap_m"), nodes, kHeight - 0.001);
  expect_all(field_of(grid.cell_fields, "shear_deg"), cells, 10);
  expect_all(field_of(grid.cell_fields, "warp_strain"), cells, 0.001);
  expect_all(field_of(grid.cell_fields, "weft_strain"), cells, -0.002);
  expect_all(field_of(grid.cell_fields, "fibre_angle_offset_deg"), cells, 3);
}

TEST(RunFrames, PadsAreDiscsWithLagForceAndSuction) {
  const Drape drape;
  const VtkGrid grid = gripper_grid(drape.run(), drape.frames[2]);
  ASSERT_EQ(grid.cells.size(), 2u);
  EXPECT_EQ(grid.cells[0].kind, VtkKind::polygon);
  const Vector3d normal(std::sin(30 * kDegree), 0, std::cos(30 * kDegree));
  for (size_t g = 0; g < 2; ++g) {
    ASSERT_GE(grid.cells[g].points.size(), 16u);
    Vector3d middle = Vector3d::Zero();
    for (const std::int64_t point : grid.cells[g].points) {
      const Vector3d arm = grid.points[size_t(point)] - drape.frames[2].pad[g];
      EXPECT_NEAR(arm.norm(), 0.02, 1e-12);
      EXPECT_NEAR(arm.dot(normal), 0, 1e-12);
      middle += arm;
    }
    EXPECT_LE(middle.norm(), 1e-12);
  }
  EXPECT_EQ(field_of(grid.cell_fields, "gripper_i"), (std::vector<double>{1, 2}));
  EXPECT_EQ(field_of(grid.cell_fields, "gripper_j"), (std::vector<double>{1, 1}));
  EXPECT_EQ(field_of(grid.cell_fields, "actuator_force_N"), (std::vector<double>{-50, 7}));
  EXPECT_EQ(field_of(grid.cell_fields, "suction"), (std::vector<double>{0, 1}));
  const std::vector<double>& lag = field_of(grid.cell_fields, "lag_m");
  ASSERT_EQ(lag.size(), 6u);
  EXPECT_NEAR(lag[2], 0.05 - drape.frames[2].joint[0].z(), 1e-12);
  EXPECT_NEAR(lag[5], 0.1 - drape.frames[2].joint[1].z(), 1e-12);
  for (const size_t k : {0u, 1u, 3u, 4u}) EXPECT_EQ(lag[k], 0) << "x and y are not driven";
}

TEST(RunFrames, InPlaneLagIsThereWhereItIsDriven) {
  Drape drape;
  drape.scene.rig->driven = Driven::xyz;
  drape.schedule.plane_paths = {{{0, {-0.05, 0.01}}}, {{0, {0.06, 0}}}};
  const VtkGrid grid = gripper_grid(drape.run(), drape.frames[0]);
  const std::vector<double>& lag = field_of(grid.cell_fields, "lag_m");
  EXPECT_NEAR(lag[1], 0.01, 1e-12);
  EXPECT_NEAR(lag[3], 0.06 - drape.frames[0].joint[1].x(), 1e-12);
}

TEST(RunFrames, APadWhoseJointLiesInItIsLevel) {
  Drape drape;
  drape.frames[0].joint = drape.frames[0].pad;
  for (const Vector3d& point : gripper_grid(drape.run(), drape.frames[0]).points)
    EXPECT_NEAR(point.z(), kHeight, 1e-12);
}

TEST(RunFrames, InterlinksAreLinesBetweenJoints) {
  const Drape drape;
  const VtkGrid grid = interlink_grid(drape.scene, drape.frames[0]);
  EXPECT_EQ(grid.points, drape.frames[0].joint);
  ASSERT_EQ(grid.cells.size(), 1u);
  EXPECT_EQ(grid.cells[0].kind, VtkKind::line);
  expect_all(field_of(grid.cell_fields, "length_m"), 1, 0.1);
}

TEST(RunFrames, AllFilesOfACollectionHaveTheSameFields) {
  const Folder folder;
  const Drape drape;
  const NamedFiles files = write_frames(folder.path(), "ply", drape.run());
  ASSERT_EQ(files.size(), 3u);
  for (const auto& [collection, what] : files) {
    const std::string text = text_of(folder / collection);
    std::set<std::vector<std::string>> fields;
    int count = 0;
    for (size_t at = text.find("file=\""); at != std::string::npos; at = text.find("file=\"", at + 1)) {
      const size_t name = at + 6;
      const std::string grid = text_of(folder / text.substr(name, text.find('"', name) - name));
      std::vector<std::string> all = test::arrays_of(grid, "PointData");
      all.emplace_back("cells:");
      for (const std::string& one : test::arrays_of(grid, "CellData")) all.push_back(one);
      fields.insert(all);
      ++count;
    }
    EXPECT_EQ(count, 3) << collection;
    EXPECT_EQ(fields.size(), 1u) << collection << what;
  }
}

TEST(RunFrames, WhatAcaseDoesNotHaveIsNotWritten) {
  const Folder folder;
  Drape drape;
  drape.scene.rig->interlinks.reset();
  EXPECT_EQ(write_frames(folder.path(), "bars", drape.run()).size(), 2u);
  drape.scene.rig.reset();
  drape.scene.mold.reset();
  EXPECT_EQ(write_frames(folder.path(), "bare", {&drape.scene, &drape.frames}).size(), 1u);
  const std::string text = text_of(folder / "bare_000.vtu");
  EXPECT_EQ(test::arrays_of(text, "PointData"), std::vector<std::string>{"director"});
  EXPECT_EQ(test::arrays_of(text, "CellData"),
            (std::vector<std::string>{"shear_deg", "warp_strain", "weft_strain"}));
  for (const char* name : {"bars_interlinks.pvd", "bare_grippers.pvd"})
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
}

TEST(RunFrames, BoundaryIsOneLine) {
  const Folder folder;
  const Drape drape;
  EXPECT_EQ(write_surroundings(folder.path(), *drape.scene.mold, &drape.mapping).size(), 2u);
  const std::string text = text_of(folder / "boundary.vtu");
  EXPECT_EQ(test::values_of(text, "points").size(), 12u);
  EXPECT_EQ(test::values_of<std::uint8_t>(text, "types"), std::vector<std::uint8_t>{4});
  EXPECT_NE(text_of(folder / "boundary.pvd").find("file=\"boundary.vtu\""), std::string::npos);
}

TEST(RunFrames, MoldIsAGridOverItsExtent) {
  const Mold mold(PlaneShape{0.2}, Extent{{0, 0}, {0.4, 0.2}});
  const VtkGrid grid = mold_grid(mold, 5);
  EXPECT_EQ(grid.points.size(), 25u);
  EXPECT_EQ(grid.cells.size(), 16u);
  EXPECT_LE((grid.points[24] - Vector3d(0.4, 0.2, mold.height(0.4, 0.2))).norm(), 1e-15);
  expect_all(field_of(grid.point_fields, "gaussian_curvature_per_m2"), 25, 0);
}

TEST(RunFrames, MoldIsLeftOutWhereItIsNotDefined) {
  const Mold dome(SphereShape{{0, 0, 0}, 1}, Extent{{-2, -2}, {2, 2}});
  const VtkGrid grid = mold_grid(dome, 21);
  EXPECT_GT(grid.cells.size(), 0u);
  for (const Vector3d& point : grid.points) EXPECT_LE(point.cwiseAbs().maxCoeff(), 1.0 + 1e-12);
  for (const VtkCell& cell : grid.cells) {
    for (const std::int64_t point : cell.points)
      EXPECT_TRUE(point >= 0 && point < std::int64_t(grid.points.size()));
  }
  EXPECT_THROW(mold_grid(dome, 1), std::invalid_argument);
}

TEST(MappedFiles, NetTargetsAndReachableHaveTheirPlaces) {
  const Drape drape;
  const VtkGrid net = net_grid(drape.mapping.net);
  EXPECT_EQ(field_of(net.point_fields, "u_m"), (std::vector<double>{-0.1, 0.1, -0.1, 0.1}));
  EXPECT_EQ(field_of(net.point_fields, "v_m"), (std::vector<double>{-0.05, -0.05, 0.05, 0.05}));
  ASSERT_EQ(net.cells.size(), 1u);
  EXPECT_EQ(net.cells[0].points, (std::vector<std::int64_t>{0, 1, 3, 2}));
  expect_all(field_of(net.cell_fields, "shear_deg"), 1, 0);
  ReachProblem problem{*drape.scene.rig, *drape.scene.mold, {{-0.05, 0, 0}, {0.05, 0, 0}}};
  ReachResult reach;
  reach.positions = {{-0.05, 0.003, 0}, {0.05, 0, 0}};
  reach.per_gripper = {0.003, 0};
  const VtkGrid grid = reachable_grid(problem, reach);
  ASSERT_EQ(grid.points.size(), 4u);
  EXPECT_EQ(grid.points[2], problem.targets[0]);
  ASSERT_EQ(grid.cells.size(), 2u);
  EXPECT_EQ(grid.cells[1].points, (std::vector<std::int64_t>{1, 3}));
  EXPECT_EQ(field_of(grid.cell_fields, "distance_m"), reach.per_gripper);
  EXPECT_EQ(field_of(grid.cell_fields, "gripper_i"), (std::vector<double>{1, 2}));
  const Folder folder;
  write_reach(folder.path(), problem, reach);
  EXPECT_TRUE(std::filesystem::exists(folder / "targets.pvd"));
  EXPECT_FALSE(std::filesystem::exists(folder / "reachable.vtu")) << "the solver has found nothing";
}

}  // namespace
}  // namespace drapeplan
