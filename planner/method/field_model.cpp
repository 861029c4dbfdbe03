#include "planner/method/field_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/base/parallel.hpp"

namespace drapeplan {
namespace {

/// Principal components are kept until this share of the variance is, and no more than so many: what is left
/// is folds that come and go.
constexpr double kKeptVariance = 0.999;
constexpr Eigen::Index kMostComponents = 80;

}  // namespace

FieldModel::FieldModel(const std::vector<const Observation*>& observations, const Eigen::VectorXd& scale,
                       int level, const Kernel* kernel, int threads)
    : level_(level) {
  const auto n = Eigen::Index(observations.size());
  places_.resize(observations.front()->place.size(), n);
  fields_.resize(scale.size(), n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Observation& one = *observations[size_t(k)];
    places_.col(k) = one.place;
    fields_.col(k) = one.fields;
    levels_.push_back(one.level);
    several_levels_ = several_levels_ || one.level != observations.front()->level;
  }
  mean_place_ = places_.rowwise().mean();
  places_.colwise() -= mean_place_;
  reduce(fields_.array().colwise() / scale.array());
  basis_ = scale.asDiagonal() * basis_;
  mean_ = scale.cwiseProduct(mean_);
  const double squares = places_.squaredNorm() / double(n);
  place_square_ = squares > 0 ? squares : 1;
  std::vector<double> distances;
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) distances.push_back((places_.col(a) - places_.col(b)).squaredNorm());
  }
  const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  if (*middle > 0) typical_distance2_ = *middle;
  if (kernel != nullptr) {
    kernel_ = *kernel;
  } else {
    choose_kernel(threads);
  }
  inverse_ = inverse_covariance(kernel_);
  weights_ = inverse_ * components_;
  missed_ = missed_by(inverse_);
}

/// Principal components by the eigenvectors of the products of observations, which are fewer than fields.
void FieldModel::reduce(const Eigen::MatrixXd& fields) {
  mean_ = fields.rowwise().mean();
  const Eigen::MatrixXd centred = fields.colwise() - mean_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(centred.transpose() * centred);
  const Eigen::VectorXd squares = solver.eigenvalues().reverse().cwiseMax(0);
  const Eigen::MatrixXd vectors = solver.eigenvectors().rowwise().reverse();
  const double whole = squares.sum();
  Eigen::Index count = 0;
  for (double kept = 0;
       count < std::min(squares.size() - 1, kMostComponents) && kept < kKeptVariance * whole;)
    kept += squares[count++];
  count = std::max<Eigen::Index>(count, 1);
  basis_ = centred * vectors.leftCols(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    if (squares[k] > 0) basis_.col(k) /= std::sqrt(squares[k]);
  }
  components_ = centred.transpose() * basis_;
  const double variance = components_.squaredNorm() / double(fields.cols());
  variance_ = variance > 0 ? variance : 1;
}

Eigen::MatrixXd FieldModel::inverse_covariance(const Kernel& kernel) const {
  const Eigen::Index n = places_.cols();
  const Eigen::MatrixXd products = places_.transpose() * places_;
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      const double distance2 = products(a, a) + products(b, b) - 2 * products(a, b);
      const double near = std::exp(-0.5 * distance2 / (kernel.length * kernel.length * typical_distance2_));
      const bool same = levels_[size_t(a)] == levels_[size_t(b)];
      k(a, b) = (kernel.linear * products(a, b) / place_square_ + (1 - kernel.linear) * near) *
                    (same ? 1 : kernel.shared) +
                (same && several_levels_ ? 1 : 0);
    }
    k(a, a) += kernel.noise;
  }
  return k.llt().solve(Eigen::MatrixXd::Identity(n, n));
}

double FieldModel::missed_by(const Eigen::MatrixXd& inverse) const {
  const Eigen::Index n = places_.cols();
  const Eigen::MatrixXd weights = inverse * components_;
  double sum = 0, count = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    if (levels_[size_t(k)] != level_) continue;
    sum += weights.row(k).squaredNorm() / (inverse(k, k) * inverse(k, k));
    ++count;
  }
  return count > 0 ? sum / (count * variance_) : std::numeric_limits<double>::infinity();
}

void FieldModel::choose_kernel(int threads) {
  std::vector<Kernel> grid;
  for (const double linear : {0.2, 0.6, 0.95}) {
    for (const double length : {0.7, 1.4, 2.8}) {
      for (const double noise : {0.003, 0.02, 0.1, 0.3}) {
        for (const double shared : {0.8, 0.98}) {
          if (several_levels_ || shared == 0.98) grid.push_back({linear, length, noise, shared});
        }
      }
    }
  }
  std::vector<double> missed(grid.size());
  parallel_for(
      int(grid.size()), [&](int k) { missed[size_t(k)] = missed_by(inverse_covariance(grid[size_t(k)])); },
      threads);
  kernel_ = grid[size_t(std::min_element(missed.begin(), missed.end()) - missed.begin())];
}

FieldModel::Prediction FieldModel::predict(const Eigen::VectorXd& place) const {
  const Eigen::VectorXd own = place - mean_place_;
  Eigen::VectorXd k = kernel_.linear / place_square_ * (places_.transpose() * own);
  const double width2 = kernel_.length * kernel_.length * typical_distance2_;
  for (Eigen::Index a = 0; a < k.size(); ++a) {
    k[a] += (1 - kernel_.linear) * std::exp(-0.5 * (places_.col(a) - own).squaredNorm() / width2);
    const bool same = levels_[size_t(a)] == level_;
    if (several_levels_) k[a] = same ? k[a] + 1 : kernel_.shared * k[a];
  }
  const double prior = kernel_.linear * own.squaredNorm() / place_square_ + (1 - kernel_.linear) +
                       kernel_.noise + (several_levels_ ? 1 : 0);
  const double variance = prior - k.dot(inverse_.selfadjointView<Eigen::Lower>() * k);
  return {mean_ + basis_ * (weights_.transpose() * k), std::sqrt(std::max(variance, 0.0))};
}

FieldModel::Miss FieldModel::left_out(Eigen::Index observation) const {
  const double precision = inverse_(observation, observation);
  const Eigen::VectorXd components =
      components_.row(observation).transpose() - weights_.row(observation).transpose() / precision;
  return {fields_.col(observation) - mean_ - basis_ * components, std::sqrt(1 / precision)};
}

}  // namespace drapeplan
