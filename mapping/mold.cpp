#include "mapping/mold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Powers above this are typing errors rather than molds; the bound keeps the dense table small.
constexpr int kHighestPower = 16;

// ---------------------------------------------------------------- polynomial

// Horner's scheme carries the Taylor coefficients t[m] = f^(m) / m! along, in y for every row i, then in x.
constexpr int kOrders = 4;  // value and three derivatives

using Taylor = std::array<double, kOrders>;

void horner_step(Taylor& t, double x, double coefficient) {
  for (size_t m = kOrders - 1; m > 0; --m) t[m] = t[m] * x + t[m - 1];
  t[0] = t[0] * x + coefficient;
}

Jet polynomial_jet(const Eigen::MatrixXd& dense, double x, double y) {
  std::array<Taylor, kOrders> t{};  // t[k][m]: coefficient of x^m y^k of the Taylor expansion at (x, y)
  for (Eigen::Index i = dense.rows() - 1; i >= 0; --i) {
    Taylor row{};
    for (Eigen::Index j = dense.cols() - 1; j >= 0; --j) horner_step(row, y, dense(i, j));
    for (size_t k = 0; k < kOrders; ++k) horner_step(t[k], x, row[k]);
  }
  return {.z = t[0][0],
          .zx = t[0][1],
          .zy = t[1][0],
          .zxx = 2 * t[0][2],
          .zxy = t[1][1],
          .zyy = 2 * t[2][0],
          .zxxx = 6 * t[0][3],
          .zxxy = 2 * t[1][2],
          .zxyy = 2 * t[2][1],
          .zyyy = 6 * t[3][0]};
}

// Points are taken in blocks that stay in the first-level cache; the innermost loops run over the points.
constexpr int kBlock = 64;

void polynomial_block(const Eigen::MatrixXd& dense, int n, const double* __restrict x,
                      const double* __restrict y, double* __restrict z, double* __restrict zx,
                      double* __restrict zy) {
  alignas(64) double row[kBlock];
  alignas(64) double row_y[kBlock];
  for (int p = 0; p < n; ++p) z[p] = zx[p] = zy[p] = 0;
  for (Eigen::Index i = dense.rows() - 1; i >= 0; --i) {
    for (int p = 0; p < n; ++p) row[p] = row_y[p] = 0;
    for (Eigen::Index j = dense.cols() - 1; j >= 0; --j) {
      const double c = dense(i, j);
      for (int p = 0; p < n; ++p) {
        row_y[p] = row_y[p] * y[p] + row[p];
        row[p] = row[p] * y[p] + c;
      }
    }
    for (int p = 0; p < n; ++p) {
      zx[p] = zx[p] * x[p] + z[p];
      z[p] = z[p] * x[p] + row[p];
      zy[p] = zy[p] * x[p] + row_y[p];
    }
  }
}

// Molds of industry are of low total degree: for these the degree is known at compile time, so the
// coefficients and all partial sums stay in registers and the loop over points is straight-line code.
template <int Degree>
void low_degree_heights(const Eigen::MatrixXd& dense, int n, const double* __restrict x,
                        const double* __restrict y, double* __restrict z, double* __restrict zx,
                        double* __restrict zy) {
  double c[Degree + 1][Degree + 1] = {};
  for (int i = 0; i <= Degree && i < dense.rows(); ++i) {
    for (int j = 0; i + j <= Degree && j < dense.cols(); ++j) c[i][j] = dense(i, j);
  }
  for (int p = 0; p < n; ++p) {
    double sum = 0, sum_x = 0, sum_y = 0;
#pragma GCC unroll 8
    for (int i = Degree; i >= 0; --i) {
      double row = 0, row_y = 0;
#pragma GCC unroll 8
      for (int j = Degree - i; j >= 0; --j) {
        row_y = row_y * y[p] + row;
        row = row * y[p] + c[i][j];
      }
      sum_x = sum_x * x[p] + sum;
      sum = sum * x[p] + row;
      sum_y = sum_y * x[p] + row_y;
    }
    z[p] = sum;
    zx[p] = sum_x;
    zy[p] = sum_y;
  }
}

int total_degree(const Eigen::MatrixXd& dense) {
  int degree = 0;
  for (int i = 0; i < dense.rows(); ++i) {
    for (int j = 0; j < dense.cols(); ++j) {
      if (dense(i, j) != 0) degree = std::max(degree, i + j);
    }
  }
  return degree;
}

void polynomial_heights(const Eigen::MatrixXd& dense, int n, const double* x, const double* y, double* z,
                        double* zx, double* zy) {
  switch (total_degree(dense)) {
    case 0:
    case 1:
    case 2:
    case 3:
      return low_degree_heights<3>(dense, n, x, y, z, zx, zy);
    case 4:
    case 5:
      return low_degree_heights<5>(dense, n, x, y, z, zx, zy);
    default:
      for (int p = 0; p < n; p += kBlock) {
        polynomial_block(dense, std::min(kBlock, n - p), x + p, y + p, z + p, zx + p, zy + p);
      }
  }
}

