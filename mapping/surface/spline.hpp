// A smooth height field over a regular grid: a bicubic B-spline, twice continuously differentiable.
#pragma once

#include <Eigen/Core>

#include "mapping/surface/height_field.hpp"

namespace drapeplan {

/// z = sum of coefficient (i, j) * B_i(x) B_j(y) with uniform cubic B-splines. Cell (i, j) has the
/// coefficients i..i+3, j..j+3; beyond the grid the polynomials of the outermost cells go on.
struct SplineShape {
  Eigen::Vector2d origin{0, 0};   ///< lower corner of the first cell [m]
  Eigen::Vector2d spacing{1, 1};  ///< sizes of a cell [m]
  Eigen::MatrixXd coefficients;   ///< (cells along x + 3) by (cells along y + 3) [m]
};

/// Why `shape` is no spline, in words; empty if it is one.
const char* spline_fault(const SplineShape& shape);

/// The spline made ready to be evaluated: the polynomial of every cell in powers of the place in it. With
/// these 16 numbers side by side a point costs about as much as one of a polynomial of degree five.
class SplinePatches {
 public:
  SplinePatches() = default;
  /// @param shape  without fault.
  explicit SplinePatches(const SplineShape& shape);

  /// Height and derivatives at (x, y) [m]; the third derivatives jump between cells.
  [[nodiscard]] Jet jet(double x, double y) const;

  /// Heights and slopes at n points [m]; no allocation, vectorised. Results must not alias the inputs.
  void heights(int n, const double* x, const double* y, double* z, double* zx, double* zy) const;

 private:
  void block(int n, const double* x, const double* y, double* z, double* zx, double* zy) const;

  Eigen::Vector2d origin_{0, 0};
  Eigen::Vector2d per_metre_{1, 1};  ///< cells per length [1/m]
  Eigen::Vector2d last_{0, 0};       ///< index of the last cell
  Eigen::MatrixXd powers_;           ///< a column a cell, y fastest: [power of x][power of y], 4 by 4 [m]
};

}  // namespace drapeplan
