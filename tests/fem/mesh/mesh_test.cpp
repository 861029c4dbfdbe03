#include "fem/mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>
#include <set>

#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Polygon turned(Polygon polygon, double degrees) {
  for (Eigen::Vector2d& corner : polygon) corner = Eigen::Rotation2Dd(degrees * kDegree) * corner;
  return polygon;
}

Polygon rectangle(double width, double height) {
  return {{-0.5 * width, -0.5 * height},
          {0.5 * width, -0.5 * height},
          {0.5 * width, 0.5 * height},
          {-0.5 * width, 0.5 * height}};
}

Polygon l_shape() {
  return {{0, 0}, {0.2, 0}, {0.2, 0.1}, {0.1, 0.1}, {0.1, 0.25}, {0, 0.25}};
}

Polygon disc(double radius, int corners) {
  Polygon polygon;
  for (int k = 0; k < corners; ++k)
    polygon.emplace_back(Eigen::Rotation2Dd(360 * kDegree * k / corners) * Eigen::Vector2d(radius, 0));
  return polygon;
}

double area_of(const Mesh& mesh) {
  const std::vector<double> areas = nodal_areas(mesh);
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

/// All with sharp corners only: the mesh must meet them exactly.
std::vector<Polygon> polygons() {
  return {rectangle(0.4, 0.2),
          l_shape(),
          turned(l_shape(), 20),
          turned(rectangle(0.2, 0.2), 45),
          turned(rectangle(0.2, 0.2), 30),
          turned(rectangle(0.12, 0.27), 45),
          turned(rectangle(0.15, 0.016), 30),
          // At 45 degrees, rounded as in a file:
          {{0.053033, -0.137886}, {0.137886, -0.053033}, {-0.053033, 0.137886}, {-0.137886, 0.053033}},
          {{0, 0}, {0.2, 0.02}, {0.05, 0.15}}};
}

/// Largest force on a node off the outline, over the force that one side of an element carries, after a
/// homogeneous deformation that stretches and shears the ply and lifts it out of its plane.
double patch_error(const Mesh& mesh) {
  constexpr double kModulus = 1e9;
  const Fabric fabric = test::linear_fabric(kModulus, 1e6, 1e6);
  Scene scene;
  scene.mesh = mesh;
  scene.fabric = fabric;
  scene.options.bulk_viscosity = 0;  // a state that is put there is no motion
  const Model model(scene);
  State state = model.flat_state(0);
  Eigen::Matrix<double, 3, 2> gradient;
  gradient << 1.01, 0.2, -0.1, 0.98, 0.3, 0.1;
  const Eigen::Vector3d normal = gradient.col(0).cross(gradient.col(1)).normalized();
  for (size_t n = 0; n < mesh.rest.size(); ++n) {
    test::put(state.position, n, gradient * mesh.rest[n]);
    test::put(state.director, n, normal);
  }
  std::vector<Forces> entries = model.shell().entries();
  model.shell().forces(state, entries.data());
  const std::set<int> edge(mesh.outline.begin(), mesh.outline.end());
  double largest = 0, on_edge = 0;
  for (int n = 0; n < mesh.node_count(); ++n) {
    const double force = test::get(entries[0].force, size_t(n)).norm();
    (edge.contains(n) ? on_edge : largest) = std::max(edge.contains(n) ? on_edge : largest, force);
  }
  EXPECT_GT(on_edge, 1.0);  // [N]: there is something to balance
  return largest / on_edge;
}

TEST(Mesh, CoversItsRectangleWithCellsNoLargerThanAsked) {
  const Mesh mesh = rectangle_mesh(0.4, 0.2, 0.03);
  const std::vector<double> areas = nodal_areas(mesh);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 0.08, 1e-15);
  EXPECT_EQ(mesh.element_count(), 14 * 7);
  EXPECT_EQ(mesh.outline.size(), 2u * (14 + 7));
  EXPECT_EQ(std::set<int>(mesh.outline.begin(), mesh.outline.end()).size(), mesh.outline.size());
}

TEST(Mesh, HasLinesThroughGivenPlacesAndNoSliverAtTheEdge) {
  const std::vector<double> places{-0.2, -0.1, 0, 0.1, 0.2};
  const Mesh mesh = rectangle_mesh(0.405, 0.405, 0.01, places, places);
  EXPECT_EQ(mesh.element_count(), 40 * 40);
  double smallest = 1;
  for (const auto& quad : mesh.quads) {
    smallest = std::min(smallest, (mesh.rest[size_t(quad[1])] - mesh.rest[size_t(quad[0])]).norm());
  }
  EXPECT_NEAR(smallest, 0.01, 1e-12);
  EXPECT_NEAR(mesh.rest.front().x(), -0.2025, 1e-15);
  bool found = false;
  for (const Eigen::Vector2d& x : mesh.rest) found = found || (x - Eigen::Vector2d(-0.1, 0.1)).norm() < 1e-12;
  EXPECT_TRUE(found);
}

