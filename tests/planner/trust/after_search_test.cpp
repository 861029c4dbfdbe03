// What a plan does once its search has ended: the winner is the one that the case asks for, and it is looked
// at.
#include "planner/trust/after_search.hpp"

#include <gtest/gtest.h>

#include "tests/planner/trust/coarse_case.hpp"

namespace drapeplan {
namespace {

Case small_case(Choose choose) {
  Case definition = coarse_case();
  definition.optimise.evaluations = 8;
  definition.optimise.choose = choose;
  return definition;
}

struct Planned {
  explicit Planned(Choose choose) : problem(small_case(choose)) {
    result = plan(problem, log);
    finalists = result.search.finalists;
    look_closer(problem, log, {}, {}, result, trust);
  }
  DrapeProblem problem;
  EvaluationLog log;
  PlanResult result;
  std::vector<Candidate> finalists;
  PlanTrust trust;
};

TEST(AfterSearch, TheWinnerIsConfirmedAndTriedInPlantsThatDiffer) {
  const Planned plan(Choose::nominal);
  EXPECT_EQ(plan.result.search.best.name, plan.finalists.front().name);
  ASSERT_TRUE(plan.trust.confirmation.has_value());
  EXPECT_EQ(plan.trust.confirmation->reported.objective, plan.result.best.score.objective);
  ASSERT_TRUE(plan.trust.spread.has_value());
  EXPECT_EQ(plan.trust.spread->pairs.front().best.objective, plan.result.best.score.objective);
}

TEST(AfterSearch, TheWinnerMayBeTheOneThatIsLeastDisturbed) {
  const Choose rule = Choose::worst;
  Planned plan(rule);
  ASSERT_TRUE(plan.trust.spread.has_value());
  const Worth chosen = worth_of(*plan.trust.spread, rule);
  EXPECT_EQ(plan.trust.rule, rule);
  int compared = 0;
  for (const Candidate& candidate : plan.finalists) {
    if (!candidate.outcome.score.valid || !candidate.outcome.score.followed) continue;
    if (compared++ == kRobustCandidates) break;
    const PlantSpread spread =
        spread_of(plan.problem, candidate.schedule, plan.result.search.uniform.schedule,
                  {plan.trust.spread->fidelity}, {}, plan.log)
            .value();
    EXPECT_FALSE(worth_of(spread, rule).before(chosen)) << candidate.name;
  }
  EXPECT_EQ(plan.result.best.score.objective, plan.result.search.best.outcome.score.objective);
  if (plan.result.search.best.name == plan.finalists.front().name) return;
  EXPECT_NE(plan.result.search.message.find("it was chosen for its "), std::string::npos);
}

TEST(AfterSearch, SaysWhereTheWinnerCouldNotBeConfirmed) {
  Planned plan(Choose::nominal);
  EXPECT_EQ(plan.result.search.message.find("no time was left"), std::string::npos);
  Case hasty = small_case(Choose::nominal);
  hasty.optimise.evaluations = 0;
  hasty.optimise.budget = 1e-6;
  const DrapeProblem problem(hasty);
  PlanTrust trust;
  look_closer(problem, plan.log, {}, {}, plan.result, trust);
  EXPECT_FALSE(trust.confirmation.has_value());
  EXPECT_NE(plan.result.search.message.find("; no time was left to play it again at a finer setting"),
            std::string::npos);
}

TEST(AfterSearch, KeepsTimeForWhatItDoes) {
  Case definition = small_case(Choose::nominal);
  EXPECT_EQ(seconds_after_search(definition, 1, 2), 0) << "a budget of evaluations";
  definition.optimise.evaluations = 0;
  definition.optimise.budget = 1000;
  const double spread = 1000 * kSpreadShare;
  // Confirmed on finer cells and in more time, as far as a tenth of the budget goes.
  EXPECT_NEAR(seconds_after_search(definition, 10, 2), 67.5 + spread, 1e-9);
  EXPECT_NEAR(seconds_after_search(definition, 20, 2), 67.5 + spread, 1e-9);
  EXPECT_NEAR(seconds_after_search(definition, 60, 2), spread, 1e-9) << "no confirmation is possible";
  definition.optimise.choose = Choose::worst;
  EXPECT_NEAR(seconds_after_search(definition, 60, 2), kRobustCandidates * spread, 1e-9);
}

}  // namespace
}  // namespace drapeplan
