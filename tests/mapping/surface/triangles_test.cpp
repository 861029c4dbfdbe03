#include "mapping/surface/triangles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/mapping/surface/meshes.hpp"

namespace drapeplan {
namespace {

const Extent kBox{{0, 0}, {0.4, 0.3}};

double slope(double x, double y) {
  return 0.5 * x - 0.2 * y;
}

TEST(VerticalLines, MeetAPlaneAtItsHeightAlsoAtVerticesAndEdges) {
  const Triangles mesh = triangulated(slope, kBox, 8, 5);
  const VerticalLines lines(mesh);
  for (int i = 0; i <= 16; ++i) {
    for (int j = 0; j <= 10; ++j) {
      const double x = 0.4 * i / 16, y = 0.3 * j / 10;
      EXPECT_NEAR(lines.top(x, y), slope(x, y), 1e-12) << x << ' ' << y;
      EXPECT_EQ(lines.heights(x, y, 1e-6).size(), 1u) << x << ' ' << y;
    }
  }
}

TEST(VerticalLines, MeetASolidTwiceAndItsWallsNowhere) {
  const Triangles mesh = solid(triangulated(slope, kBox, 8, 5), -1);
  const VerticalLines lines(mesh);
  const std::vector<double> heights = lines.heights(0.123, 0.234, 1e-6);
  ASSERT_EQ(heights.size(), 2u);
  EXPECT_NEAR(heights[0], slope(0.123, 0.234), 1e-12);
  EXPECT_NEAR(heights[1], -1, 1e-12);
}

TEST(VerticalLines, MissWhatIsNotThere) {
  Triangles mesh = triangulated(slope, kBox, 1, 1);
  mesh.corners.pop_back();
  const VerticalLines lines(mesh);
  EXPECT_TRUE(std::isnan(lines.top(0.1, 0.25)));  // the triangle that was taken out
  EXPECT_FALSE(std::isnan(lines.top(0.3, 0.05)));
  EXPECT_TRUE(std::isnan(lines.top(0.5, 0.1)));
  EXPECT_TRUE(std::isnan(lines.top(std::nan(""), 0.1)));
  EXPECT_TRUE(lines.heights(-0.1, 0.1, 1e-6).empty());
}

}  // namespace
}  // namespace drapeplan
