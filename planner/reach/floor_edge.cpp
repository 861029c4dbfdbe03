#include "planner/reach/floor_edge.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mapping/polyline.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A turn of the boundary from which on a vertex is a corner; below, it is a point of a curve.
constexpr double kCorner = 20 * std::numbers::pi / 180;
/// [m]: a node whose nearest point lies nearer to a corner than this minds both of its sides.
constexpr double kCornerReach = 0.010;

using Nearest = OnPolyline<Eigen::Vector3d>;

class Boundary {
 public:
  explicit Boundary(const FloorProblem& problem) : problem_(problem), line_(problem.boundary) {}

  /// Outwards, along the mold, at a point of a segment (the boundary runs counter-clockwise).
  [[nodiscard]] Eigen::Vector3d outwards(const Eigen::Vector3d& place, const Eigen::Vector3d& tangent) const {
    return tangent.cross(normal(place)).normalized();
  }
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& place) const {
    return problem_.mold.normal(place.x(), place.y());
  }
  [[nodiscard]] size_t segments() const { return line_.size() - 1; }
  [[nodiscard]] Eigen::Vector3d direction(size_t segment) const {
    const size_t k = segment % segments();
    return (line_[k + 1] - line_[k]).normalized();
  }
  /// Angle by which the boundary turns at point k, > 0 to the left [rad].
  [[nodiscard]] double turn(size_t k) const {
    const Eigen::Vector3d before = direction(k + segments() - 1), after = direction(k);
    return std::atan2(before.cross(after).dot(normal(line_[k % segments()])), before.dot(after));
  }
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& x) const { return nearest_on_polyline(x, line_); }
  [[nodiscard]] const Eigen::Vector3d& point(size_t k) const { return line_[k % segments()]; }

  /// The corner within reach of a nearest point, if there is one; else segments().
  [[nodiscard]] size_t corner_near(const Nearest& nearest) const {
    for (const int way : {-1, 1}) {
      size_t k = way > 0 ? nearest.segment + 1 : nearest.segment;
      double far = (point(k) - nearest.place).norm();
      while (far <= kCornerReach) {
        if (std::abs(turn(k)) > kCorner) return k % segments();
        const size_t next = way > 0 ? k + 1 : k + segments() - 1;
        far += (point(next) - point(k)).norm();
        k = next % segments();
      }
    }
    return segments();
  }

 private:
  const FloorProblem& problem_;
  const std::vector<Eigen::Vector3d>& line_;
};

void add_corner(const Boundary& boundary, size_t corner, int node, const Eigen::Vector3d& x, double tolerance,
                std::vector<EdgeLimit>& limits) {
  const double sign = boundary.turn(corner) > 0 ? 1 : -1;  // 1: the corner points outwards
  const Eigen::Vector3d& place = boundary.point(corner);
  std::array<EdgeLimit, 2> sides;
  for (size_t side = 0; side < 2; ++side) {
    const size_t segment = side == 0 ? corner + boundary.segments() - 1 : corner;
    const Eigen::Vector3d out = sign * boundary.outwards(place, boundary.direction(segment));
    sides[side] = {node, out, place, -kInfinity, tolerance};
  }
  const bool second = sides[1].direction.dot(x - place) > sides[0].direction.dot(x - place);
  sides[second ? 1 : 0].lower = -tolerance;
  limits.insert(limits.end(), sides.begin(), sides.end());
}

}  // namespace

std::vector<EdgeLimit> edge_limits(const FloorProblem& problem, const std::vector<Eigen::Vector3d>& nodes,
                                   double tolerance) {
  std::vector<EdgeLimit> limits;
  if (std::isinf(tolerance)) return limits;
  const Boundary boundary(problem);
  for (const int node : problem.net.outline) {
    const Eigen::Vector3d& x = nodes[size_t(node)];
    const Nearest nearest = boundary.nearest(x);
    const size_t corner = boundary.corner_near(nearest);
    if (corner < boundary.segments()) {
      add_corner(boundary, corner, node, x, tolerance, limits);
      continue;
    }
    // On a curve the tangent turns from the middle of a segment to that of the next one.
    const size_t n = boundary.segments(), k = nearest.segment;
    const Eigen::Vector3d here = boundary.direction(k);
    const Eigen::Vector3d other = boundary.direction(nearest.along < 0.5 ? k + n - 1 : k + 1);
    const double weight = std::abs(nearest.along - 0.5);
    const Eigen::Vector3d tangent = (1 - weight) * here + weight * other;
    limits.push_back({node, boundary.outwards(nearest.place, tangent), nearest.place, -tolerance, tolerance});
  }
  return limits;
}

double limit_change(const std::vector<EdgeLimit>& before, const std::vector<EdgeLimit>& after,
                    const std::vector<Eigen::Vector3d>& nodes) {
  if (before.size() != after.size()) return kInfinity;
  double change = 0;
  for (size_t k = 0; k < before.size(); ++k) {
    const EdgeLimit &a = before[k], &b = after[k];
    if (a.node != b.node || a.lower != b.lower || a.upper != b.upper) return kInfinity;
    const Eigen::Vector3d& x = nodes[size_t(a.node)];
    change = std::max(change, std::abs(a.direction.dot(x - a.place) - b.direction.dot(x - b.place)));
  }
  return change;
}

double edge_offset(const FloorProblem& problem, const std::vector<Eigen::Vector3d>& nodes) {
  const Boundary boundary(problem);
  double largest = 0;
  for (const int node : problem.net.outline) {
    const Eigen::Vector3d& x = nodes[size_t(node)];
    const Nearest nearest = boundary.nearest(x);
    const Eigen::Vector3d off = x - nearest.place, normal = boundary.normal(nearest.place);
    largest = std::max(largest, (off - off.dot(normal) * normal).norm());
  }
  return largest;
}

}  // namespace drapeplan
