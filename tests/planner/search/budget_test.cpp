#include "planner/search/budget.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/drape/problem.hpp"

namespace drapeplan {
namespace {

/// A batch of outcomes of one length, on two cores: the clock shows half of the sum.
std::vector<Outcome> batch(int count, double seconds, double& clock) {
  std::vector<Outcome> outcomes;
  for (int k = 0; k < count; ++k) {
    clock += 0.5 * seconds;
    Outcome outcome;
    outcome.score.valid = true;
    outcome.score.objective = 7;
    outcome.score.duration = 12;
    outcome.wall_seconds = seconds;
    outcome.elapsed = clock;
    outcomes.push_back(outcome);
  }
  return outcomes;
}

TEST(Budget, OfTimeKeepsWhatTheReportsWillTake) {
  OptimiseOptions options;
  options.budget = 100;
  Progress last;
  Budget budget(options, [&](const Progress& p) { last = p; });
  EXPECT_EQ(budget.spent(), 0);
  double clock = 0;
  budget.count("baseline", kReport, batch(2, 10, clock), true);
  EXPECT_NEAR(budget.spent(), 10.0 / 100, 1e-12);
  budget.reserve(4, 2);  // 20 s on two cores, and half of one for the core that ends last
  EXPECT_NEAR(budget.spent(), 10.0 / 75, 1e-12);
  EXPECT_EQ(budget.affords(0.5, "screen"), 0) << "nothing is known of its cost";
  budget.count("wave", "screen", batch(10, 1, clock));
  EXPECT_NEAR(budget.spent(), 15.0 / 75, 1e-12);
  EXPECT_EQ(budget.affords(0.5, "screen"), 75) << "37.5 s of half a second";
  EXPECT_EQ(last.planned, 0);
  EXPECT_NEAR(last.seconds_left, 85, 1e-12) << "with the reports";
  budget.count("report", kReport, batch(4, 10, clock), true);
  EXPECT_NEAR(budget.spent(), 35.0 / 100, 1e-12);
  budget.keep(20);
  EXPECT_NEAR(budget.spent(), 35.0 / 80, 1e-12);
}

TEST(Budget, OfEvaluationsDoesNotCountReports) {
  OptimiseOptions options;
  options.evaluations = 50;
  Progress last;
  Budget budget(options, [&](const Progress& p) { last = p; });
  double clock = 0;
  budget.count("baseline", kReport, batch(2, 10, clock), true);
  EXPECT_EQ(budget.spent(), 0);
  budget.reserve(3, 2);
  EXPECT_EQ(budget.affords(0.5, "screen"), 25);
  budget.count("wave", "screen", batch(20, 1, clock));
  EXPECT_NEAR(budget.spent(), 0.4, 1e-12);
  EXPECT_EQ(last.done, 22);
  EXPECT_EQ(last.planned, 22 + 30 + 3);
  EXPECT_NEAR(last.seconds_left, 30 * 0.5 + 3 * 5 + 5, 1e-9);
  budget.count("smooth", "screen", batch(33, 1, clock));
  EXPECT_GE(budget.spent(), 1);
  EXPECT_EQ(last.planned, 55 + 3) << "a generation may go over the budget";
}

TEST(Budget, KnowsItsCoresAfterALongSearchOverTheRig) {
  OptimiseOptions options;
  options.budget = 1000;
  Budget budget(options, {});
  double clock = 500;
  budget.count("baseline", kReport, batch(2, 10, clock), true);
  budget.reserve(4, 2);
  EXPECT_NEAR(budget.spent(), 510.0 / 975, 0.02) << "half a second of clock for each second of a run";
  std::vector<Outcome> failed = batch(1, 10, clock);
  failed[0].score.valid = false;
  failed[0].score.duration = std::nan("");  // as it is read from a log
  budget.count("smooth", "screen", failed);
  EXPECT_TRUE(std::isfinite(budget.spent()));
}

TEST(Budget, IsSpentWhereTheReportsAloneTakeLonger) {
  OptimiseOptions options;
  options.budget = 10;
  Budget budget(options, {});
  double clock = 0;
  budget.count("baseline", kReport, batch(2, 10, clock), true);
  budget.reserve(3, 2);
  EXPECT_GE(budget.spent(), 1);
  EXPECT_EQ(budget.affords(0.5, kReport), 0);
}

}  // namespace
}  // namespace drapeplan
