// CMA-ES: a search for many variables and noisy, non-smooth objectives that evaluates whole generations at
// once.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "planner/method/method.hpp"

namespace drapeplan {

struct CmaEsOptions {
  double sigma0 = 0.05;  ///< first step, in units of the box's edge
  int population = 0;    ///< candidates per generation; 0: 4 + floor(3 ln n)
  std::uint64_t seed = 1;
};

/// Covariance matrix adaptation with cumulative step-size control, (mu/mu_w, lambda), positive weights, over
/// the box [0, 1]^n. The caller evaluates: `ask` gives a generation, `tell` takes its values. Source: N.
/// Hansen, "The CMA Evolution Strategy: A Tutorial" (2016), eqs. 5, 24-48 and table 1. Deviations: the search
/// distribution lives in all of R^n and is folded into the box by reflection at its faces, so an optimum on a
/// face needs no penalty; values that are not finite are failures: they take no part in the recombination,
/// and a generation of failures only halves sigma. Deterministic: own Box-Muller normal numbers from
/// mt19937_64, ties in rank broken by index.
class CmaEs : public Method {
 public:
  /// @param x0  start, n values in [0, 1]; throws std::invalid_argument if empty or not finite, or sigma0 <=
  /// 0.
  CmaEs(const Eigen::VectorXd& x0, const CmaEsOptions& options);

  /// The next generation: n by population, every column in the box. Asking twice without telling draws anew.
  const Eigen::MatrixXd& ask() override;
  /// Values of the last generation, in its order; lower is better.
  void tell(const Eigen::VectorXd& values) override;

  [[nodiscard]] int dimension() const { return int(mean_.size()); }
  [[nodiscard]] int population() const { return population_; }
  [[nodiscard]] Eigen::VectorXd mean() const;  ///< folded into the box
  [[nodiscard]] double sigma() const { return sigma_; }
  /// Why there is no point in going on; empty if there is.
  [[nodiscard]] std::string stop_reason() const override;

 private:
  void recombine(const std::vector<int>& selected);
  void adapt(const std::vector<int>& selected, const Eigen::VectorXd& old_mean);
  void decompose();

  int population_ = 0, parents_ = 0, generation_ = 0;
  Eigen::VectorXd weights_;  ///< of the parents; sum is 1
  double mu_eff_ = 0, c_sigma_ = 0, d_sigma_ = 0, c_c_ = 0, c_1_ = 0, c_mu_ = 0, chi_n_ = 0;

  Eigen::VectorXd mean_, path_sigma_, path_c_;
  double sigma_ = 0;
  Eigen::MatrixXd covariance_, basis_;  ///< covariance = basis diag(axes)^2 basis^T
  Eigen::VectorXd axes_;
  Eigen::MatrixXd unfolded_, folded_;  ///< the last generation
  std::mt19937_64 bits_;
};

}  // namespace drapeplan
