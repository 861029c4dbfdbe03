#include "planner/method/restarts.hpp"

#include <algorithm>

namespace drapeplan {
namespace {

/// First step after a restart, in units of the box's edge.
constexpr double kRestartSigma = 0.2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

RestartedCmaEs::RestartedCmaEs(const Eigen::VectorXd& x0, const CmaEsOptions& options)
    : options_(options), best_(x0) {
  search_.emplace(x0, options_);
  options_.population = search_->population();
}

const Eigen::MatrixXd& RestartedCmaEs::ask() {
  const double patience = 10 + 30.0 * search_->dimension() / search_->population();
  if (!search_->stop_reason().empty() || without_gain_ > patience) {
    ++restarts_;
    options_.population *= 2;
    options_.sigma0 = kRestartSigma;
    ++options_.seed;
    search_.emplace(best_, options_);
    best_here_ = kInfinity;
    without_gain_ = 0;
  }
  return search_->ask();
}

void RestartedCmaEs::tell(const Eigen::VectorXd& values) {
  const Eigen::MatrixXd& x = search_->generation_points();
  double lowest = kInfinity;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (!(values[k] < lowest)) continue;
    lowest = values[k];
    if (lowest < best_value_) {
      best_value_ = lowest;
      best_ = x.col(k);
    }
  }
  without_gain_ = lowest < best_here_ ? 0 : without_gain_ + 1;
  best_here_ = std::min(best_here_, lowest);
  search_->tell(values);
  ++generations_;
}

void RestartedCmaEs::forget_values() {
  best_value_ = best_here_ = kInfinity;
  without_gain_ = 0;
}

}  // namespace drapeplan