Eigen::MatrixXd dense_coefficients(const PolynomialShape& shape) {
  int rows = 1, cols = 1;
  for (const PolynomialShape::Term& term : shape.terms) {
    if (term.i < 0 || term.j < 0 || term.i > kHighestPower || term.j > kHighestPower) {
      throw WrongInput(fmt::format("mold: power of a polynomial term must lie in 0..{}, got x^{} y^{}",
                                   kHighestPower, term.i, term.j));
    }
    rows = std::max(rows, term.i + 1);
    cols = std::max(cols, term.j + 1);
  }
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows, cols);
  for (const PolynomialShape::Term& term : shape.terms) dense(term.i, term.j) += term.coefficient;
  if (!dense.allFinite()) throw WrongInput("mold: a polynomial coefficient is not finite");
  return dense;
}

// ---------------------------------------------------------------- plane, sphere, cylinder

Jet plane_jet(const PlaneShape& shape, double x) {
  const double slope = -std::tan(shape.angle);
  return {.z = slope * x, .zx = slope};
}

// Height over the equator's plane; NaN on and beyond the equator, where the slope is not finite.
double cap_height(double squared_height) {
  return squared_height > 0 ? std::sqrt(squared_height) : kNaN;
}

Jet sphere_jet(const SphereShape& shape, double x, double y) {
  const double a = x - shape.centre.x();
  const double b = y - shape.centre.y();
  const double h = cap_height(shape.radius * shape.radius - a * a - b * b);
  const double h3 = 1 / (h * h * h);
  const double h5 = h3 / (h * h);
  return {.z = shape.centre.z() + h,
          .zx = -a / h,
          .zy = -b / h,
          .zxx = -1 / h - a * a * h3,
          .zxy = -a * b * h3,
          .zyy = -1 / h - b * b * h3,
          .zxxx = -3 * a * h3 - 3 * a * a * a * h5,
          .zxxy = -b * h3 - 3 * a * a * b * h5,
          .zxyy = -a * h3 - 3 * a * b * b * h5,
          .zyyy = -3 * b * h3 - 3 * b * b * b * h5};
}

// Unit vector across a cylinder's axis.
Eigen::Vector2d across(const CylinderShape& shape) {
  return {-std::sin(shape.azimuth), std::cos(shape.azimuth)};
}

Jet cylinder_jet(const CylinderShape& shape, double x, double y) {
  const Eigen::Vector2d n = across(shape);
  const double s = n.x() * (x - shape.centre.x()) + n.y() * (y - shape.centre.y());
  const double squared_radius = shape.radius * shape.radius;
  const double h = cap_height(squared_radius - s * s);
  const double first = -s / h;
  const double second = -squared_radius / (h * h * h);
  const double third = 3 * second * s / (h * h);
  return {.z = shape.centre.z() + h,
          .zx = first * n.x(),
          .zy = first * n.y(),
          .zxx = second * n.x() * n.x(),
          .zxy = second * n.x() * n.y(),
          .zyy = second * n.y() * n.y(),
          .zxxx = third * n.x() * n.x() * n.x(),
          .zxxy = third * n.x() * n.x() * n.y(),
          .zxyy = third * n.x() * n.y() * n.y(),
          .zyyy = third * n.y() * n.y() * n.y()};
}

void plane_heights(const PlaneShape& shape, int n, const double* __restrict x, double* __restrict z,
                   double* __restrict zx, double* __restrict zy) {
  const double slope = -std::tan(shape.angle);
  for (int p = 0; p < n; ++p) {
    z[p] = slope * x[p];
    zx[p] = slope;
    zy[p] = 0;
  }
}

void sphere_heights(const SphereShape& shape, int n, const double* __restrict x, const double* __restrict y,
                    double* __restrict z, double* __restrict zx, double* __restrict zy) {
  const double squared_radius = shape.radius * shape.radius;
  const double cx = shape.centre.x(), cy = shape.centre.y(), cz = shape.centre.z();
  for (int p = 0; p < n; ++p) {
    const double a = x[p] - cx;
    const double b = y[p] - cy;
    const double h = cap_height(squared_radius - a * a - b * b);
    z[p] = cz + h;
    zx[p] = -a / h;
    zy[p] = -b / h;
  }
}

