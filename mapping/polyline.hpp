// The nearest point of a segment and of a polyline, in the plane or in space.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace drapeplan {

/// A point of a polyline. Point: Eigen::Vector2d or Eigen::Vector3d.
template <typename Point>
struct OnPolyline {
  size_t segment = 0;  ///< from point `segment` to the next one
  double along = 0;    ///< 0 to 1
  Point place;
};

/// The nearest point of the segment from a to b; a where both are one.
/// @param segment  what the result calls it.
template <typename Point>
OnPolyline<Point> nearest_on_segment(const Point& p, const Point& a, const Point& b, size_t segment = 0) {
  const Point ab = b - a;
  const double length2 = ab.squaredNorm();
  const double along = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return {segment, along, a + along * ab};
}

/// @param line  at least two points; a closed one repeats its first point. The first of equally near points
/// is returned.
template <typename Point>
OnPolyline<Point> nearest_on_polyline(const Point& p, const std::vector<Point>& line) {
  OnPolyline<Point> nearest{0, 0, line.front()};
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k + 1 < line.size(); ++k) {
    const OnPolyline<Point> candidate = nearest_on_segment(p, line[k], line[k + 1], k);
    const double distance2 = (candidate.place - p).squaredNorm();
    if (distance2 < smallest) smallest = distance2, nearest = candidate;
  }
  return nearest;
}

}  // namespace drapeplan
