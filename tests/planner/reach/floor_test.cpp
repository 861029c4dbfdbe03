#include "planner/reach/floor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "planner/reach/floor_edge.hpp"
#include "planner/reach/floor_nlp.hpp"
#include "tests/planner/reach/floor_problems.hpp"

namespace drapeplan {
namespace {

constexpr double kFree = std::numeric_limits<double>::infinity();
constexpr double kGapTolerance = 3e-5;  // [m]: the solver's, and what the regularisation may cost

/// Within 1 mm of its boundary a ply of 100 mm cannot turn out of its trough by more than 0.01 rad.
FloorPoint floor_of(const FloorProblem& problem, double tolerance = 0.001) {
  FloorOptions options;
  options.tolerances = {tolerance};
  return solve_floor(problem, options).points.front();
}

// ---- derivatives

class FloorDerivatives : public testing::Test {
 protected:
  FloorDerivatives()
      : problem_(small_article_problem()),
        limits_(edge_limits(problem_, problem_.mapped, 0.005)),
        nlp_(problem_, limits_),
        form_(nlp_.form()) {
    std::mt19937 bits(3);
    const auto uniform = [&bits] { return double(bits()) / 4294967296.0 - 0.5; };
    FloorShape shape;
    for (const Eigen::Vector3d& place : problem_.mapped) {
      shape.xy.emplace_back(place.head<2>());
      shape.gap.push_back(0.01 * (1 + uniform()));
    }
    for (int k = 0; k < problem_.rig.count(); ++k) {
      const Eigen::Vector2d at = problem_.mapped[size_t(problem_.held[size_t(k)][0])].head<2>();
      const double dx = uniform(), dy = uniform(), dz = uniform();
      shape.pad.emplace_back(problem_.mold.point(at.x(), at.y()) + 0.01 * Eigen::Vector3d(dx, dy, 1 + dz));
      shape.warp.emplace_back(1 + dz, dx, dy);
      shape.weft.emplace_back(dy, 1 + dx, dz);
    }
    point_ = nlp_.variables_at(shape);
    multipliers_.resize(form_.constraints.lower.size());
    for (double& m : multipliers_) m = uniform();
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& v) const {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(multipliers_.size(), point_.size());
    const Eigen::VectorXd values = nlp_.jacobian_values(v);
    for (size_t k = 0; k < form_.jacobian.size(); ++k)
      matrix(form_.jacobian[k].first, form_.jacobian[k].second) += values[int(k)];
    return matrix;
  }

  template <class Function>
  Eigen::VectorXd difference(int k, const Function& function) const {
    constexpr double kStep = 1e-5;  // error kStep^2 times third derivatives of order 1 to 10
    Eigen::VectorXd up = point_, down = point_;
    up[k] += kStep;
    down[k] -= kStep;
    return (function(up) - function(down)) / (2 * kStep);
  }

  Eigen::VectorXd gradient(const Eigen::VectorXd& v) const {
    Eigen::VectorXd g;
    EXPECT_TRUE(std::isfinite(nlp_.objective(v, &g)));
    return g;
  }

