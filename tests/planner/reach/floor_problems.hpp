// Plies with rigs and molds that the tests of the floor share.
#pragma once

#include <cmath>

#include "planner/reach/floor.hpp"
#include "tests/planner/reach/problems.hpp"

namespace drapeplan {

/// A trough along y: z = x^2 / (2 R).
inline Mold trough(double radius) {
  return {PolynomialShape{{{2, 0, 0.5 / radius}}}, {{-0.3, -0.3}, {0.3, 0.3}}};
}

/// x of the trough's point at an arc length from its bottom, by Newton's method.
inline double trough_place(double radius, double arc) {
  double x = arc;
  for (int k = 0; k < 30; ++k) {
    const double slope = x / radius, root = std::sqrt(1 + slope * slope);
    x -= (0.5 * (x * root + radius * std::asinh(slope)) - arc) / root;
  }
  return x;
}

/// Pads hold the nodes within `reach` of their places; the boundary is the mapped outline.
inline void finish(FloorProblem& problem, double reach) {
  problem.held.assign(size_t(problem.rig.count()), {});
  for (int g = 0; g < problem.rig.count(); ++g) {
    for (int n = 0; n < problem.net.node_count(); ++n) {
      if ((problem.net.rest[size_t(n)] - problem.rig.place(g)).norm() <= reach)
        problem.held[size_t(g)].push_back(n);
    }
  }
  for (const int node : problem.net.outline) problem.boundary.push_back(problem.mapped[size_t(node)]);
  problem.boundary.push_back(problem.boundary.front());
}

/// Two grippers 100 mm apart across a trough, joints at the ply, the left one fixed; one node of the ply
/// between them. The pads are so narrow along the warp that they hold a line of nodes across it.
inline FloorProblem trough_problem(double radius) {
  constexpr double kSpacing = 0.1, kHalfWidth = 0.02;
  RigOptions rig = grid(2, 1, kSpacing, 0);
  rig.fixed = {1, 1};
  FloorProblem problem{
      rig, trough(radius), rectangle_mesh(kSpacing, 2 * kHalfWidth, 0.05, {0}, {0}), {}, {}, {}, {}};
  for (const Eigen::Vector2d& uv : problem.net.rest) {
    problem.mapped.push_back(problem.mold.point(trough_place(radius, uv.x()), uv.y()));
    problem.flat.push_back(uv);
  }
  problem.fixed_place = {-0.5 * kSpacing, 0};
  problem.fibre_strain = 0.002;
  finish(problem, 1.01 * kHalfWidth);
  return problem;
}

/// A part of the article's rig and mold, on the flat net drawn together a little.
inline FloorProblem small_article_problem(double offset = 0.005) {
  RigOptions rig = grid(3, 2, 0.1, offset);
  rig.fixed = {2, 1};
  FloorProblem problem{rig, article_mold(), rectangle_mesh(0.22, 0.12, 0.04), {}, {}, {}, {}};
  const Eigen::Vector2d middle(0.3, 0.3);
  for (const Eigen::Vector2d& uv : problem.net.rest) {
    const Eigen::Vector2d place = middle + 0.93 * uv;
    problem.mapped.push_back(problem.mold.point(place.x(), place.y()));
    problem.flat.emplace_back(middle + uv);
  }
  problem.fixed_place = middle + rig.place(1);
  problem.thickness = 0.0003;
  finish(problem, 0.035);
  return problem;
}

}  // namespace drapeplan
