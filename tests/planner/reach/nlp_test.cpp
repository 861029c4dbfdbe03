#include "planner/reach/nlp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "planner/reach/ipopt.hpp"
#include "tests/planner/reach/problems.hpp"

namespace drapeplan {
namespace {

// ---- derivatives

struct Formulation {
  ReachGoal goal;
  bool free_links;
};

class ReachDerivatives : public testing::TestWithParam<Formulation> {
 protected:
  void SetUp() override {
    problem_ = article_problem(0.02);
    problem_.rig.columns = 3;
    problem_.rig.rows = 2;
    problem_.rig.fixed = {2, 1};
    problem_.targets.resize(6);
    nlp_ = std::make_unique<ReachNlp>(problem_, GetParam().goal, GetParam().free_links);
    std::mt19937 bits(7);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    std::vector<Eigen::Vector2d> places;
    for (const Eigen::Vector3d& t : problem_.targets) {
      places.emplace_back(t.x() + 0.1 * uniform(bits), t.y() + 0.1 * uniform(bits));
    }
    point_ = nlp_->variables_at(places);
    multipliers_.resize(nlp_->constraints());
    for (double& m : multipliers_) m = 3 * uniform(bits);
  }

  static Eigen::MatrixXd dense(const ReachNlp::Pattern& pattern, const Eigen::VectorXd& values, int rows,
                               int columns) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, columns);
    for (size_t k = 0; k < pattern.size(); ++k) matrix(pattern[k].first, pattern[k].second) += values[int(k)];
    return matrix;
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& v) const {
    return dense(nlp_->jacobian_pattern(), nlp_->jacobian_values(v), nlp_->constraints(), nlp_->variables());
  }

  /// Central difference of a vector function along variable k.
  template <class Function>
  Eigen::VectorXd difference(int k, const Function& function) const {
    constexpr double kStep = 1e-5;  // error kStep^2 times third derivatives of order 1 to 10
    Eigen::VectorXd up = point_, down = point_;
    up[k] += kStep;
    down[k] -= kStep;
    return (function(up) - function(down)) / (2 * kStep);
  }

  ReachProblem problem_{RigOptions{}, article_mold(), {}, {0, 0}};
  std::unique_ptr<ReachNlp> nlp_;
  Eigen::VectorXd point_, multipliers_;
};

constexpr double kDifferenceTolerance = 1e-8;

TEST_P(ReachDerivatives, GradientIsTheDifferenceOfTheObjective) {
  const Eigen::VectorXd gradient = nlp_->gradient(point_);
  for (int k = 0; k < nlp_->variables(); ++k) {
    const auto objective = [&](const Eigen::VectorXd& v) {
      return Eigen::VectorXd::Constant(1, nlp_->objective(v));
    };
    EXPECT_LE(std::abs(difference(k, objective)[0] - gradient[k]), kDifferenceTolerance) << k;
  }
  EXPECT_GT(gradient.norm(), 0.01);
}

TEST_P(ReachDerivatives, JacobianIsTheDifferenceOfTheConstraints) {
  const Eigen::MatrixXd exact = jacobian(point_);
  for (int k = 0; k < nlp_->variables(); ++k) {
    const auto values = [&](const Eigen::VectorXd& v) { return nlp_->constraint_values(v); };
    EXPECT_LE((difference(k, values) - exact.col(k)).norm(), kDifferenceTolerance) << k;
    EXPECT_GT(exact.col(k).norm(), 0.01) << k;
  }
}

TEST_P(ReachDerivatives, HessianIsTheDifferenceOfTheLagrangiansGradient) {
  constexpr double kSigma = 0.7;
  const Eigen::MatrixXd lower =
      dense(nlp_->hessian_pattern(), nlp_->hessian_values(point_, kSigma, multipliers_), nlp_->variables(),
            nlp_->variables());
  EXPECT_EQ(lower.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().norm(), 0);
  const Eigen::MatrixXd exact = lower.selfadjointView<Eigen::Lower>();
  for (int k = 0; k < nlp_->variables(); ++k) {
    const auto gradient = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
      return kSigma * nlp_->gradient(v) + jacobian(v).transpose() * multipliers_;
    };
    EXPECT_LE((difference(k, gradient) - exact.col(k)).norm(), kDifferenceTolerance) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(AllFormulations, ReachDerivatives,
                         testing::Values(Formulation{ReachGoal::rms, false},
                                         Formulation{ReachGoal::rms, true},
                                         Formulation{ReachGoal::max, false},
                                         Formulation{ReachGoal::max, true}));

// ---- the solution

// Second-order sufficient condition: the Lagrangian's Hessian is positive on the null space of the Jacobian.
TEST(Reach, TheBestPositionOnTheArticlesMoldIsAStrictMinimum) {
  ReachProblem problem = article_problem();
  problem.rig.tilt_limit = std::numbers::pi / 2;  // no inequalities
  const ReachNlp nlp(problem, ReachGoal::rms);
  std::vector<Eigen::Vector2d> places;
  for (const Eigen::Vector3d& t : problem.targets) places.emplace_back(t.head<2>());
  const IpoptOutcome outcome = minimise(nlp, nlp.variables_at(places));
  ASSERT_TRUE(outcome.converged) << outcome.status;

  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(nlp.constraints(), nlp.variables());
  const Eigen::VectorXd j = nlp.jacobian_values(outcome.variables);
  for (int k = 0; k < j.size(); ++k) {
    const auto [row, column] = nlp.jacobian_pattern()[size_t(k)];
    jacobian(row, column) += j[k];
  }
  const Eigen::VectorXd gradient = nlp.gradient(outcome.variables);
  const Eigen::VectorXd multipliers = jacobian.transpose().colPivHouseholderQr().solve(-gradient);
  EXPECT_LE((gradient + jacobian.transpose() * multipliers).norm(), 1e-9);

  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(nlp.variables(), nlp.variables());
  const Eigen::VectorXd h = nlp.hessian_values(outcome.variables, 1, multipliers);
  for (int k = 0; k < h.size(); ++k) {
    const auto [row, column] = nlp.hessian_pattern()[size_t(k)];
    hessian(row, column) += h[k];
    if (row != column) hessian(column, row) += h[k];
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(jacobian);
  const Eigen::MatrixXd kernel = lu.kernel();
  ASSERT_EQ(kernel.cols(), 8);  // 50 coordinates, 40 interlinks, 2 of the fixed joint
  const Eigen::MatrixXd basis = Eigen::HouseholderQR<Eigen::MatrixXd>(kernel).householderQ() *
                                Eigen::MatrixXd::Identity(kernel.rows(), kernel.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> reduced(basis.transpose() * hessian * basis);
  EXPECT_GT(reduced.eigenvalues().minCoeff(), 0.01);
}

}  // namespace
}  // namespace drapeplan
