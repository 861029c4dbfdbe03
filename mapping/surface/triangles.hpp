// A surface of triangles, and what a vertical line through it hits.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mapping/surface/height_field.hpp"

namespace drapeplan {

struct Triangles {
  std::vector<Eigen::Vector3d> vertices;    ///< [m]
  std::vector<std::array<int, 3>> corners;  ///< indices of vertices, in any sense of rotation
};

/// The part of the plane that `triangles` cover at most; @param triangles  at least one vertex.
Extent bounding_box(const Triangles& triangles);

/// Vertical lines through a surface of triangles: a regular grid in plan knows which triangles lie where.
class VerticalLines {
 public:
  /// @param triangles  finite, valid as long as this is used; triangles that are vertical are hit by no line.
  explicit VerticalLines(const Triangles& triangles);

  /// Heights at which the vertical line through (x, y) meets the surface [m], highest first; empty where
  /// there is none. Heights that differ by less than `merged` count once: neighbours that share an edge,
  /// patches that lap.
  [[nodiscard]] std::vector<double> heights(double x, double y, double merged) const;
  /// The highest of them, or NaN.
  [[nodiscard]] double top(double x, double y) const;

 private:
  [[nodiscard]] int column(double x) const;
  [[nodiscard]] int row(double y) const;
  template <class Visit>
  void for_each_hit(double x, double y, const Visit& visit) const;

  const Triangles& triangles_;
  Extent box_;
  Eigen::Vector2d per_metre_{0, 0};  ///< bins per length [1/m]
  int columns_ = 1, rows_ = 1;
  std::vector<int> first_;  ///< of each bin in `members_`, and the end
  std::vector<int> members_;
};

}  // namespace drapeplan
