#include "planner/search/nlopt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace drapeplan {
namespace {

double bowl(const Eigen::VectorXd& x) {
  return 1 + (x.array() - 0.7).square().sum();
}

std::vector<NloptStart> four_starts(int n, int evaluations) {
  return {{Eigen::VectorXd::Constant(n, 0.0), LocalSearch::cobyla, evaluations},
          {Eigen::VectorXd::Constant(n, 1.0), LocalSearch::sbplx, evaluations},
          {Eigen::VectorXd::Constant(n, 0.5), LocalSearch::cobyla, evaluations},
          {Eigen::VectorXd::Constant(n, 0.2), LocalSearch::sbplx, evaluations}};
}

double best_value(const NloptRun& run) {
  return run.trials[size_t(run.best)].value;
}

TEST(NloptSearch, EverySearchFindsTheBottomOfABowlWithinItsBudget) {
  for (const NloptRun& run : nlopt_search(bowl, four_starts(6, 300), {})) {
    ASSERT_GE(run.best, 0);
    EXPECT_LE(best_value(run), 1 + 1e-3);
    EXPECT_LE(run.trials.size(), 300u);
  }
}

TEST(NloptSearch, TheBudgetIsKeptToTheEvaluation) {
  for (const int budget : {0, 1, 5, 17}) {
    for (const NloptRun& run : nlopt_search(bowl, four_starts(6, budget), {})) {
      EXPECT_EQ(int(run.trials.size()), budget);
    }
  }
}

TEST(NloptSearch, TrialsDoNotDependOnTheNumberOfThreads) {
  NloptOptions one, three;
  one.threads = 1;
  three.threads = 3;
  const auto a = nlopt_search(bowl, four_starts(6, 60), one);
  const auto b = nlopt_search(bowl, four_starts(6, 60), three);
  for (size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].trials.size(), b[i].trials.size());
    for (size_t k = 0; k < a[i].trials.size(); ++k) {
      EXPECT_TRUE((a[i].trials[k].x.array() == b[i].trials[k].x.array()).all());
      EXPECT_EQ(a[i].trials[k].value, b[i].trials[k].value);
    }
  }
}

TEST(NloptSearch, FailuresAreSteppedOver) {
  const auto failing = [](const Eigen::VectorXd& x) {
    const double digits = std::fmod(std::abs(x.sum()) * 13731.7, 1.0);  // no multiple of a step
    if (digits < 0.1) return std::numeric_limits<double>::quiet_NaN();
    if (digits < 0.2) return std::numeric_limits<double>::infinity();
    return bowl(x);
  };
  int failures = 0;
  const std::vector<NloptStart> starts = four_starts(5, 200);
  const std::vector<NloptRun> runs = nlopt_search(failing, starts, {});
  for (size_t i = 0; i < runs.size(); ++i) {
    const NloptRun& run = runs[i];
    ASSERT_GE(run.best, 0);
    // Failures can freeze COBYLA's simplex; SBPLX, which only compares values, steps over them.
    if (starts[i].algorithm == LocalSearch::sbplx) {
      EXPECT_LE(best_value(run), 1.01);
    }
    EXPECT_LT(best_value(run), bowl(starts[i].x));
    for (const NloptTrial& trial : run.trials) failures += std::isfinite(trial.value) ? 0 : 1;
  }
  EXPECT_GT(failures, 0);
}

TEST(NloptSearch, AnExceptionEndsTheSearchAndReachesTheCaller) {
  for (const LocalSearch algorithm : {LocalSearch::cobyla, LocalSearch::sbplx}) {
    int calls = 0;
    const auto throwing = [&calls](const Eigen::VectorXd& x) {
      if (++calls == 5) throw std::runtime_error("the disk is full");
      return bowl(x);
    };
    try {
      nlopt_search(throwing, {{Eigen::VectorXd::Constant(3, 0.2), algorithm, 100}}, {});
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "the disk is full");
    }
    EXPECT_EQ(calls, 5);
  }
}

TEST(NloptSearch, AllFailuresGiveNoBest) {
  const auto never = [](const Eigen::VectorXd&) { return std::numeric_limits<double>::infinity(); };
  for (const NloptRun& run : nlopt_search(never, four_starts(3, 20), {})) EXPECT_EQ(run.best, -1);
}

TEST(NloptSearch, TheBestIsTheLowestOfTheTrials) {
  const auto rough = [](const Eigen::VectorXd& x) { return bowl(x) + 0.02 * std::sin(500 * x.sum()); };
  for (const NloptRun& run : nlopt_search(rough, four_starts(4, 80), {})) {
    for (const NloptTrial& trial : run.trials) {
      EXPECT_LE(best_value(run), trial.value);
      EXPECT_GE(trial.x.minCoeff(), 0);
      EXPECT_LE(trial.x.maxCoeff(), 1);
    }
  }
}

}  // namespace
}  // namespace drapeplan
