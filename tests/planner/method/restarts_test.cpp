#include "planner/method/restarts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace drapeplan {
namespace {

/// Many valleys on a bowl with its bottom, 0, at 0.7.
double valleys(const Eigen::VectorXd& x) {
  double sum = 0;
  for (const double coordinate : x) {
    const double y = 10 * (coordinate - 0.7);
    sum += y * y + 10 * (1 - std::cos(3 * y));
  }
  return sum;
}

double search(Method& method, int evaluations) {
  double best = std::numeric_limits<double>::infinity();
  for (int done = 0; done < evaluations;) {
    const Eigen::MatrixXd x = method.ask();
    Eigen::VectorXd values(x.cols());
    for (Eigen::Index k = 0; k < x.cols(); ++k) values[k] = valleys(x.col(k));
    best = std::min(best, values.minCoeff());
    method.tell(values);
    done += int(x.cols());
  }
  return best;
}

TEST(RestartedCmaEs, ComesOutOfAValleyWithALargerPopulation) {
  const Eigen::VectorXd x0 = Eigen::VectorXd::Constant(4, 0.1);
  CmaEs once(x0, {.sigma0 = 0.05});
  RestartedCmaEs restarted(x0, {.sigma0 = 0.05});
  EXPECT_GE(search(once, 1200), 1);
  EXPECT_LE(search(restarted, 12000), 0.1);
  EXPECT_GE(restarted.restarts(), 1);
}

TEST(RestartedCmaEs, IsPlainCmaEsUntilItStands) {
  const Eigen::VectorXd x0 = Eigen::VectorXd::Constant(4, 0.6);
  CmaEs once(x0, {.sigma0 = 0.1});
  RestartedCmaEs restarted(x0, {.sigma0 = 0.1});
  EXPECT_EQ(search(once, 80), search(restarted, 80));
  EXPECT_EQ(once.mean(), restarted.mean());
  EXPECT_EQ(restarted.restarts(), 0);
}

TEST(RestartedCmaEs, GoesOnWhereAllFails) {
  RestartedCmaEs method(Eigen::VectorXd::Constant(3, 0.5), {});
  for (int k = 0; k < 200; ++k) {
    const Eigen::MatrixXd x = method.ask();
    ASSERT_TRUE((x.array() >= 0).all() && (x.array() <= 1).all());
    method.tell(Eigen::VectorXd::Constant(x.cols(), std::numeric_limits<double>::infinity()));
  }
  EXPECT_EQ(method.generations(), 200);
  EXPECT_GE(method.restarts(), 1);
}

}  // namespace
}  // namespace drapeplan
