#include "mapping/surface/spline.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace drapeplan {
namespace {

constexpr int kOrder = 4;  // coefficients of a cubic
constexpr int kPatch = kOrder * kOrder;

// Points are taken in blocks that stay in the first-level cache.
constexpr int kBlock = 64;

// Row a: the coefficient of u^a in a cell, from the four B-spline coefficients that reach it.
Eigen::Matrix4d powers_from_splines() {
  Eigen::Matrix4d m;
  m << 1, 4, 1, 0, -3, 0, 3, 0, 3, -6, 3, 0, -1, 3, -3, 1;
  return m / 6;
}

// The cell that holds the place, or the outermost one; 0 for NaN, which then stays in the place.
double cell_of(double place, double last) {
  return std::min(std::max(0.0, std::floor(place)), last);
}

// Four numbers in one register: vectors of GCC and Clang, of any processor.
typedef double Four
    __attribute__((vector_size(kOrder * sizeof(double))));  // NOLINT: the attribute wants a typedef

inline Four four(double value) {
  return Four{value, value, value, value};
}

inline Four load_four(const double* from) {
  Four loaded;
  std::memcpy(&loaded, from, sizeof loaded);
  return loaded;
}

inline void store_four(const Four& value, double* to) {
  std::memcpy(to, &value, sizeof value);
}

inline void transpose(Four (&rows)[kOrder]) {
  const Four a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
  const Four b = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
  const Four c = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
  const Four d = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  rows[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  rows[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  rows[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  rows[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

}  // namespace

const char* spline_fault(const SplineShape& shape) {
  if (shape.coefficients.rows() < kOrder || shape.coefficients.cols() < kOrder)
    return "has fewer than 4 by 4 coefficients";
  if (!shape.coefficients.allFinite()) return "has a coefficient that is not finite";
  if (!shape.origin.allFinite()) return "has an origin that is not finite";
  if (!shape.spacing.allFinite() || !(shape.spacing.array() > 0).all())
    return "has a spacing that is not > 0 m";
  return "";
}

SplinePatches::SplinePatches(const SplineShape& shape)
    : origin_(shape.origin), per_metre_(shape.spacing.cwiseInverse()) {
  const Eigen::Index nx = shape.coefficients.rows() - kOrder + 1, ny = shape.coefficients.cols() - kOrder + 1;
  last_ = Eigen::Vector2d(double(nx - 1), double(ny - 1));
  powers_.resize(kPatch, nx * ny);
  const Eigen::Matrix4d m = powers_from_splines();
  for (Eigen::Index i = 0; i < nx; ++i) {
    for (Eigen::Index j = 0; j < ny; ++j) {
      const Eigen::Matrix4d patch = m * shape.coefficients.block<kOrder, kOrder>(i, j) * m.transpose();
      for (int a = 0; a < kOrder; ++a) {
        for (int b = 0; b < kOrder; ++b) powers_(a * kOrder + b, i * ny + j) = patch(a, b);
      }
    }
  }
}

Jet SplinePatches::jet(double x, double y) const {
  const double s = (x - origin_.x()) * per_metre_.x(), t = (y - origin_.y()) * per_metre_.y();
  const double i = cell_of(s, last_.x()), j = cell_of(t, last_.y());
  const double u = s - i, v = t - j;
  const double* c = powers_.data() + (size_t(i) * (size_t(last_.y()) + 1) + size_t(j)) * kPatch;
  // Rows k: derivative of order k with respect to u or v of the four powers.
  const double pu[kOrder][kOrder] = {
      {1, u, u * u, u * u * u}, {0, 1, 2 * u, 3 * u * u}, {0, 0, 2, 6 * u}, {0, 0, 0, 6}};
  const double pv[kOrder][kOrder] = {
      {1, v, v * v, v * v * v}, {0, 1, 2 * v, 3 * v * v}, {0, 0, 2, 6 * v}, {0, 0, 0, 6}};
  const auto derivative = [&](int along_x, int along_y) {
    double sum = 0;
    for (int a = 0; a < kOrder; ++a) {
      double row = 0;
      for (int b = 0; b < kOrder; ++b) row += c[a * kOrder + b] * pv[along_y][b];
      sum += row * pu[along_x][a];
    }
    for (int k = 0; k < along_x; ++k) sum *= per_metre_.x();
    for (int k = 0; k < along_y; ++k) sum *= per_metre_.y();
    return sum;
  };
  return {.z = derivative(0, 0),
          .zx = derivative(1, 0),
          .zy = derivative(0, 1),
          .zxx = derivative(2, 0),
          .zxy = derivative(1, 1),
          .zyy = derivative(0, 2),
          .zxxx = derivative(3, 0),
          .zxxy = derivative(2, 1),
          .zxyy = derivative(1, 2),
          .zyyy = derivative(0, 3)};
}

// Three loops: the cells of all points; the polynomial in x of the four powers of y, a point's four numbers
// in one register; then in y, over the points.
void SplinePatches::block(int n, const double* __restrict x, const double* __restrict y, double* __restrict z,
                          double* __restrict zx, double* __restrict zy) const {
  alignas(64) double u[kBlock], v[kBlock];
  alignas(64) int cell[kBlock];
  const double ox = origin_.x(), oy = origin_.y(), px = per_metre_.x(), py = per_metre_.y();
  const double last_x = last_.x(), last_y = last_.y();
  const int columns = int(last_y) + 1;
  for (int p = 0; p < n; ++p) {
    const double s = (x[p] - ox) * px, t = (y[p] - oy) * py;
    const double i = cell_of(s, last_x), j = cell_of(t, last_y);
    u[p] = s - i;
    v[p] = t - j;
    cell[p] = int(i) * columns + int(j);
  }
  for (int p = n; p % kOrder != 0; ++p) u[p] = v[p] = 0, cell[p] = 0;  // n <= kBlock, a multiple of four
  alignas(64) double sums[3][kBlock];
  for (int p = 0; p < n; p += kOrder) {
    Four row[kOrder], slope[kOrder];
    for (int k = 0; k < kOrder; ++k) {
      const double* const c = powers_.data() + size_t(cell[p + k]) * kPatch;
      const Four at = four(u[p + k]);
      Four value = load_four(c + 3 * kOrder), rise = value;
      value = value * at + load_four(c + 2 * kOrder);
      rise = rise * at + value;
      value = value * at + load_four(c + kOrder);
      rise = rise * at + value;
      row[k] = value * at + load_four(c);
      slope[k] = rise;
    }
    transpose(row);
    transpose(slope);
    const Four at = load_four(v + p);
    store_four(((row[3] * at + row[2]) * at + row[1]) * at + row[0], sums[0] + p);
    store_four((((slope[3] * at + slope[2]) * at + slope[1]) * at + slope[0]) * px, sums[1] + p);
    store_four(((3 * row[3] * at + 2 * row[2]) * at + row[1]) * py, sums[2] + p);
  }
  std::copy_n(sums[0], n, z);
  std::copy_n(sums[1], n, zx);
  std::copy_n(sums[2], n, zy);
}

void SplinePatches::heights(int n, const double* x, const double* y, double* z, double* zx,
                            double* zy) const {
  for (int p = 0; p < n; p += kBlock) block(std::min(kBlock, n - p), x + p, y + p, z + p, zx + p, zy + p);
}

}  // namespace drapeplan