void cylinder_heights(const CylinderShape& shape, int n, const double* __restrict x,
                      const double* __restrict y, double* __restrict z, double* __restrict zx,
                      double* __restrict zy) {
  const Eigen::Vector2d normal = across(shape);
  const double squared_radius = shape.radius * shape.radius;
  const double nx = normal.x(), ny = normal.y();
  const double cx = shape.centre.x(), cy = shape.centre.y(), cz = shape.centre.z();
  for (int p = 0; p < n; ++p) {
    const double s = nx * (x[p] - cx) + ny * (y[p] - cy);
    const double h = cap_height(squared_radius - s * s);
    z[p] = cz + h;
    zx[p] = -s / h * nx;
    zy[p] = -s / h * ny;
  }
}

// ---------------------------------------------------------------- checks

void check_radius(const char* shape, double radius) {
  if (!(radius > 0) || !std::isfinite(radius)) {
    throw WrongInput(fmt::format("mold: radius of the {} must be > 0 m, got {:f}", shape, radius));
  }
}

void check_centre(const char* shape, const Eigen::Vector3d& centre) {
  if (!centre.allFinite()) throw WrongInput(fmt::format("mold: centre of the {} is not finite", shape));
}

void check(const Extent& extent) {
  if (!extent.lower.allFinite() || !extent.upper.allFinite() ||
      !(extent.upper.array() > extent.lower.array()).all()) {
    throw WrongInput("mold: extent is empty");
  }
}

template <class... Ts>
struct Overload : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overload(Ts...) -> Overload<Ts...>;

}  // namespace

Mold::Mold(Shape shape, Extent extent) : shape_(std::move(shape)), extent_(std::move(extent)) {
  check(extent_);
  std::visit(
      Overload{
          [](const PlaneShape& s) {
            if (!(std::abs(s.angle) < std::numbers::pi / 2)) {
              throw WrongInput(fmt::format("mold: |angle| of the plane must be < pi/2, got {:f}", s.angle));
            }
          },
          [this](const PolynomialShape& s) { dense_ = dense_coefficients(s); },
          [](const SphereShape& s) {
            check_centre("sphere", s.centre);
            check_radius("sphere", s.radius);
          },
          [](const CylinderShape& s) {
            check_centre("cylinder", s.centre);
            check_radius("cylinder", s.radius);
            if (!std::isfinite(s.azimuth)) {
              throw WrongInput("mold: azimuth of the cylinder is not finite");
            }
          },
          [this](const SplineShape& s) {
            const std::string fault = spline_fault(s);
            if (!fault.empty()) throw WrongInput("mold: the spline " + fault);
            patches_ = SplinePatches(s);
          },
      },
      shape_);
}

Jet Mold::jet(double x, double y) const {
  return std::visit(Overload{
                        [&](const PlaneShape& s) { return plane_jet(s, x); },
                        [&](const PolynomialShape&) { return polynomial_jet(dense_, x, y); },
                        [&](const SphereShape& s) { return sphere_jet(s, x, y); },
                        [&](const CylinderShape& s) { return cylinder_jet(s, x, y); },
                        [&](const SplineShape&) { return patches_.jet(x, y); },
                    },
                    shape_);
}

void Mold::heights(int n, const double* x, const double* y, double* z, double* zx, double* zy) const {
  std::visit(Overload{
                 [&](const PlaneShape& s) { plane_heights(s, n, x, z, zx, zy); },
                 [&](const PolynomialShape&) { polynomial_heights(dense_, n, x, y, z, zx, zy); },
                 [&](const SphereShape& s) { sphere_heights(s, n, x, y, z, zx, zy); },
                 [&](const CylinderShape& s) { cylinder_heights(s, n, x, y, z, zx, zy); },
                 [&](const SplineShape&) { patches_.heights(n, x, y, z, zx, zy); },
             },
             shape_);
}

double Mold::height(double x, double y) const {
  return jet(x, y).z;
}

Eigen::Vector3d Mold::normal(double x, double y) const {
  const Jet f = jet(x, y);
  return Eigen::Vector3d(-f.zx, -f.zy, 1).normalized();
}

Eigen::Vector3d Mold::point(double x, double y) const {
  return {x, y, height(x, y)};
}

double Mold::gaussian_curvature(double x, double y) const {
  const Jet f = jet(x, y);
  const double squared_area = 1 + f.zx * f.zx + f.zy * f.zy;
  return (f.zxx * f.zyy - f.zxy * f.zxy) / (squared_area * squared_area);
}

double Mold::normal_curvature(double x, double y, const Eigen::Vector2d& direction) const {
  const Jet f = jet(x, y);
  const double a = direction.x(), b = direction.y();
  const double rise = f.zx * a + f.zy * b;
  const double first_form = a * a + b * b + rise * rise;
  const double second_form =
      (f.zxx * a * a + 2 * f.zxy * a * b + f.zyy * b * b) / std::sqrt(1 + f.zx * f.zx + f.zy * f.zy);
  return second_form / first_form;
}

}  // namespace drapeplan
