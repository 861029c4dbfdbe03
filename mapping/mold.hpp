// The rigid mold: a height field z = f(x, y) with its derivatives, normals, curvature and closest points.
#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "mapping/surface/height_field.hpp"
#include "mapping/surface/spline.hpp"

namespace drapeplan {

/// z = sum of coefficient * x^i * y^j; a coefficient has the unit m^(1-i-j). [Krogh], Eq. (1).
struct PolynomialShape {
  struct Term {
    int i = 0, j = 0;
    double coefficient = 0;
  };
  std::vector<Term> terms;
};

/// Plane through the origin that falls by `angle` [rad] in the direction of +x.
struct PlaneShape {
  double angle = 0;
};

/// Upper half of a sphere; beyond its equator the mold is not defined (queries return NaN heights).
struct SphereShape {
  Eigen::Vector3d centre{0, 0, 0};  ///< [m]
  double radius = 1;                ///< [m]
};

/// Upper half of a circular cylinder whose horizontal axis passes `centre` at `azimuth` [rad] from +x.
struct CylinderShape {
  Eigen::Vector3d centre{0, 0, 0};  ///< [m]
  double azimuth = 0;               ///< [rad]
  double radius = 1;                ///< [m]
};

/// Foot of the perpendicular from a point onto the mold.
struct ClosestPoint {
  Eigen::Vector3d foot;        ///< on the mold [m]
  Eigen::Vector3d normal;      ///< unit, upwards (normal.z() > 0)
  double signed_distance = 0;  ///< > 0 above the mold [m]
  bool converged = false;      ///< Newton's method met its tolerance
};

/// A mold is a value: copy it, share it const between threads.
class Mold {
 public:
  using Shape = std::variant<PlaneShape, PolynomialShape, SphereShape, CylinderShape, SplineShape>;

  /// @throws std::invalid_argument for an empty extent, a radius <= 0, |angle| >= pi/2 or a spline with a
  /// fault.
  Mold(Shape shape, Extent extent);

  [[nodiscard]] const Extent& extent() const { return extent_; }
  [[nodiscard]] const Shape& shape() const { return shape_; }

  /// Height and derivatives at (x, y) [m].
  [[nodiscard]] Jet jet(double x, double y) const;
  [[nodiscard]] double height(double x, double y) const;
  /// Unit normal, upwards.
  [[nodiscard]] Eigen::Vector3d normal(double x, double y) const;
  /// Point (x, y, f(x, y)) [m].
  [[nodiscard]] Eigen::Vector3d point(double x, double y) const;
  /// Nearest point of the surface, by Newton's method from the vertical projection, to 1e-13 m.
  [[nodiscard]] ClosestPoint closest(const Eigen::Vector3d& p) const;
  /// Product of the principal curvatures [1/m^2].
  [[nodiscard]] double gaussian_curvature(double x, double y) const;
  /// Normal curvature [1/m] along the tangent whose x-y direction is `direction`; > 0 where the mold is
  /// hollow (a taut fibre would bridge it).
  [[nodiscard]] double normal_curvature(double x, double y, const Eigen::Vector2d& direction) const;

  /// Batch query for inner loops: heights and slopes at n points. No allocation, vectorised.
  /// @param x, y  n coordinates [m];  @param z, zx, zy  n results; must not alias the inputs.
  void heights(int n, const double* x, const double* y, double* z, double* zx, double* zy) const;

 private:
  Shape shape_;
  Extent extent_;
  Eigen::MatrixXd dense_;  ///< polynomial only: coefficient of x^i y^j at (i, j)
  SplinePatches patches_;  ///< spline only
};

}  // namespace drapeplan
