#include "mapping/polyline.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(Polyline, NearestPointOfASegmentStaysBetweenItsEnds) {
  const Vector3d a(0, 0, 1), b(2, 0, 1);
  EXPECT_EQ(nearest_on_segment(Vector3d(0.5, 3, 1), a, b).place, Vector3d(0.5, 0, 1));
  EXPECT_EQ(nearest_on_segment(Vector3d(0.5, 3, 1), a, b).along, 0.25);
  EXPECT_EQ(nearest_on_segment(Vector3d(-4, 1, 2), a, b).place, a);
  EXPECT_EQ(nearest_on_segment(Vector3d(7, 1, 2), a, b).place, b);
  EXPECT_EQ(nearest_on_segment(b, a, a).place, a);
}

TEST(Polyline, NearestPointOfAPolylineKnowsItsSegment) {
  const std::vector<Vector2d> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  const auto right = nearest_on_polyline(Vector2d(0.9, 0.4), square);
  EXPECT_EQ(right.segment, 1U);
  EXPECT_EQ(right.along, 0.4);
  EXPECT_EQ(right.place, Vector2d(1, 0.4));
  EXPECT_EQ(nearest_on_polyline(Vector2d(-1, 0.5), square).segment, 3U);
  EXPECT_EQ(nearest_on_polyline(Vector2d(1, 0), square).segment, 0U) << "the first of equally near ones";
}

}  // namespace
}  // namespace drapeplan
