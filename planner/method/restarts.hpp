// CMA-ES that starts again, with twice the population, when it has come to a stand.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>

#include "planner/method/cmaes.hpp"

namespace drapeplan {

/// CMA-ES with restarts and a growing population: A. Auger and N. Hansen, "A restart CMA evolution strategy
/// with increasing population size", CEC 2005. A search stands when it has converged, or when its best value
/// has not fallen for 10 + 30 n / population generations. Deviation: a restart begins at the best point so
/// far with a wide first step, not at a random one, since points far from it cost a drape each to tell
/// nothing.
class RestartedCmaEs : public Method {
 public:
  /// @param x0, options  of the first search; errors as of CmaEs.
  RestartedCmaEs(const Eigen::VectorXd& x0, const CmaEsOptions& options);

  const Eigen::MatrixXd& ask() override;
  void tell(const Eigen::VectorXd& values) override;
  /// Always empty: there is always a larger population.
  [[nodiscard]] std::string stop_reason() const override { return {}; }

  [[nodiscard]] Eigen::VectorXd mean() const { return search_->mean(); }
  [[nodiscard]] int restarts() const { return restarts_; }
  [[nodiscard]] int generations() const { return generations_; }  ///< how many were told
  /// Values so far are not those that come: what was best has to show it again.
  void forget_values();

 private:
  CmaEsOptions options_;
  std::optional<CmaEs> search_;
  Eigen::VectorXd best_;
  double best_value_ = std::numeric_limits<double>::infinity();
  double best_here_ = std::numeric_limits<double>::infinity();  ///< since the last restart
  int restarts_ = 0, generations_ = 0;
  int without_gain_ = 0;  ///< generations since `best_here_` fell
};

}  // namespace drapeplan
