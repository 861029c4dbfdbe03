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
  for (const std::string& fidelity : plan_ladder(problem.definition()))
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

/// So light that contact springs are those of a case without a press: then nothing before it changes.
const std::vector<std::string> kPressed{
    "press={\"pressure\": \"300 Pa\", \"duration\": \"0.4 s\", \"ramp\": \"0.2 s\"}"};

TEST(DrapeProblem, ScoresThePlyBeforeAndAfterPressing) {
  const DrapeProblem plain(quick_case()), pressed(quick_case(kPressed));
  const Schedule schedule = to_schedule(plain.frame(), uniform_strokes(plain.frame()));
  EXPECT_EQ(schedule_hash(to_schedule(pressed.frame(), uniform_strokes(pressed.frame()))),
            schedule_hash(schedule));
  const Drape without = plain.run(schedule, "screen"), with = pressed.run(schedule, "screen");
  ASSERT_TRUE(with.score.valid && without.score.valid) << with.score.reason;
  EXPECT_FALSE(without.other);
  ASSERT_TRUE(with.other && with.other->before);
  for (const ScorePart& part : kScoreParts) {
    // Largest strains and lags are looked at now and then, at other times in a longer run.
    const bool by_looks = part.value == &Score::max_fibre_strain ||
                          part.value == &Score::max_fibre_compression || part.value == &Score::max_lag ||
                          part.value == &Score::saturated;
    if (by_looks) continue;
    EXPECT_EQ(with.other->score.*part.value, without.score.*part.value) << part.key;
  }
  EXPECT_LT(with.score.rms_gap, 0.95 * without.score.rms_gap);
  EXPECT_EQ(with.score.duration, without.score.duration);
  std::vector<std::string> before = kPressed;
  before.emplace_back("press.objective=before");
  const DrapeProblem before_pressing(quick_case(before));
  const Drape taken = before_pressing.run(schedule, "screen");
  ASSERT_TRUE(taken.other && !taken.other->before);
  EXPECT_EQ(taken.score.objective, without.score.objective);
  EXPECT_EQ(taken.other->score.objective, with.score.objective);
  const Drape searched = before_pressing.run_for_objective(schedule, "screen");
  EXPECT_EQ(searched.score.objective, without.score.objective);
  EXPECT_FALSE(searched.other);
  EXPECT_EQ(searched.run.summary.steps, without.run.summary.steps);
  EXPECT_TRUE(pressed.run_for_objective(schedule, "screen").other);
}

TEST(DrapeProblem, LetsPadsGoInThePressAtTheLatest) {
  std::vector<std::string> released = kPressed;
  released.emplace_back("press.pads=released");
  const DrapeProblem problem(quick_case(released));
  Schedule schedule = to_schedule(problem.frame(), uniform_strokes(problem.frame()));
  ASSERT_EQ(schedule.release.size(), schedule.paths.size());
  for (const auto& time : schedule.release) EXPECT_NEAR(*time, schedule.duration() + 0.2, 1e-4);
  const Schedule again = schedule;
  let_go_pressed(problem.definition().press, schedule);
  EXPECT_EQ(schedule_hash(schedule), schedule_hash(again));
  schedule.release[1] = 1;
  let_go_pressed(problem.definition().press, schedule);
  EXPECT_EQ(*schedule.release[1], 1);
}

}  // namespace
}  // namespace drapeplan
