// What a plan does once its search has ended: the winner is the one that the case asks for, and it is looked
// at.
#include "planner/trust/after_search.hpp"

#include <gtest/gtest.h>

#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

Case small_case(Choose choose) {
  Case definition = read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json",
                              {"fem.mesh_size=40 mm", "fem.time_scaling=30", "fidelities={}"})
                        .definition;
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
                  {.fidelities = {plan.trust.spread->fidelity}}, plan.log)
            .value();
    EXPECT_FALSE(worth_of(spread, rule).before(chosen)) << candidate.name;
  }
  EXPECT_EQ(plan.result.best.score.objective, plan.result.search.best.outcome.score.objective);
  if (plan.result.search.best.name == plan.finalists.front().name) return;
  EXPECT_NE(plan.result.search.message.find("it was chosen for its "), std::string::npos);
}

TEST(AfterSearch, KeepsTimeForWhatItDoes) {
  OptimiseOptions optimise;
  EXPECT_NEAR(share_after_search(optimise), kConfirmShare + kSpreadShare, 1e-12);
  optimise.choose = Choose::worst;
  EXPECT_NEAR(share_after_search(optimise), kConfirmShare + 3 * kSpreadShare, 1e-12);
}

}  // namespace
}  // namespace drapeplan