  FloorProblem problem_;
  std::vector<EdgeLimit> limits_;
  FloorNlp nlp_;
  SmoothProgram::Form form_;
  Eigen::VectorXd point_, multipliers_;
};

constexpr double kDifferenceTolerance = 1e-8;

TEST_F(FloorDerivatives, GradientIsTheDifferenceOfTheObjective) {
  const Eigen::VectorXd exact = gradient(point_);
  for (int k = 0; k < point_.size(); ++k) {
    const auto value = [&](const Eigen::VectorXd& v) {
      return Eigen::VectorXd::Constant(1, nlp_.objective(v, nullptr));
    };
    EXPECT_LE(std::abs(difference(k, value)[0] - exact[k]), kDifferenceTolerance) << k;
  }
  EXPECT_GT(exact.norm(), 0.5);
}

TEST_F(FloorDerivatives, JacobianIsTheDifferenceOfTheConstraints) {
  const Eigen::MatrixXd exact = jacobian(point_);
  for (int k = 0; k < point_.size(); ++k) {
    const auto values = [&](const Eigen::VectorXd& v) { return nlp_.constraint_values(v); };
    EXPECT_LE((difference(k, values) - exact.col(k)).norm(), kDifferenceTolerance) << k;
    EXPECT_GT(exact.col(k).norm(), 0.01) << k;
  }
}

TEST_F(FloorDerivatives, HessianIsTheDifferenceOfTheLagrangiansGradient) {
  constexpr double kSigma = 0.7;
  Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(point_.size(), point_.size());
  const Eigen::VectorXd values = nlp_.hessian_values(point_, kSigma, multipliers_);
  for (size_t k = 0; k < form_.hessian.size(); ++k) {
    const auto [row, column] = form_.hessian[k];
    ASSERT_GE(row, column);
    exact(row, column) += values[int(k)];
    if (row != column) exact(column, row) += values[int(k)];
  }
  for (int k = 0; k < point_.size(); ++k) {
    const auto lagrangian = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
      return kSigma * gradient(v) + jacobian(v).transpose() * multipliers_;
    };
    EXPECT_LE((difference(k, lagrangian) - exact.col(k)).norm(), kDifferenceTolerance) << k;
  }
}

// ---- closed forms

TEST(Floor, AFlatMoldLeavesNoGap) {
  FloorProblem problem = trough_problem(1e6);
  const FloorPoint point = floor_of(problem, 0.002);
  ASSERT_TRUE(point.converged) << point.status;
  EXPECT_LE(point.gap, kGapTolerance);
  EXPECT_LE(point.boundary_offset, 0.002 + kGapTolerance);
}

// The bar holds the pads at the ends of a chord as long as the fibre between them; both halves of the fibre
// stretch by e and hang s / 2 sqrt((1 + e)^2 - 1) below the chord, whose middle is s^2 / (8 R) above the
// mold.
TEST(Floor, ARigidInterlinkHoldsThePlyAtTheChordOfItsTrough) {
  constexpr double kRadius = 0.15, kSpacing = 0.1;
  const FloorProblem problem = trough_problem(kRadius);
  const FloorPoint point = floor_of(problem);
  ASSERT_TRUE(point.converged) << point.status;
  const double stretch = 1 + problem.fibre_strain;
  const double exact =
      kSpacing * kSpacing / (8 * kRadius) - 0.5 * kSpacing * std::sqrt(stretch * stretch - 1);
  EXPECT_GT(exact, 0.005);
  EXPECT_LE(std::abs(point.gap - exact), kGapTolerance) << point.gap;
  EXPECT_LE(net_strain(problem, point.nodes), problem.fibre_strain + 1e-5);
  ASSERT_FALSE(point.spans.empty());
  EXPECT_FALSE(point.spans.front().weft);
  EXPECT_EQ(point.spans.front().from, 0);
  EXPECT_EQ(point.spans.front().to, 1);
  EXPECT_GT(point.spans.front().shortage, 0.001);
}

FloorProblem with_lengths(FloorProblem problem) {
  const double half = trough_place(0.15, 0.05);
  problem.rig.interlinks->lengths = {2 * half};  // joints lie on the ply, at equal heights
  problem.fixed_place.x() = -half;
  return problem;
}

TEST(Floor, AnInterlinkAsLongAsMappedLeavesNoGap) {
  const FloorPoint point = floor_of(with_lengths(trough_problem(0.15)));
  ASSERT_TRUE(point.converged) << point.status;
  EXPECT_LE(point.gap, kGapTolerance);
}

TEST(Floor, PlayLiesBetweenRigidAndFree) {
  FloorProblem problem = trough_problem(0.15);
  const double rigid = floor_of(problem).gap;
  problem.rig.interlinks->play = {0.0003, 0.0003};
  const double some = floor_of(problem).gap;
  problem.rig.interlinks->play = {0.005, 0.005};
  const double much = floor_of(problem).gap;
  problem.rig.interlinks->play = {0, 0};
  problem.rig.interlinks->stiffness = 1e5;
  const double springs = floor_of(problem).gap;
  EXPECT_LT(some, rigid - 0.0005);
  EXPECT_GT(some, much + 0.0005);
  EXPECT_LE(much, kGapTolerance);
  EXPECT_LE(springs, kGapTolerance);
}

// ---- the front

TEST(Floor, ALooserBoundaryNeverRaisesTheFloorAndStartsAgree) {
  const FloorProblem problem = small_article_problem(0.001);
  FloorOptions options;
  options.tolerances = {kFree, 0.015, 0.030};
  const FloorFront front = solve_floor(problem, options);
  ASSERT_EQ(front.points.size(), 3u);
  for (const FloorPoint& point : front.points) {
    ASSERT_TRUE(point.converged) << point.boundary_tolerance << ": " << point.status;
    EXPECT_LE(net_strain(problem, point.nodes), problem.fibre_strain + 1e-5);
    for (const double gap : point.gaps) EXPECT_LE(gap, point.gap + kGapTolerance);
    EXPECT_LE((point.joints[1].head<2>() - problem.fixed_place).norm(), 1e-6);
  }
  EXPECT_EQ(front.points[0].boundary_tolerance, kFree);
  EXPECT_LE(front.points[0].gap, front.points[2].gap + kGapTolerance);
  EXPECT_LE(front.points[2].gap, front.points[1].gap + kGapTolerance);
  EXPECT_EQ(front.starts, 3);
  EXPECT_EQ(front.agreed, front.converged);
  EXPECT_GE(front.agreed, 2);
  EXPECT_LE(front.start_spread, kGapTolerance);
}

TEST(Floor, TheSameProblemGivesTheSameBits) {
  const FloorProblem problem = trough_problem(0.15);
  EXPECT_EQ(floor_of(problem, 0.005).gap, floor_of(problem, 0.005).gap);
}

// ---- what cannot be done, and words

TEST(Floor, FibresShorterThanTheirInterlinkAreSaidToContradictIt) {
  FloorProblem problem = trough_problem(0.15);
  problem.rig.interlinks->lengths = {0.2};
  const FloorFront front = solve_floor(problem);
  for (const FloorPoint& point : front.points) {
    EXPECT_FALSE(point.converged);
    EXPECT_TRUE(std::isnan(point.gap));
    EXPECT_FALSE(point.status.empty());
  }
  EXPECT_NE(explain_floor(problem, front).find("no floor of the ply's gap was found"), std::string::npos);
}

TEST(Floor, UnsoundInputIsAStatus) {
  FloorProblem problem = trough_problem(0.15);
  problem.held[1].clear();
  EXPECT_EQ(floor_of(problem).status, "gripper [2, 1] holds no node of the net");
  problem = trough_problem(0.15);
  problem.mapped.pop_back();
  EXPECT_EQ(floor_of(problem).status, "the net and its mapping do not fit");
  problem = trough_problem(0.15);
  problem.rig.spacing = 0;
  EXPECT_EQ(floor_of(problem).status, "the spacing is not positive");
}

TEST(Floor, TheExplanationNamesTheSpan) {
  const FloorProblem problem = trough_problem(0.15);
  FloorOptions options;
  options.tolerances = {0.001};
  const FloorFront front = solve_floor(problem, options);
  const std::string text = explain_floor(problem, front);
  EXPECT_NE(text.find("With its edge within 1.0 mm"), std::string::npos) << text;
  EXPECT_NE(text.find("the warp between grippers [1, 1] and [2, 1] is "), std::string::npos) << text;
  EXPECT_NE(front_table(front).find("  1"), std::string::npos);
}

}  // namespace
}  // namespace drapeplan
