// A case made ready: what is made on demand is made once, whoever asks, and is what it was when made at once.
#include "planner/drape/problem.hpp"

#include <gtest/gtest.h>

#include "planner/base/parallel.hpp"
#include "planner/case/file.hpp"
#include "planner/search/plan.hpp"

namespace drapeplan {
namespace {

Case quick_case(const std::vector<std::string>& overrides = {}) {
  CaseReading reading = read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json", overrides);
  EXPECT_TRUE(reading.errors.empty());
  return std::move(reading.definition);
}

TEST(DrapeProblem, MakesAModelOnceForAllThreads) {
  const DrapeProblem problem(quick_case());
  constexpr int kAsking = 8;
  std::vector<const Model*> models(kAsking, nullptr);
  parallel_for(
      kAsking, [&](int k) { models[size_t(k)] = &problem.model(k % 2 == 0 ? "screen" : "report"); }, kAsking);
  for (size_t k = 2; k < models.size(); ++k) EXPECT_EQ(models[k], models[k - 2]);
  EXPECT_NE(models[0], models[1]);
  EXPECT_EQ(models[0]->scene().options.mesh_size, 0.025);
  EXPECT_THROW(static_cast<void>(problem.model("finest")), std::out_of_range);
}

TEST(DrapeProblem, AsksForModelsThatCannotBeBuiltOnlyWhenTheyAreUsed) {
  const std::string coarse =
      "fidelities.coarse={\"mesh_size\": \"25 mm\", \"fibre_mass_scaling\": 2, \"step_interval\": 0}";
  const DrapeProblem problem(quick_case({coarse}));
  EXPECT_THROW(static_cast<void>(problem.model("coarse")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(problem.model("coarse")), std::invalid_argument);  // asked again, too
  for (const std::string& fidelity : plan_fidelities(problem.definition()))
    EXPECT_GT(problem.model(fidelity).node_count(), 0) << fidelity;
}

TEST(DrapeProblem, SolvesTheReachProblemOnDemandAndAimsAtItOnlyIfTold) {
  const DrapeProblem mapped(quick_case());
  const ReachResult expected = solve_reach(mapped.reach_problem(), 2, mapped.definition().optimise.seed);
  EXPECT_EQ(mapped.reach().floor_max, expected.floor_max);
  EXPECT_EQ(&mapped.reach(), &mapped.reach());
  const DrapeProblem reachable(quick_case({"schedule.aim=reachable"}));
  ASSERT_EQ(reachable.frame().target_z.size(), expected.joints.size());
  for (size_t g = 0; g < expected.joints.size(); ++g)
    EXPECT_EQ(reachable.frame().target_z[g], expected.joints[g].z());
  EXPECT_NE(reachable.frame().target_z, mapped.frame().target_z);
}

}  // namespace
}  // namespace drapeplan
