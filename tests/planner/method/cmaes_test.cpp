#include "planner/method/cmaes.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

namespace drapeplan {
namespace {

using Objective = std::function<double(const Eigen::VectorXd&)>;

/// Evaluations until `target` is reached, or `budget` + 1 if it is not.
int evaluations_to(const Objective& f, const Eigen::VectorXd& x0, double sigma0, double target, int budget,
                   unsigned seed = 1) {
  CmaEsOptions options;
  options.seed = seed;
  options.sigma0 = sigma0;
  CmaEs search(x0, options);
  int count = 0;
  double best = std::numeric_limits<double>::infinity();
  while (count < budget) {
    const Eigen::MatrixXd x = search.ask();
    Eigen::VectorXd values(x.cols());
    for (Eigen::Index k = 0; k < x.cols(); ++k) values[k] = f(x.col(k));
    search.tell(values);
    count += int(x.cols());
    for (const double value : values) best = value < best ? value : best;  // failures are no number
    if (best <= target) return count;
  }
  return budget + 1;
}

double sphere(const Eigen::VectorXd& x) {
  return (x.array() - 0.6).square().sum();
}

/// Condition 1e4, axes turned by a fixed orthogonal matrix.
Objective rotated_ellipsoid(int n) {
  std::mt19937 bits(7);
  Eigen::MatrixXd a(n, n);
  for (Eigen::Index i = 0; i < a.size(); ++i)
    a.data()[i] = double(bits()) / double(std::mt19937::max()) - 0.5;
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(a).householderQ();
  return [q, n](const Eigen::VectorXd& x) {
    const Eigen::VectorXd y = q * (x.array() - 0.6).matrix();
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += std::pow(1e4, double(i) / (n - 1)) * y[i] * y[i];
    return sum;
  };
}

/// On [-2, 2]^n, minimum 0 at 1.
double rosenbrock(const Eigen::VectorXd& unit) {
  const Eigen::VectorXd x = 4 * unit.array() - 2;
  double sum = 0;
  for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
    sum += 100 * std::pow(x[i + 1] - x[i] * x[i], 2) + std::pow(1 - x[i], 2);
  }
  return sum;
}

// Budgets are about 1.5 times what seeds 1 to 5 needed; Hansen's tutorial expects 100 n to 300 n^2.
TEST(CmaEs, SolvesTheSphere) {
  EXPECT_LE(evaluations_to(sphere, Eigen::VectorXd::Constant(5, 0.3), 0.2, 1e-10, 1000), 1000);
  EXPECT_LE(evaluations_to(sphere, Eigen::VectorXd::Constant(25, 0.3), 0.2, 1e-10, 5000), 5000);
}

TEST(CmaEs, SolvesTheRotatedEllipsoid) {
  EXPECT_LE(evaluations_to(rotated_ellipsoid(5), Eigen::VectorXd::Constant(5, 0.3), 0.2, 1e-8, 3000), 3000);
  EXPECT_LE(evaluations_to(rotated_ellipsoid(25), Eigen::VectorXd::Constant(25, 0.3), 0.2, 1e-8, 25000),
            25000);
}

// From 4 variables on Rosenbrock's function has a second minimum (value about 4, first coordinate -1) that
// takes some of the seeds; round-off decides which. Most must come to the end of the valley, all others into
// that minimum.
TEST(CmaEs, FollowsTheValleyOfRosenbrock) {
  EXPECT_LE(evaluations_to(rosenbrock, Eigen::VectorXd::Constant(5, 0.5), 0.1, 1e-8, 5000), 5000);
  int solved = 0;
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    EXPECT_LE(evaluations_to(rosenbrock, Eigen::VectorXd::Constant(25, 0.5), 0.1, 4.1, 60000, seed), 60000);
    solved += evaluations_to(rosenbrock, Eigen::VectorXd::Constant(25, 0.5), 0.1, 1e-8, 60000, seed) <= 60000;
  }
  EXPECT_GE(solved, 3);
}

