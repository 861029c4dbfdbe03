// Fibres from node to node, and how much longer the ply is than the mold below it.
#include "planner/diagnosis/fibre_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace drapeplan {
namespace {

TEST(FibreLines, RunAlongBothFibresToTheEdge) {
  const Mesh mesh = rectangle_mesh(0.3, 0.2, 0.1);  // 4 by 3 nodes
  const FibreLines lines(mesh);
  for (int node = 0; node < mesh.node_count(); ++node) {
    for (const Fibre fibre : {Fibre::warp, Fibre::weft}) {
      const std::optional<int> next = lines.next(node, fibre, true);
      const Eigen::Vector2d at = mesh.rest[size_t(node)];
      const bool last = fibre == Fibre::warp ? at.x() > 0.149 : at.y() > 0.099;
      ASSERT_EQ(next.has_value(), !last);
      if (last) continue;
      const Eigen::Vector2d step = mesh.rest[size_t(*next)] - at;
      EXPECT_NEAR((step - (fibre == Fibre::warp ? Eigen::Vector2d(0.1, 0) : Eigen::Vector2d(0, 0.1))).norm(),
                  0, 1e-12);
      EXPECT_EQ(lines.next(*next, fibre, false), node);
    }
  }
}

TEST(FibreLines, OfAnyOutlineEndAtItsEdge) {
  const Mesh mesh = outline_mesh({{-0.2, -0.1}, {0.2, -0.15}, {0.15, 0.2}, {-0.1, 0.15}}, 0.02);
  const FibreLines lines(mesh);
  std::vector<bool> edge(mesh.rest.size(), false);
  for (const int node : mesh.outline) edge[size_t(node)] = true;
  for (int node = 0; node < mesh.node_count(); ++node) {
    int steps = 0;
    int at = node;
    for (std::optional<int> next = at; (next = lines.next(at, Fibre::warp, true)) && steps < 100; ++steps) {
      EXPECT_GT(mesh.rest[size_t(*next)].x(), mesh.rest[size_t(at)].x());
      at = *next;
    }
    EXPECT_TRUE(edge[size_t(at)]) << "a fibre ends inside the ply, at node " << at;
  }
}

TEST(FibreLines, ArchAndSlackBelongTogether) {
  // A sine arch of 6 mm on a plane.
  constexpr double kRise = 0.006, kChord = 0.1;
  const Mesh mesh = rectangle_mesh(0.2, 0.01, 0.001);
  const FibreLines lines(mesh);
  std::vector<Eigen::Vector3d> position, feet;
  int top = 0;
  for (int n = 0; n < mesh.node_count(); ++n) {
    const Eigen::Vector2d rest = mesh.rest[size_t(n)];
    const double along = rest.x() + 0.5 * kChord;
    const bool arch = along > 0 && along < kChord;
    feet.emplace_back(rest.x(), rest.y(), 0);
    position.emplace_back(rest.x(), rest.y(), arch ? kRise * std::sin(std::numbers::pi * along / kChord) : 0);
    if ((rest - Eigen::Vector2d(0, 0.005)).norm() <
        (mesh.rest[size_t(top)] - Eigen::Vector2d(0, 0.005)).norm())
      top = n;
  }
  const FibreSpan span = lines.span(
      top, Fibre::warp,
      [&](const std::vector<int>& way, int) { return position[size_t(way.back())].z() > 0; }, position, feet);
  EXPECT_FALSE(span.from_edge || span.to_edge);
  EXPECT_NEAR(span.below, kChord, 0.0011);  // to a cell
  EXPECT_NEAR(arch_height(span.slack(), span.below), kRise, 0.01 * kRise);
  EXPECT_EQ(arch_height(-0.001, 0.1), 0);
  // On a ridge of 0.5 m radius the same arch has more slack, by curvature times its area.
  EXPECT_NEAR(arch_height(span.slack() + 2 * 2 / std::numbers::pi * kRise * kChord, span.below, -2), kRise,
              0.02 * kRise);
  const FibreSpan across = lines.span(
      top, Fibre::weft,
      [&](const std::vector<int>& way, int) { return position[size_t(way.back())].z() > 0; }, position, feet);
  EXPECT_TRUE(across.from_edge && across.to_edge);
  EXPECT_NEAR(across.slack(), 0, 1e-12);
}

}  // namespace
}  // namespace drapeplan
