#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/mapping/nets.hpp"

namespace drapeplan {
namespace {

TEST(MappedPoint, IsExactAtNodesAndOnPlanes) {
  const Mold plane = inclined_plane(0.4);
  const Net flat = map_ply(plane, {0.2, 0.1, {0, 0}, 0}, {Generators::axes, {0, 0}, {0.03, 0.01}, 0.01});
  const Eigen::Vector3d expected(std::cos(0.4) * (0.0771 - 0.03), -0.0333 - 0.01,
                                 -std::sin(0.4) * (0.0771 - 0.03));
  EXPECT_LE((mapped_point(flat, plane, {0.0771, -0.0333}) - expected).norm(), 1e-14);
  const Net net = article_net(Generators::mid_sides, 0.01);
  for (int j = 0; j < static_cast<int>(net.v.size()); j += 5) {
    for (int i = 0; i < static_cast<int>(net.u.size()); i += 5) {
      const Eigen::Vector3d point = mapped_point(net, article_mold(), {net.u[size_t(i)], net.v[size_t(j)]});
      EXPECT_LE((point - net.node(i, j)).norm(), 1e-14);
    }
  }
}

TEST(MappedPoint, AgreesBetweenCoarseAndFineNets) {
  const Net coarse = article_net(Generators::axes, 0.01), fine = article_net(Generators::axes, 0.005);
  for (double u = -0.2; u < 0.2025; u += 0.0137) {
    for (double v = -0.2; v < 0.2025; v += 0.0137) {
      EXPECT_LE(
          (mapped_point(coarse, article_mold(), {u, v}) - mapped_point(fine, article_mold(), {u, v})).norm(),
          5e-5);
    }
  }
}

TEST(MappedPoint, WorksOnANetOfOneCell) {
  const Mold mold = inclined_plane(0);
  const Net net = map_ply(mold, {0.1, 0.1, {0, 0}, 0}, {Generators::axes, {0, 0}, {-0.05, -0.05}, 1});
  ASSERT_EQ(net.nodes.size(), 4U);
  EXPECT_LE((mapped_point(net, mold, {0, 0}) - Eigen::Vector3d(0.05, 0.05, 0)).norm(), 1e-15);
}

TEST(MappedPoint, RefusesPointsOutsideThePly) {
  const Net net = article_net(Generators::axes, 0.02);
  EXPECT_THROW(mapped_point(net, article_mold(), {0.203, 0}), std::out_of_range);
  EXPECT_THROW(mapped_point(net, article_mold(), {0, std::nan("")}), std::out_of_range);
}

TEST(PrescribedBoundary, RunsAroundThePlyCounterClockwiseAndCloses) {
  const Net net = map_ply(inclined_plane(0), {0.3, 0.2, {0, 0}, 0}, {Generators::axes, {0, 0}, {0, 0}, 0.01});
  const std::vector<Eigen::Vector3d> outline = prescribed_boundary(net);
  ASSERT_EQ(outline.size(), 2 * (30 + 20) + 1U);
  EXPECT_EQ(outline.front(), outline.back());
  EXPECT_EQ(outline.front(), mapped_corners(net)[0]);
  double doubled_area = 0, length = 0;
  for (size_t k = 1; k < outline.size(); ++k) {
    doubled_area += outline[k - 1].x() * outline[k].y() - outline[k].x() * outline[k - 1].y();
    length += (outline[k] - outline[k - 1]).norm();
  }
  EXPECT_NEAR(doubled_area / 2, 0.06, 1e-13);
  EXPECT_NEAR(length, 1.0, 1e-12);
  const std::vector<Eigen::Vector3d> corners = mapped_corners(net);
  ASSERT_EQ(corners.size(), 4U);
  EXPECT_LE((corners[1] - Eigen::Vector3d(0.15, -0.1, 0)).norm(), 1e-13);
  EXPECT_LE((corners[3] - Eigen::Vector3d(-0.15, 0.1, 0)).norm(), 1e-13);
}

TEST(PrescribedBoundary, FollowsTheOutlineOfAPlyThatIsNoRectangle) {
  const Ply ply = l_shaped_ply();
  const Mold mold = inclined_plane(0);
  const Net net = map_ply(mold, ply, {Generators::axes, {0, 0}, {0, 0}, 0.01});
  EXPECT_NEAR(net.u.front(), -0.1, 1e-15);
  EXPECT_NEAR(net.v.back(), 0.2, 1e-15);
  const std::vector<Eigen::Vector3d> boundary = prescribed_boundary(net, mold, ply);
  EXPECT_EQ(boundary.front(), boundary.back());
  EXPECT_LE((boundary.front() - Eigen::Vector3d(-0.1, -0.1, 0)).norm(), 1e-12);
  Polygon seen;
  for (size_t k = 0; k + 1 < boundary.size(); ++k) {
    seen.emplace_back(boundary[k].head<2>());
    EXPECT_LE((boundary[k + 1] - boundary[k]).norm(), 0.01 + 1e-12);
  }
  EXPECT_NEAR(signed_area(seen), 0.045, 1e-12);  // and counter-clockwise
  EXPECT_EQ(mapped_corners(net).size(), 4U);
}

TEST(PrescribedBoundary, OfAnOutlineThatIsTheRectangleLiesOnThatOfTheRectangle) {
  const Mold mold = article_mold();
  Ply ply{0.4, 0.4, {0.225, 0.225}, 0};
  const MappingOptions options{Generators::axes, {0.225, 0.225}, {0, 0}, 0.01};
  const Net net = map_ply(mold, ply, options);
  const std::vector<Eigen::Vector3d> known = prescribed_boundary(net, mold, ply);
  ply.outline = {{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}};
  const std::vector<Eigen::Vector3d> boundary = prescribed_boundary(net, mold, ply);
  ASSERT_EQ(boundary.size(), known.size());
  for (size_t k = 0; k < known.size(); ++k) EXPECT_LE((boundary[k] - known[k]).norm(), 1e-10);
}

}  // namespace
}  // namespace drapeplan
