#include "fem/mesh.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace drapeplan {
namespace {

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

}  // namespace
}  // namespace drapeplan
