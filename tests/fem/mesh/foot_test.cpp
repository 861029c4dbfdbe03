#include "fem/mesh/foot.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Every node turned, moved and lifted by a linear field: what is bilinear between nodes must follow it
/// exactly.
std::vector<Vector3d> moved(const Mesh& mesh) {
  std::vector<Vector3d> position;
  for (const Vector2d& rest : mesh.rest)
    position.emplace_back(0.1 - rest.y(), 0.2 + rest.x(), 0.3 * rest.x() - 0.4 * rest.y());
  return position;
}

TEST(Foot, FollowsALinearFieldExactlyAlsoInTrianglesAndObliqueCells) {
  const Polygon trapezium{{-0.1, -0.08}, {0.12, -0.05}, {0.07, 0.09}, {-0.1, 0.04}};
  for (const Mesh& mesh : {rectangle_mesh(0.2, 0.16, 0.03), outline_mesh(trapezium, 0.02)}) {
    const std::vector<Vector3d> position = moved(mesh);
    int found = 0;
    for (double u = -0.1; u < 0.1; u += 0.0137) {
      for (double v = -0.08; v < 0.08; v += 0.0119) {
        const auto foot = foot_of(mesh, {u, v});
        if (!foot) continue;
        ++found;
        EXPECT_LE(std::abs(std::accumulate(foot->weight.begin(), foot->weight.end(), -1.0)), 1e-12);
        const Vector3d error =
            place_of(mesh, *foot, position) - Vector3d(0.1 - v, 0.2 + u, 0.3 * u - 0.4 * v);
        EXPECT_LE(error.norm(), 1e-9) << u << ", " << v;
      }
    }
    EXPECT_GE(found, 100);
  }
}

TEST(Foot, OffTheMeshThereIsNoneAndTheNearestNodeStandsIn) {
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.05);
  EXPECT_FALSE(foot_of(mesh, {0.11, 0}));
  const Foot foot = nearest_foot(mesh, {0.11, 0.051});
  EXPECT_LE((place_of(mesh, foot, moved(mesh)) - Vector3d(0.05, 0.3, 0.01)).norm(), 1e-12);
}

TEST(Foot, AFoldedMeshCoversAPointTwice) {
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.05);
  std::vector<Vector2d> folded;  // the right half lies on the left one
  for (const Vector2d& rest : mesh.rest) folded.emplace_back(-std::abs(rest.x()), rest.y());
  EXPECT_EQ(feet_of(mesh, folded, {-0.06, 0.01}).size(), 2u);
  EXPECT_EQ(feet_of(mesh, mesh.rest, {-0.06, 0.01}).size(), 1u);
  EXPECT_TRUE(feet_of(mesh, folded, {0.06, 0.01}).empty());
}

}  // namespace
}  // namespace drapeplan
