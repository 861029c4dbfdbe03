// A plan and its folder: what counts as the same case, what a resumed run goes on with, what is set aside.
#include "planner/search/plan.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "mapping/error.hpp"
#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

Case quick_case(std::vector<std::string> overrides = {}) {
  for (const char* budget : {"optimise.evaluations=2", "optimise.finalists=1"})
    overrides.emplace_back(budget);
  CaseReading reading = read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json", overrides);
  EXPECT_TRUE(reading.errors.empty());
  return std::move(reading.definition);
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(CaseHash, LeavesOutWordsAndBudgetsAndSeesAllElse) {
  const std::uint64_t hash = case_hash(quick_case());
  for (const char* words : {"name=another", "description=another", "grippers.source=a data sheet",
                            "material.source=another", "material.tension.source=another", "references=[]",
                            "optimise.evaluations=77", "optimise.budget=7 min", "optimise.seed=5"})
    EXPECT_EQ(case_hash(quick_case({words})), hash) << words;
  for (const char* change :
       {"friction.coefficient=1.4", "grippers.joint_offset=2 mm", "fem.mesh_size=16 mm",
        "fidelities.screen.mesh_size=26 mm", "schedule.wave.delay=0.9 s", "gravity=9.8 m/s^2"})
    EXPECT_NE(case_hash(quick_case({change})), hash) << change;
}

TEST(Plan, ResumesOnlyItsOwnCaseAndSetsAsideWhatIsNotResumed) {
  const fs::path run = fs::path(testing::TempDir()) / "drapeplan_plan_test";
  fs::remove_all(run);
  const std::vector<std::string> coarse{"fem.mesh_size=40 mm", "fem.time_scaling=30", "fidelities={}"};
  std::vector<fs::path> moved;
  const auto run_plan = [&](std::vector<std::string> changes, bool resume) {
    changes.insert(changes.end(), coarse.begin(), coarse.end());
    const DrapeProblem problem(quick_case(changes));
    OutputFolder out(run, "plan", kEvaluations);
    return plan(
        problem, out,
        {.resume = resume, .threads = 1, .moved = [&](const fs::path& earlier) { moved.push_back(earlier); }},
        {});
  };
  const PlanResult first = run_plan({}, false);
  const std::string log = text_of(run / kEvaluations), resolved = text_of(run / "resolved.json");
  EXPECT_EQ(first.best.frames.size(), 21u);

  EXPECT_THROW(run_plan({"friction.coefficient=1.4"}, true), WrongInput);
  EXPECT_EQ(text_of(run / kEvaluations), log);
  EXPECT_EQ(text_of(run / "resolved.json"), resolved);

  const PlanResult again = run_plan({"name=corrected", "grippers.source=corrected"}, true);
  EXPECT_EQ(text_of(run / kEvaluations), log) << "all of it was known";
  EXPECT_NE(text_of(run / "resolved.json"), resolved);
  EXPECT_EQ(again.best.run.summary.state_hash, first.best.run.summary.state_hash);
  EXPECT_TRUE(moved.empty());

  run_plan({}, false);
  EXPECT_EQ(moved, std::vector<fs::path>{run / "earlier-1"});
  EXPECT_EQ(text_of(run / "earlier-1" / kEvaluations), log);
  fs::remove_all(run);
}

}  // namespace
}  // namespace drapeplan
