#include "planner/method/cmaes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "planner/method/normal.hpp"

namespace drapeplan {
namespace {

/// The search has converged when the largest spread falls below it, in units of the box's edge.
constexpr double kSmallestSigma = 1e-9;

/// Reflection at the faces of [0, 1], repeated: a triangle wave of period 2.
double fold(double x) {
  const double within = x - 2 * std::floor(0.5 * x);
  return std::clamp(within > 1 ? 2 - within : within, 0.0, 1.0);
}

}  // namespace

CmaEs::CmaEs(const Eigen::VectorXd& x0, const CmaEsOptions& options)
    : mean_(x0), sigma_(options.sigma0), bits_(options.seed) {
  if (x0.size() == 0 || !x0.allFinite())
    throw std::invalid_argument("CmaEs: the start is empty or not finite");
  if (!(options.sigma0 > 0)) throw std::invalid_argument("CmaEs: sigma0 must be positive");
  const double n = double(x0.size());
  population_ =
      options.population > 0 ? std::max(options.population, 2) : 4 + int(std::floor(3 * std::log(n)));
  parents_ = population_ / 2;
  weights_.resize(parents_);
  for (int i = 0; i < parents_; ++i) weights_[i] = std::log(0.5 * (population_ + 1)) - std::log(i + 1.0);
  weights_ /= weights_.sum();
  mu_eff_ = 1 / weights_.squaredNorm();
  c_sigma_ = (mu_eff_ + 2) / (n + mu_eff_ + 5);
  d_sigma_ = 1 + 2 * std::max(0.0, std::sqrt((mu_eff_ - 1) / (n + 1)) - 1) + c_sigma_;
  c_c_ = (4 + mu_eff_ / n) / (n + 4 + 2 * mu_eff_ / n);
  c_1_ = 2 / ((n + 1.3) * (n + 1.3) + mu_eff_);
  c_mu_ = std::min(1 - c_1_, 2 * (mu_eff_ - 2 + 1 / mu_eff_) / ((n + 2) * (n + 2) + mu_eff_));
  chi_n_ = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  path_sigma_ = path_c_ = Eigen::VectorXd::Zero(x0.size());
  covariance_ = basis_ = Eigen::MatrixXd::Identity(x0.size(), x0.size());
  axes_ = Eigen::VectorXd::Ones(x0.size());
}

const Eigen::MatrixXd& CmaEs::ask() {
  unfolded_.resize(dimension(), population_);
  for (int k = 0; k < population_; ++k) {
    Eigen::VectorXd z(dimension());
    for (int i = 0; i < dimension(); ++i) z[i] = axes_[i] * standard_normal(bits_);
    unfolded_.col(k) = mean_ + sigma_ * (basis_ * z);
  }
  folded_ = unfolded_.unaryExpr([](double x) { return fold(x); });
  return folded_;
}

void CmaEs::tell(const Eigen::VectorXd& values) {
  if (values.size() != population_ || folded_.cols() != population_) {
    throw std::invalid_argument("CmaEs::tell: one value per candidate of the last generation is needed");
  }
  std::vector<int> order;
  for (int k = 0; k < population_; ++k) {
    if (std::isfinite(values[k])) order.push_back(k);
  }
  if (order.empty()) {
    sigma_ *= 0.5;
    return;
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return values[a] < values[b]; });
  order.resize(std::min(order.size(), size_t(parents_)));
  const Eigen::VectorXd old_mean = mean_;
  recombine(order);
  adapt(order, old_mean);
  decompose();
}

/// The new mean: weighted mean of the best, weights renewed where failures left fewer than mu.
void CmaEs::recombine(const std::vector<int>& selected) {
  const auto count = Eigen::Index(selected.size());
  const Eigen::VectorXd w = weights_.head(count) / weights_.head(count).sum();
  mean_.setZero();
  for (Eigen::Index i = 0; i < count; ++i) mean_ += w[i] * unfolded_.col(selected[size_t(i)]);
}

void CmaEs::adapt(const std::vector<int>& selected, const Eigen::VectorXd& old_mean) {
  const double n = dimension();
  const auto count = Eigen::Index(selected.size());
  const Eigen::VectorXd w = weights_.head(count) / weights_.head(count).sum();
  const double mu_eff = 1 / w.squaredNorm();
  const Eigen::VectorXd step = (mean_ - old_mean) / sigma_;
  const Eigen::VectorXd whitened = basis_ * (basis_.transpose() * step).cwiseQuotient(axes_);
  ++generation_;
  path_sigma_ = (1 - c_sigma_) * path_sigma_ + std::sqrt(c_sigma_ * (2 - c_sigma_) * mu_eff) * whitened;
  const double length = path_sigma_.norm() / std::sqrt(1 - std::pow(1 - c_sigma_, 2 * generation_));
  const double h_sigma =
      length < (1.4 + 2 / (n + 1)) * chi_n_ ? 1 : 0;  // stalls the rank-one path at large steps
  path_c_ = (1 - c_c_) * path_c_ + h_sigma * std::sqrt(c_c_ * (2 - c_c_) * mu_eff) * step;
  const double kept = 1 - c_1_ - c_mu_ + (1 - h_sigma) * c_1_ * c_c_ * (2 - c_c_);
  covariance_ = kept * covariance_ + c_1_ * path_c_ * path_c_.transpose();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd y = (unfolded_.col(selected[size_t(i)]) - old_mean) / sigma_;
    covariance_ += c_mu_ * w[i] * y * y.transpose();
  }
  constexpr double kLargestSigma =
      1;  // the whole box: reflection makes a wider step no different from a guess
  sigma_ *= std::exp(std::min(1.0, c_sigma_ / d_sigma_ * (path_sigma_.norm() / chi_n_ - 1)));
  sigma_ = std::min(sigma_, kLargestSigma);
}

void CmaEs::decompose() {
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance_);
  constexpr double kSmallestRatio = 1e-14;  // of the largest eigenvalue: keeps every axis searched
  const double smallest = kSmallestRatio * solver.eigenvalues().maxCoeff();
  basis_ = solver.eigenvectors();
  axes_ = solver.eigenvalues().cwiseMax(smallest).cwiseSqrt();
}

Eigen::VectorXd CmaEs::mean() const {
  return mean_.unaryExpr([](double x) { return fold(x); });
}

std::string CmaEs::stop_reason() const {
  if (!mean_.allFinite() || !axes_.allFinite()) return "the search distribution is not finite";
  if (!(sigma_ * axes_.maxCoeff() > kSmallestSigma))
    return "converged: the search distribution has shrunk to a point";
  return {};
}

}  // namespace drapeplan
