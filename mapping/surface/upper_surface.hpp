// From triangles to a mold: the surface that is seen from above, checked and fitted by a smooth height field.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapping/surface/spline.hpp"
#include "mapping/surface/triangles.hpp"

namespace drapeplan {

/// How far a fitted surface is from what it was fitted to, along its normal.
struct Deviation {
  double largest = 0, rms = 0;  ///< [m]
  Eigen::Vector2d at{0, 0};     ///< where it is largest [m]
  int places = 0;               ///< that were compared
};

struct UpperSurface {
  SplineShape spline;  ///< only meaningful without faults
  Extent extent;       ///< as asked for, or all that the triangles cover
  /// Vertices lie on the surface that was triangulated: what the fit misses there is its error. Facets,
  /// looked at in their middles and at places half a spacing of vertices apart, lie off it by their height of
  /// arc.
  Deviation vertices, facets;
  std::vector<std::string> faults;  ///< why the triangles are no mold, each with its place in x and y
  std::vector<std::string>
      warnings;  ///< what the smooth surface misses, where it is more than drapes forgive
};

/// Fits the surface of `triangles` that is seen from above. It must cover the extent without holes, lie once
/// above the ground (or twice everywhere: a solid, whose upper surface counts), and have no walls.
///
/// Vertices have full weight. In cells with vertices in or beside them facets count a ten-thousandth; in all
/// others, inside long triangles, they count fully. The grid begins with cells of two spacings of vertices.
/// Cells are halved while that halves what the fit misses: of vertices until these are met within 1 um, or
/// within a twentieth of what the facets are off; of facets, where some are longer than cells.
/// @param triangles  any number, also none.
/// @throws std::runtime_error where sizes are so extreme that the fit has no finite solution.
/// @param wanted  part of the plane that the mold covers [m]; absent: the bounding box.
UpperSurface upper_surface(const Triangles& triangles, const std::optional<Extent>& wanted);

}  // namespace drapeplan
