#include "planner/method/nlopt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace drapeplan {
namespace {

double bowl(const Eigen::VectorXd& x) {
  return 1 + (x.array() - 0.7).square().sum();
}

std::vector<NloptStart> four_starts(int n, int evaluations) {
  return {{Eigen::VectorXd::Constant(n, 0.0), NloptAlgorithm::cobyla, evaluations},
          {Eigen::VectorXd::Constant(n, 1.0), NloptAlgorithm::sbplx, evaluations},
          {Eigen::VectorXd::Constant(n, 0.5), NloptAlgorithm::cobyla, evaluations},
          {Eigen::VectorXd::Constant(n, 0.2), NloptAlgorithm::sbplx, evaluations}};
}

using Objective = std::function<double(const Eigen::VectorXd&)>;
using Trials = std::vector<NloptTrial>;

/// Runs searches to their ends; the trials of each.
std::vector<Trials> run(const Objective& objective, const std::vector<NloptStart>& starts) {
  NloptSearches searches(starts, 1);
  while (searches.stop_reason().empty()) {
    const Eigen::MatrixXd x = searches.ask();
    Eigen::VectorXd values(x.cols());
    for (Eigen::Index k = 0; k < x.cols(); ++k) values[k] = objective(x.col(k));
    searches.tell(values);
  }
  std::vector<Trials> all;
  for (size_t k = 0; k < starts.size(); ++k) all.push_back(searches.trials(k));
  return all;
}

double best_value(const Trials& trials) {
  double best = std::numeric_limits<double>::infinity();
  for (const NloptTrial& trial : trials) {
    if (trial.value < best) best = trial.value;
  }
  return best;
}

TEST(NloptSearches, EachFindsTheBottomOfABowlWithinItsBudget) {
  for (const Trials& trials : run(bowl, four_starts(6, 300))) {
    EXPECT_LE(best_value(trials), 1 + 1e-3);
    EXPECT_LE(trials.size(), 300u);
  }
}

TEST(NloptSearches, EveryAlgorithmStaysInTheBoxAndGetsBetter) {
  for (const auto algorithm :
       {NloptAlgorithm::cobyla, NloptAlgorithm::sbplx, NloptAlgorithm::bobyqa, NloptAlgorithm::direct_l,
        NloptAlgorithm::crs2, NloptAlgorithm::isres, NloptAlgorithm::esch}) {
    const Trials trials = run(bowl, {{Eigen::VectorXd::Constant(3, 0.1), algorithm, 300}})[0];
    ASSERT_GE(trials.size(), 20u) << int(algorithm);
    EXPECT_LE(best_value(trials), 1.05) << int(algorithm);
    for (const NloptTrial& trial : trials) {
      EXPECT_GE(trial.x.minCoeff(), 0);
      EXPECT_LE(trial.x.maxCoeff(), 1);
    }
  }
}

TEST(NloptSearches, KeepTheirBudgetToTheEvaluation) {
  for (const int budget : {0, 1, 5, 17}) {
    for (const Trials& trials : run(bowl, four_starts(6, budget))) EXPECT_EQ(int(trials.size()), budget);
  }
}

TEST(NloptSearches, SideBySideGoTheWayThatEachGoesAlone) {
  const std::vector<NloptStart> starts = four_starts(6, 60);
  const std::vector<Trials> together = run(bowl, starts);
  for (size_t k = 0; k < starts.size(); ++k) {
    const Trials alone = run(bowl, {starts[k]})[0];
    ASSERT_EQ(alone.size(), together[k].size());
    for (size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(alone[i].x, together[k][i].x);
  }
}

TEST(NloptSearches, StepOverFailures) {
  const auto failing = [](const Eigen::VectorXd& x) {
    const double digits = std::fmod(std::abs(x.sum()) * 13731.7, 1.0);  // no multiple of a step
    if (digits < 0.1) return std::numeric_limits<double>::quiet_NaN();
    if (digits < 0.2) return std::numeric_limits<double>::infinity();
    return bowl(x);
  };
  int failures = 0;
  const std::vector<NloptStart> starts = four_starts(5, 200);
  const std::vector<Trials> all = run(failing, starts);
  for (size_t i = 0; i < all.size(); ++i) {
    // Failures can freeze COBYLA's simplex; SBPLX, which only compares values, steps over them.
    if (starts[i].algorithm == NloptAlgorithm::sbplx) {
      EXPECT_LE(best_value(all[i]), 1.01);
    }
    EXPECT_LT(best_value(all[i]), bowl(starts[i].x));
    for (const NloptTrial& trial : all[i]) failures += std::isfinite(trial.value) ? 0 : 1;
  }
  EXPECT_GT(failures, 0);
}

TEST(NloptSearches, EndWhereAllFails) {
  const auto never = [](const Eigen::VectorXd&) { return std::numeric_limits<double>::infinity(); };
  for (const Trials& trials : run(never, four_starts(3, 20))) EXPECT_LE(trials.size(), 20u);
}

}  // namespace
}  // namespace drapeplan
