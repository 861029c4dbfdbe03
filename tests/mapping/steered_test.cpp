// Generators along given lines.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "mapping/error.hpp"
#include "mapping/geodesic.hpp"
#include "mapping/polyline.hpp"
#include "tests/mapping/nets.hpp"

namespace drapeplan {
namespace {

using Line = std::vector<Eigen::Vector2d>;

MappingOptions along(const Eigen::Vector2d& start, Line warp, Line weft, double cell_size = 0.01) {
  MappingOptions options{Generators::steered, start, {0, 0}, cell_size};
  options.warp_line = std::move(warp);
  options.weft_line = std::move(weft);
  return options;
}

double largest_distance(const Net& a, const Net& b) {
  EXPECT_EQ(a.nodes.size(), b.nodes.size());
  double largest = 0;
  for (size_t k = 0; k < a.nodes.size(); ++k) {
    const double distance = (a.nodes[k] - b.nodes[k]).norm();
    largest = std::isfinite(distance) ? std::max(largest, distance) : 1e9;
  }
  return largest;
}

TEST(Steered, TwoPointsAlongTheAxesGiveTheAxes) {
  // Geodesics along the axes project to straight lines on a plane, and through the pole of a sphere.
  const Mold sphere_mold = sphere({0, 0, 0}, 1);
  for (const Mold& mold : {inclined_plane(0.4), sphere_mold}) {
    const Ply ply{0.3, 0.2, {0, 0}, 0};
    const Net axes = map_ply(mold, ply, {Generators::axes, {0, 0}, {0.03, 0}, 0.01});
    MappingOptions options = along({0, 0}, {{-0.4, 0}, {0.4, 0}}, {{0, -0.4}, {0, 0.4}});
    options.ply_start = {0.03, 0};
    EXPECT_LE(largest_distance(map_ply(mold, ply, options), axes), 1e-10);
    // Lines that end after 20 mm go on as geodesics; a line may begin at the start.
    options.warp_line = {{0, 0}, {0.02, 0}};
    options.weft_line = {{0, -0.02}, {0, 0.02}};
    EXPECT_LE(largest_distance(map_ply(mold, ply, options), axes), 1e-9);
    // One line is enough where the other generator is at right angles to it.
    options.warp_line.clear();
    EXPECT_LE(largest_distance(map_ply(mold, ply, options), axes), 1e-9);
  }
}

TEST(Steered, AGeodesicAsALineGivesTheGeodesicsNet) {
  const Mold mold = article_mold();
  const Eigen::Vector2d start(0.225, 0.225);
  const Ply ply{0.2, 0.2, start, 0};
  const Net geodesic = map_ply(mold, ply, {Generators::axes, start, {0, 0}, 0.01});
  const auto line = [&](const Eigen::Vector2d& direction, double spacing) {
    Line points;
    const int count = int(std::ceil(0.12 / spacing));
    const Geodesic back = shoot_geodesic(mold, start, -direction, spacing, count);
    for (size_t k = back.points.size() - 1; k > 0; --k) points.emplace_back(back.points[k].head<2>());
    for (const Eigen::Vector3d& p : shoot_geodesic(mold, start, direction, spacing, count).points)
      points.emplace_back(p.head<2>());
    return points;
  };
  double before = 0;
  for (const double spacing : {0.0072, 0.0036, 0.0018}) {
    const double error = largest_distance(
        map_ply(mold, ply, along(start, line({1, 0}, spacing), line({0, 1}, spacing))), geodesic);
    EXPECT_LE(error, 0.3 * spacing * spacing) << spacing;
    if (before > 0) {
      EXPECT_LE(error, 0.5 * before) << "second order in the spacing";
    }
    before = error;
  }
  EXPECT_LE(before, 2e-6);
}

TEST(Steered, NodesLieOnTheLineAChordApart) {
  const Mold mold = article_mold();
  const Eigen::Vector2d start(0.225, 0.225);
  const Line bent{{0.12, 0.2}, {0.225, 0.225}, {0.28, 0.26}, {0.4, 0.3}};
  const Net net = map_ply(mold, {0.2, 0.1, start, 0}, along(start, bent, {}));
  EXPECT_TRUE(net.converged);
  const int j = int(net.v.size()) / 2;
  ASSERT_NEAR(net.v[size_t(j)], 0, 1e-12);
  for (int i = 0; i < int(net.u.size()); ++i) {
    const Eigen::Vector2d xy = net.node(i, j).head<2>();
    EXPECT_LE((nearest_on_polyline(xy, bent).place - xy).norm(), 1e-12) << i;
    if (i > 0) {
      EXPECT_NEAR((net.node(i, j) - net.node(i - 1, j)).norm(), 0.01, 1e-12) << i;
    }
  }
  // The weft through the start is the geodesic that is at right angles to the way on, on the surface.
  const int i0 = int(net.u.size()) / 2;
  const Eigen::Vector3d way = mold.point(0.2251, 0.225 + 1e-4 * 35 / 55) - mold.point(0.225, 0.225);
  const Eigen::Vector3d weft = net.node(i0, j + 1) - net.node(i0, j);
  EXPECT_NEAR(way.normalized().dot(weft.normalized()), 0, 0.03);
}

std::string refusal(const MappingOptions& options) {
  try {
    map_ply(inclined_plane(0), {0.1, 0.1, {0, 0}, 0}, options);
  } catch (const WrongInput& error) {
    return error.what();
  }
  return "none";
}

TEST(Steered, LinesMustPassThroughTheStartTheRightWayRound) {
  const Line right{{-0.1, 0}, {0.1, 0}}, up{{0, -0.1}, {0, 0.1}}, down{{0, 0.1}, {0, -0.1}};
  EXPECT_EQ(refusal(along({0, 0}, right, up)), "none");
  EXPECT_NE(refusal(along({0, 0}, right, down)).find("from right to left"), std::string::npos);
  EXPECT_NE(refusal(along({0, 0}, {}, {})).find("need a warp_line or a weft_line"), std::string::npos);
  EXPECT_NE(refusal(along({0, 0.01}, right, {})).find("beside a line"), std::string::npos);
  EXPECT_NE(refusal(along({0, 0}, {{0, 0}}, {})).find("two points"), std::string::npos);
  EXPECT_NE(refusal(along({0, 0}, {{0, 0}, {0, 0}}, {})).find("no length"), std::string::npos);
}

TEST(Steered, WhereTheMoldEndsTheRunSaysSo) {
  const Mold mold = sphere({0, 0, 0}, 0.1);
  EXPECT_THROW(map_ply(mold, {0.3, 0.1, {0, 0}, 0}, along({0, 0}, {{-0.2, 0}, {0.2, 0}}, {})), NotFinished);
}

}  // namespace
}  // namespace drapeplan
