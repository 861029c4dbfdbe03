// Regions of a field above a level, as outlines for a picture.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace drapeplan {

/// A field on triangles in pixel coordinates.
struct Triangles {
  std::vector<Eigen::Vector2d> place;
  std::vector<double> value;
  std::vector<std::array<int, 3>> corners;
};

/// Splits each quadrilateral into parts x parts pieces of two triangles each; places and values are bilinear
/// inside.
Triangles refine(const std::vector<Eigen::Vector2d>& place, const std::vector<double>& value,
                 const std::vector<std::array<int, 4>>& quads, int parts);

/// SVG path data of the region where the field is >= level, filled by the nonzero rule. Edges shared by two
/// triangles cancel, so that only the region's outline is left: no seams between triangles, and a small file.
std::string region_above(const Triangles& triangles, double level);

}  // namespace drapeplan
