// The smooth height field nearest to points: penalised least squares of a spline's coefficients.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/surface/spline.hpp"

namespace drapeplan {

/// A point that the surface should meet.
struct FitPoint {
  Eigen::Vector3d place;  ///< [m]
  double area = 1;        ///< of the plane for which it stands [m^2], > 0; twice the area counts twice
};

/// The spline s with the least sum of area * (s - z)^2 over all points, plus length^6 times the integral of
/// the squared third derivatives. Quadratics have none of these, so they are met exactly and go on where
/// points end; waves of 2 pi `smoothing` keep half their height, those three times as long all but a
/// thousandth.
/// @param points  inside `extent`, at least one.
/// @param cells  along x and y, each at least 1; the grid has kSplineMargin more on every side.
/// @param smoothing  the length [m], > 0.
/// @throws std::runtime_error if the equations are singular to round-off or have no finite solution.
/// Source: Eilers, Marx, "Flexible smoothing with B-splines and penalties" (1996); differs: the penalty is
/// the integral of derivatives, as of thin plates, not one of differences.
SplineShape fit_spline(const std::vector<FitPoint>& points, const Extent& extent,
                       const Eigen::Vector2i& cells, double smoothing);

/// Cells beside the extent: the penalty alone decides there, so the surface goes on smoothly.
inline constexpr int kSplineMargin = 2;

}  // namespace drapeplan
