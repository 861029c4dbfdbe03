#include "mapping/polygon.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/mapping/nets.hpp"

namespace drapeplan {
namespace {

TEST(Polygon, KnowsItsAreaItsInsideAndWhereItCrossesItself) {
  const Polygon ply = l_shaped_ply().outline;
  EXPECT_NEAR(signed_area(ply), -0.045, 1e-15);
  EXPECT_NEAR(signed_area(counter_clockwise(ply)), 0.045, 1e-15);
  EXPECT_EQ(counter_clockwise(ply).front(), ply.front());
  EXPECT_TRUE(contains(ply, {-0.05, 0.1}));
  EXPECT_FALSE(contains(ply, {0.05, 0.1}));
  EXPECT_FALSE(contains(ply, {0.151, -0.05}));
  EXPECT_TRUE(contains(ply, {0.151, -0.05}, 0.002));
  EXPECT_FALSE(crossing_edges(ply).has_value());
  EXPECT_EQ(crossing_edges({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), (std::array<size_t, 2>{0, 2}));
  EXPECT_EQ(crossing_edges({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), (std::array<size_t, 2>{1, 1}));
  EXPECT_TRUE(crossing_edges({{0, 0}, {1, 0}, {0.5, 0}, {0, 1}}).has_value());  // folds back
}

TEST(Polygon, ConvexHullLeavesOutWhatLiesInsideAndOnEdges) {
  const Polygon hull = convex_hull({{0, 0}, {1, 0}, {0.5, 0}, {1, 1}, {0.5, 0.5}, {0, 1}, {0, 0.2}});
  EXPECT_EQ(hull.size(), 4U);
  EXPECT_NEAR(signed_area(hull), 1, 1e-15);
  EXPECT_EQ(convex_hull({{0, 0}, {2, 2}, {1, 1}}).size(), 2U);  // in a line: no area
  EXPECT_EQ(convex_hull({{3, 4}}).size(), 0U);
  EXPECT_EQ(convex_hull({}).size(), 0U);
}

}  // namespace
}  // namespace drapeplan
