// Surfaces of triangles that several tests use.
#pragma once

#include <functional>

#include "mapping/surface/triangles.hpp"

namespace drapeplan {

using Height = std::function<double(double x, double y)>;

/// Vertices on z = height(x, y) over a grid of nx by ny rectangles, each of two triangles.
inline Triangles triangulated(const Height& height, const Extent& extent, int nx, int ny) {
  Triangles mesh;
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      const Eigen::Array2d share(double(i) / nx, double(j) / ny);
      const Eigen::Vector2d at = extent.lower.array() + share * (extent.upper - extent.lower).array();
      mesh.vertices.emplace_back(at.x(), at.y(), height(at.x(), at.y()));
    }
  }
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      const int a = i * (ny + 1) + j, b = a + ny + 1;
      mesh.corners.push_back({a, b, b + 1});
      mesh.corners.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

/// The surface with walls down to a bottom at `z`: what a block of a tool is.
inline Triangles solid(const Triangles& upper, double z) {
  Triangles mesh = upper;
  const int n = int(upper.vertices.size());
  for (const Eigen::Vector3d& vertex : upper.vertices) mesh.vertices.emplace_back(vertex.x(), vertex.y(), z);
  for (const auto& c : upper.corners) mesh.corners.push_back({c[0] + n, c[2] + n, c[1] + n});
  const Extent box = bounding_box(upper);
  const auto on_rim = [&](int k) {
    const Eigen::Vector2d at = upper.vertices[size_t(k)].head<2>();
    return (at.array() == box.lower.array()).any() || (at.array() == box.upper.array()).any();
  };
  for (const auto& c : upper.corners) {
    for (size_t k = 0; k < 3; ++k) {
      const int a = c[k], b = c[(k + 1) % 3];
      if (!on_rim(a) || !on_rim(b)) continue;
      mesh.corners.push_back({a, a + n, b + n});
      mesh.corners.push_back({a, b + n, b});
    }
  }
  return mesh;
}

}  // namespace drapeplan
