#include "mapping/surface/fit.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace drapeplan {
namespace {

constexpr int kOrder = 4;              // coefficients that reach a cell, along one side
constexpr int kReach = kOrder - 1;     // of a coefficient's neighbours
constexpr int kBand = 2 * kReach + 1;  // neighbours along one side, itself included

// Values of the four B-splines at u of a cell, or of their derivatives with respect to u.
std::array<double, kOrder> splines(double u, int derivative) {
  switch (derivative) {
    case 0:
      return {(1 - u) * (1 - u) * (1 - u) / 6, (4 - 6 * u * u + 3 * u * u * u) / 6,
              (1 + 3 * u + 3 * u * u - 3 * u * u * u) / 6, u * u * u / 6};
    case 1:
      return {-(1 - u) * (1 - u) / 2, (-4 * u + 3 * u * u) / 2, (1 + 2 * u - 3 * u * u) / 2, u * u / 2};
    case 2:
      return {1 - u, -2 + 3 * u, 1 - 3 * u, u};
    default:
      return {-1, 3, -3, 1};
  }
}

// One side of the grid: for each coefficient and neighbour, the integral of the product of their derivatives.
Eigen::MatrixXd products(int cells, double spacing, int derivative) {
  // Gauss's rule of four points is exact for the products, of degree six at most.
  constexpr std::array<double, 4> kPlaces{-0.861136311594052575, -0.339981043584856265, 0.339981043584856265,
                                          0.861136311594052575};
  constexpr std::array<double, 4> kWeights{0.347854845137453857, 0.652145154862546143, 0.652145154862546143,
                                           0.347854845137453857};
  Eigen::Matrix4d cell = Eigen::Matrix4d::Zero();
  for (size_t k = 0; k < kPlaces.size(); ++k) {
    const std::array<double, kOrder> values = splines(0.5 * (1 + kPlaces[k]), derivative);
    const Eigen::Map<const Eigen::Vector4d> b(values.data());
    cell += 0.5 * kWeights[k] * b * b.transpose();
  }
  cell *= spacing / std::pow(spacing, 2 * derivative);
  Eigen::MatrixXd band = Eigen::MatrixXd::Zero(cells + kReach, kBand);
  for (int c = 0; c < cells; ++c) {
    for (int a = 0; a < kOrder; ++a) {
      for (int b = 0; b < kOrder; ++b) band(c + a, b - a + kReach) += cell(a, b);
    }
  }
  return band;
}

// The normal equations, as the lower half of a symmetric matrix: of each coefficient its neighbours in the
// grid.
class NormalEquations {
 public:
  NormalEquations(const SplineShape& grid)
      : grid_(grid),
        rows_(int(grid.coefficients.rows())),
        columns_(int(grid.coefficients.cols())),
        band_(Eigen::MatrixXd::Zero(kBand * kBand, rows_ * columns_)),
        right_(Eigen::VectorXd::Zero(rows_ * columns_)) {}

  void add(const FitPoint& point) {
    const Eigen::Array2d at = (point.place.head<2>() - grid_.origin).array() / grid_.spacing.array();
    const int i = std::clamp(int(at.x()), 0, rows_ - kOrder),
              j = std::clamp(int(at.y()), 0, columns_ - kOrder);
    const std::array<double, kOrder> bx = splines(at.x() - i, 0), by = splines(at.y() - j, 0);
    for (int a = 0; a < kOrder; ++a) {
      for (int b = 0; b < kOrder; ++b) {
        const int unknown = (i + a) * columns_ + j + b;
        const double weight = point.area * bx[size_t(a)] * by[size_t(b)];
        right_[unknown] += weight * point.place.z();
        for (int c = 0; c < kOrder; ++c) {
          for (int d = 0; d < kOrder; ++d)
            band_((c - a + kReach) * kBand + d - b + kReach, unknown) +=
                weight * bx[size_t(c)] * by[size_t(d)];
        }
      }
    }
  }

  /// length^6 times the integral of (s_xxx^2 + 3 s_xxy^2 + 3 s_xyy^2 + s_yyy^2), the same in every direction.
  void add_penalty(double length) {
    constexpr std::array<double, kOrder> kBinomial{1, 3, 3, 1};
    const double factor = std::pow(length, 6);
    for (int order = 0; order < kOrder; ++order) {
      const Eigen::MatrixXd x = products(rows_ - kReach, grid_.spacing.x(), order);
      const Eigen::MatrixXd y = products(columns_ - kReach, grid_.spacing.y(), kReach - order);
      for (int i = 0; i < rows_; ++i) {
        for (int j = 0; j < columns_; ++j) {
          for (int k = 0; k < kBand * kBand; ++k)
            band_(k, i * columns_ + j) +=
                factor * kBinomial[size_t(order)] * x(i, k / kBand) * y(j, k % kBand);
        }
      }
    }
  }

  [[nodiscard]] Eigen::MatrixXd solve() const {
    Eigen::SparseMatrix<double> matrix(rows_ * columns_, rows_ * columns_);
    matrix.reserve(Eigen::VectorXi::Constant(rows_ * columns_, kBand * kBand / 2 + 1));
    for (int unknown = 0; unknown < rows_ * columns_; ++unknown) {
      const int i = unknown / columns_, j = unknown % columns_;
      for (int k = kBand * kBand / 2; k < kBand * kBand; ++k) {
        const int ni = i + k / kBand - kReach, nj = j + k % kBand - kReach;
        if (ni >= 0 && ni < rows_ && nj >= 0 && nj < columns_)
          matrix.insert(ni * columns_ + nj, unknown) = band_(k, unknown);
      }
    }
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors(matrix);
    if (factors.info() != Eigen::Success)
      throw std::runtime_error("mold: the equations of its surface are singular");
    const Eigen::VectorXd solution = factors.solve(right_);
    if (!solution.allFinite())
      throw std::runtime_error("mold: the equations of its surface have no finite solution");
    return solution.reshaped<Eigen::RowMajor>(rows_, columns_);
  }

 private:
  const SplineShape& grid_;
  int rows_, columns_;
  Eigen::MatrixXd band_;  ///< a column for each unknown: products with its neighbours, those along y fastest
  Eigen::VectorXd right_;
};

}  // namespace

SplineShape fit_spline(const std::vector<FitPoint>& points, const Extent& extent,
                       const Eigen::Vector2i& cells, double smoothing) {
  SplineShape spline;
  spline.spacing = (extent.upper - extent.lower).cwiseQuotient(cells.cast<double>());
  spline.origin = extent.lower - kSplineMargin * spline.spacing;
  const Eigen::Vector2i all = cells.array() + 2 * kSplineMargin;
  spline.coefficients = Eigen::MatrixXd::Zero(all.x() + kReach, all.y() + kReach);
  NormalEquations equations(spline);
  for (const FitPoint& point : points) equations.add(point);
  equations.add_penalty(smoothing);
  spline.coefficients = equations.solve();
  return spline;
}

}  // namespace drapeplan