TEST(CmaEs, FindsAnOptimumInACornerOfTheBox) {
  const auto corner = [](const Eigen::VectorXd& x) { return x.sum(); };
  EXPECT_LE(evaluations_to(corner, Eigen::VectorXd::Constant(10, 0.5), 0.2, 1e-4, 5000), 5000);
}

TEST(CmaEs, SamplesStayInTheBoxAndHaveTheGivenSpread) {
  CmaEsOptions options;
  options.population = 4000;
  options.sigma0 = 0.05;
  CmaEs search(Eigen::VectorXd::Constant(3, 0.5), options);
  const Eigen::MatrixXd x = search.ask();
  for (int i = 0; i < 3; ++i) {
    const double mean = x.row(i).mean();
    const double spread = std::sqrt((x.row(i).array() - mean).square().mean());
    EXPECT_LE(std::abs(mean - 0.5), 4 * 0.05 / std::sqrt(4000.0));
    EXPECT_LE(std::abs(spread - 0.05), 0.05 * 4 / std::sqrt(8000.0));
  }
  options.sigma0 = 5;
  CmaEs wide(Eigen::VectorXd::Constant(3, 0.0), options);
  EXPECT_GE(wide.ask().minCoeff(), 0);
  EXPECT_LE(wide.ask().maxCoeff(), 1);
}

TEST(CmaEs, SameSeedGivesTheSameBitsAndAnotherSeedDoesNot) {
  const auto run = [](std::uint64_t seed) {
    CmaEsOptions options;
    options.seed = seed;
    CmaEs search(Eigen::VectorXd::Constant(6, 0.4), options);
    for (int g = 0; g < 20; ++g) {
      const Eigen::MatrixXd x = search.ask();
      Eigen::VectorXd values(x.cols());
      for (Eigen::Index k = 0; k < x.cols(); ++k) values[k] = sphere(x.col(k));
      search.tell(values);
    }
    return Eigen::MatrixXd(search.ask());
  };
  EXPECT_TRUE((run(1).array() == run(1).array()).all());
  EXPECT_FALSE((run(1).array() == run(2).array()).all());
}

TEST(CmaEs, ReachesTheOptimumThoughAThirdOfTheEvaluationsFail) {
  int calls = 0;
  const auto failing = [&](const Eigen::VectorXd& x) {
    return ++calls % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : sphere(x);
  };
  EXPECT_LE(evaluations_to(failing, Eigen::VectorXd::Constant(5, 0.3), 0.2, 1e-8, 2000), 2000);
}

TEST(CmaEs, AGenerationOfFailuresOnlyShrinksTheStep) {
  CmaEs search(Eigen::VectorXd::Constant(4, 0.3), {});
  search.ask();
  search.tell(Eigen::VectorXd::Constant(search.population(), std::numeric_limits<double>::infinity()));
  EXPECT_EQ(search.sigma(), 0.025);
  EXPECT_TRUE((search.mean().array() == 0.3).all());
}

TEST(CmaEs, OneVariableAndAFlatObjectiveAreFine) {
  EXPECT_LE(evaluations_to(sphere, Eigen::VectorXd::Constant(1, 0.1), 0.2, 1e-8, 500), 500);
  CmaEs search(Eigen::VectorXd::Constant(3, 0.5), {});
  for (int g = 0; g < 100; ++g) {
    search.ask();
    search.tell(Eigen::VectorXd::Constant(search.population(), 1.0));
  }
  EXPECT_TRUE(search.mean().allFinite());
}

TEST(CmaEs, RefusesAStartThatIsNotANumber) {
  EXPECT_THROW(CmaEs(Eigen::VectorXd(), {}), std::invalid_argument);
  EXPECT_THROW(CmaEs(Eigen::VectorXd::Constant(2, std::nan("")), {}), std::invalid_argument);
}

}  // namespace
}  // namespace drapeplan
