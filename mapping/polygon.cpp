#include "mapping/polygon.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "mapping/polyline.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// On which side of the line from a to b the point lies: -1, 0, 1.
int side(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const double turn = cross(b - a, p - a);
  return (turn > 0) - (turn < 0);
}

bool in_box(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  return (p.array() >= a.array().min(b.array())).all() && (p.array() <= a.array().max(b.array())).all();
}

/// Whether two segments have a point in common, ends included.
bool touch(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const int sc = side(a, b, c), sd = side(a, b, d), sa = side(c, d, a), sb = side(c, d, b);
  if (sc * sd < 0 && sa * sb < 0) return true;
  return (sc == 0 && in_box(a, b, c)) || (sd == 0 && in_box(a, b, d)) || (sa == 0 && in_box(c, d, a)) ||
         (sb == 0 && in_box(c, d, b));
}

}  // namespace

double signed_area(const Polygon& polygon) {
  double twice = 0;
  for (size_t k = 0; k < polygon.size(); ++k) {
    // Relative to the first corner, so that a polygon far from the origin loses no digits.
    twice += cross(polygon[k] - polygon[0], polygon[(k + 1) % polygon.size()] - polygon[0]);
  }
  return 0.5 * twice;
}

Polygon counter_clockwise(Polygon polygon) {
  if (signed_area(polygon) < 0) std::reverse(polygon.begin() + 1, polygon.end());
  return polygon;
}

// Monotone chain (A. M. Andrew, 1979): the lower chain from left to right, then the upper one back.
Polygon convex_hull(std::vector<Eigen::Vector2d> points) {
  if (points.empty()) return {};
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  const auto turns_left = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) > (b.y() - a.y()) * (c.x() - a.x());
  };
  Polygon hull;
  for (int chain = 0; chain < 2; ++chain) {
    const size_t first = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= first + 2 && !turns_left(hull[hull.size() - 2], hull.back(), point))
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // the first point of the other chain
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

Eigen::AlignedBox2d bounding_box(const Polygon& polygon) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& corner : polygon) box.extend(corner);
  return box;
}

Vector2d nearest_on_edges(const Polygon& polygon, const Vector2d& point) {
  Vector2d nearest = polygon.front();
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d candidate = nearest_on_segment(point, polygon[k], polygon[(k + 1) % polygon.size()]).place;
    const double squared = (candidate - point).squaredNorm();
    if (squared < smallest) {
      smallest = squared;
      nearest = candidate;
    }
  }
  return nearest;
}

bool contains(const Polygon& polygon, const Vector2d& point, double slack) {
  bool inside = false;  // a ray to the right crosses an odd number of edges
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside || (nearest_on_edges(polygon, point) - point).norm() <= slack;
}

std::optional<std::array<size_t, 2>> crossing_edges(const Polygon& polygon) {
  const size_t n = polygon.size();
  const auto corner = [&polygon, n](size_t k) -> const Vector2d& { return polygon[k % n]; };
  for (size_t i = 0; i < n; ++i) {
    if (corner(i) == corner(i + 1)) return std::array{i, i};
  }
  for (size_t i = 0; i < n; ++i) {
    const Vector2d here = corner(i + 1) - corner(i), next = corner(i + 2) - corner(i + 1);
    if (cross(here, next) == 0 && here.dot(next) < 0) return std::array{i, (i + 1) % n};  // folds back
    for (size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // neighbours
      if (touch(corner(i), corner(i + 1), corner(j), corner(j + 1))) return std::array{i, j};
    }
  }
  return std::nullopt;
}

}  // namespace drapeplan
