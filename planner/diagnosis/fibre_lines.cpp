#include "planner/diagnosis/fibre_lines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drapeplan {
namespace {

/// An edge of an element is taken for a piece of a fibre if it leaves its direction by less than this slope:
/// along an outline cells are cut, and their edges are oblique.
constexpr double kAlong = 0.5;

size_t slot(Fibre fibre, bool forward) {
  return (fibre == Fibre::warp ? 0U : 2U) + (forward ? 0U : 1U);
}

}  // namespace

double arch_height(double slack, double span, double curvature) {
  if (!(slack > 0) || !(span > 0)) return 0;
  constexpr double kPi = std::numbers::pi;
  const double turn = 2 / kPi * curvature * span;
  return 2 * span / (kPi * kPi) * (turn + std::sqrt(turn * turn + kPi * kPi * slack / span));
}

FibreLines::FibreLines(const Mesh& mesh) : next_(mesh.rest.size(), {-1, -1, -1, -1}) {
  const auto link = [&](int from, int to) {
    const Eigen::Vector2d step = mesh.rest[size_t(to)] - mesh.rest[size_t(from)];
    const bool warp = std::abs(step.x()) > std::abs(step.y());
    const double along = warp ? step.x() : step.y(), across = warp ? step.y() : step.x();
    if (std::abs(across) > kAlong * std::abs(along)) return;
    int& known = next_[size_t(from)][slot(warp ? Fibre::warp : Fibre::weft, along > 0)];
    const auto slope = [&](int node) {
      const Eigen::Vector2d way = mesh.rest[size_t(node)] - mesh.rest[size_t(from)];
      return std::abs(warp ? way.y() / way.x() : way.x() / way.y());
    };
    if (known < 0 || slope(to) < slope(known)) known = to;
  };
  for (const std::array<int, 4>& quad : mesh.quads) {
    for (size_t c = 0; c < quad.size(); ++c) {
      const int a = quad[c], b = quad[(c + 1) % quad.size()];
      if (a == b) continue;  // of a triangle
      link(a, b);
      link(b, a);
    }
  }
}

std::optional<int> FibreLines::next(int node, Fibre fibre, bool forward) const {
  const int next = next_[size_t(node)][slot(fibre, forward)];
  return next < 0 ? std::nullopt : std::optional(next);
}

FibreSpan FibreLines::span(int node, Fibre fibre,
                           const std::function<bool(const std::vector<int>&, int)>& goes_on,
                           const std::vector<Eigen::Vector3d>& position,
                           const std::vector<Eigen::Vector3d>& feet) const {
  FibreSpan span;
  const auto walk = [&](bool forward, bool& at_edge) {
    std::vector<int> way{node};
    // A line has no more nodes than the mesh: where lines of an outline meet, nothing goes round.
    while (way.size() <= next_.size()) {
      const std::optional<int> step = next(way.back(), fibre, forward);
      at_edge = !step;
      if (!step || !goes_on(way, *step)) break;
      way.push_back(*step);
    }
    return way;
  };
  span.nodes = walk(false, span.from_edge);
  std::reverse(span.nodes.begin(), span.nodes.end());
  const std::vector<int> rest = walk(true, span.to_edge);
  span.nodes.insert(span.nodes.end(), rest.begin() + 1, rest.end());
  for (size_t k = 1; k < span.nodes.size(); ++k) {
    const auto a = size_t(span.nodes[k - 1]), b = size_t(span.nodes[k]);
    span.ply += (position[b] - position[a]).norm();
    span.below += (feet[b] - feet[a]).norm();
  }
  return span;
}

}  // namespace drapeplan
