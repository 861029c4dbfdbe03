// Molds that several tests use.
#pragma once

#include <cmath>
#include <limits>

#include "mapping/article_mold.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

inline Mold inclined_plane(double angle) {
  return Mold(PlaneShape{angle}, {{-0.5, -0.5}, {0.5, 0.5}});
}

inline Mold sphere(const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(radius / 2);
  return Mold(SphereShape{centre, radius}, {centre.head<2>() - half, centre.head<2>() + half});
}

inline Mold cylinder(const Eigen::Vector3d& centre, double azimuth, double radius) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(radius / 2);
  return Mold(CylinderShape{centre, azimuth, radius}, {centre.head<2>() - half, centre.head<2>() + half});
}

/// A spline with coefficients on the article's mold and ripples of 1 mm: smooth, and no polynomial.
inline Mold spline_mold() {
  const Mold like = article_mold();
  SplineShape shape{{-0.05, -0.03}, {0.0337, 0.0279}, Eigen::MatrixXd(20, 23)};
  for (int i = 0; i < shape.coefficients.rows(); ++i) {
    for (int j = 0; j < shape.coefficients.cols(); ++j) {
      const Eigen::Vector2d at = shape.origin + shape.spacing.cwiseProduct(Eigen::Vector2d(i - 1, j - 1));
      shape.coefficients(i, j) =
          like.height(at.x(), at.y()) + 1e-3 * std::sin(30 * at.x()) * std::cos(25 * at.y());
    }
  }
  return Mold(shape, {{0, 0}, {0.45, 0.45}});
}

/// Smallest and largest Gaussian curvature on a grid over the extent [1/m^2].
struct CurvatureRange {
  double smallest = std::numeric_limits<double>::quiet_NaN(), largest = smallest;
};
inline CurvatureRange gaussian_curvature_range(const Mold& mold) {
  constexpr int kPlaces = 201;  // per side
  CurvatureRange range;         // fmin and fmax skip places where the mold is not defined
  const Extent& extent = mold.extent();
  const Eigen::Vector2d step = (extent.upper - extent.lower) / (kPlaces - 1);
  for (int j = 0; j < kPlaces; ++j) {
    for (int i = 0; i < kPlaces; ++i) {
      const Eigen::Vector2d at = extent.lower + step.cwiseProduct(Eigen::Vector2d(i, j));
      const double curvature = mold.gaussian_curvature(at.x(), at.y());
      range.smallest = std::fmin(range.smallest, curvature);
      range.largest = std::fmax(range.largest, curvature);
    }
  }
  return range;
}

}  // namespace drapeplan
