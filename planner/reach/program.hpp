// A smooth nonlinear program with exact first and second derivatives, as a solver sees it.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace drapeplan {

/// Minimise objective(v) with bounds on v and on constraints c(v). Lengths should be of order 1.
class SmoothProgram {
 public:
  /// Places of nonzeros, (row, column); a place that occurs twice has the sum of its values. The Hessian's
  /// are those of its lower triangle.
  using Pattern = std::vector<std::pair<int, int>>;
  using VectorRef = Eigen::Ref<const Eigen::VectorXd>;

  /// Infinite where there is no bound.
  struct Bounds {
    Eigen::VectorXd lower, upper;
  };
  /// What does not change with v.
  struct Form {
    Bounds variables, constraints;
    Pattern jacobian, hessian;
  };

  virtual ~SmoothProgram() = default;
  [[nodiscard]] virtual Form form() const = 0;
  /// With its gradient, unless that is null. Values that are not finite tell a solver to take shorter steps.
  [[nodiscard]] virtual double objective(const VectorRef& v, Eigen::VectorXd* gradient) const = 0;
  [[nodiscard]] virtual Eigen::VectorXd constraint_values(const VectorRef& v) const = 0;
  /// In the order of the pattern.
  [[nodiscard]] virtual Eigen::VectorXd jacobian_values(const VectorRef& v) const = 0;
  /// Of sigma * objective + multipliers . constraints, in the order of the pattern.
  [[nodiscard]] virtual Eigen::VectorXd hessian_values(const VectorRef& v, double sigma,
                                                       const VectorRef& multipliers) const = 0;
};

/// Largest violation of a bound on a constraint; infinite where one is not finite.
double violation(const SmoothProgram& program, const SmoothProgram::VectorRef& v);

}  // namespace drapeplan