TEST(Mesh, RefusesLengthsThatAreNotPositive) {
  EXPECT_THROW(rectangle_mesh(0, 1, 0.1), std::invalid_argument);
  EXPECT_THROW(rectangle_mesh(1, 1, -0.1), std::invalid_argument);
}

TEST(OutlineMesh, PassesThePatchTestAndHasTheOutlinesArea) {
  for (const Polygon& polygon : polygons()) {
    for (const double size : {0.0053, 0.0101}) {
      SCOPED_TRACE(testing::Message() << "polygon from " << polygon[0].transpose() << ", mesh size " << size);
      const Mesh mesh = outline_mesh(polygon, size);
      EXPECT_LE(std::abs(area_of(mesh) / signed_area(polygon) - 1), 1e-12);
      EXPECT_LE(patch_error(mesh), 1e-12);
      for (const Eigen::Vector2d& corner : polygon) {
        double nearest = 1;
        for (const int n : mesh.outline) nearest = std::min(nearest, (mesh.rest[size_t(n)] - corner).norm());
        EXPECT_LE(nearest, 1e-12);
      }
    }
  }
}

TEST(OutlineMesh, FollowsACurveWithSecondOrder) {
  std::vector<double> errors;
  for (const double size : {0.02, 0.01, 0.005}) {
    const Polygon circle = disc(0.1, 1024);
    const Mesh mesh = outline_mesh(circle, size);
    EXPECT_LE(patch_error(mesh), 1e-12);
    errors.push_back(1 - area_of(mesh) / signed_area(circle));
  }
  for (size_t k = 1; k < errors.size(); ++k) {
    const double order = std::log2(errors[k - 1] / errors[k]);
    EXPECT_GE(order, 1.5);
    EXPECT_LE(order, 2.5);
  }
  const Polygon polygon = disc(0.1, 64);
  EXPECT_LE(std::abs(area_of(outline_mesh(polygon, 0.01)) / signed_area(polygon) - 1), 0.002);
}

TEST(OutlineMesh, OfARectangleIsTheRectangleMesh) {
  const std::vector<double> places{-0.2, -0.1, 0, 0.1, 0.2};
  for (const std::vector<double>& at : {std::vector<double>(), places}) {
    const Mesh mesh = outline_mesh(rectangle(0.405, 0.41), 0.01, at, at);
    const Mesh known = rectangle_mesh(0.405, 0.41, 0.01, at, at);
    ASSERT_EQ(mesh.quads, known.quads);
    EXPECT_EQ(mesh.outline, known.outline);
    for (size_t n = 0; n < mesh.rest.size(); ++n) EXPECT_LE((mesh.rest[n] - known.rest[n]).norm(), 1e-15);
  }
}

TEST(OutlineMesh, KeepsEdgesOnTheFibresAndTheStepOfFullCells) {
  Scene scene;
  scene.fabric = test::woven_fabric();
  scene.mesh = rectangle_mesh(0.2, 0.2, 0.01);
  const double full = Model(scene).stable_dt();
  for (double degrees = 0; degrees < 90; degrees += 7.5) {
    scene.mesh = outline_mesh(turned(l_shape(), degrees), 0.01);
    EXPECT_GE(Model(scene).stable_dt(), 0.35 * full) << degrees;
    const std::set<int> edge(scene.mesh.outline.begin(), scene.mesh.outline.end());
    for (const auto& quad : scene.mesh.quads) {
      for (size_t c = 0; c < 4; ++c) {
        const int a = quad[c], b = quad[(c + 1) % 4];
        if (edge.contains(a) || edge.contains(b)) continue;
        const Eigen::Vector2d side = scene.mesh.rest[size_t(b)] - scene.mesh.rest[size_t(a)];
        EXPECT_LE(side.cwiseAbs().minCoeff(), 1e-12);
      }
    }
  }
}

TEST(OutlineMesh, RunsCounterClockwiseFromTheFirstPointWhicheverWayThePolygonIsGiven) {
  Polygon clockwise = l_shape();
  std::reverse(clockwise.begin(), clockwise.end());
  for (const Polygon& polygon : {l_shape(), clockwise}) {
    const Mesh mesh = outline_mesh(polygon, 0.01);
    EXPECT_LE((mesh.rest[size_t(mesh.outline.front())] - polygon.front()).norm(), 1e-12);
    Polygon edge;
    for (const int n : mesh.outline) edge.push_back(mesh.rest[size_t(n)]);
    EXPECT_LE(std::abs(signed_area(edge) / std::abs(signed_area(polygon)) - 1), 1e-12);
  }
}

TEST(OutlineMesh, RefusesPolygonsThatCrossThemselvesAndCellsThatAreTooLarge) {
  EXPECT_THROW(outline_mesh({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 0.1), std::invalid_argument);
  EXPECT_THROW(outline_mesh({{0, 0}, {1, 1}}, 0.1), std::invalid_argument);
  EXPECT_THROW(outline_mesh(turned(rectangle(0.15, 0.01), 30), 0.05), std::invalid_argument);
}

}  // namespace
}  // namespace drapeplan
