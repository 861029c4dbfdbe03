// What is said of a drape: complete, in the units of people, and true of what was simulated.
#include "planner/diagnosis/diagnosis.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/planner/trust/coarse_case.hpp"

namespace drapeplan {
namespace {

TEST(Diagnosis, NamesTheHighestFoldAndTheEdge) {
  const DrapeProblem problem(coarse_case());
  const RigOptions& rig = *problem.definition().grippers;
  const Drape drape =
      problem.run(to_schedule(problem.frame(), uniform_strokes(problem.frame())), kReport, 21);
  ASSERT_TRUE(drape.score.valid) << drape.score.reason;
  const Diagnosis diagnosis = diagnosis_of(problem, drape, kReport);
  ASSERT_FALSE(diagnosis.folds.empty());
  EXPECT_NEAR(diagnosis.folds.front().height, drape.score.max_gap, 1e-12);
  for (const Fold& fold : diagnosis.folds) EXPECT_GT(fold.height, problem.definition().score.target_gap);
  ASSERT_TRUE(diagnosis.edge.has_value());
  EXPECT_NEAR(diagnosis.edge->offset, drape.score.max_boundary_offset, 1e-12);
  const std::string text = diagnosis_text(diagnosis, rig);
  EXPECT_NE(text.find("The ply is highest, "), std::string::npos) << text;
  EXPECT_NE(text.find("The edge is farthest off, by "), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  EXPECT_FALSE(remedy_text(diagnosis, rig).empty());
  const nlohmann::json document = diagnosis_json(diagnosis, rig);
  EXPECT_EQ(document["folds"].size(), diagnosis.folds.size());
  EXPECT_EQ(document["text"], text);
}

TEST(Diagnosis, SaysNothingOfADrapeThatIsGoodEnough) {
  Case loose = coarse_case();
  loose.score.target_gap = loose.score.target_boundary_offset = 0.2;
  const DrapeProblem problem(std::move(loose));
  const Drape drape = problem.run(to_schedule(problem.frame(), uniform_strokes(problem.frame())), kReport, 3);
  const RigOptions& rig = *problem.definition().grippers;
  const Diagnosis diagnosis =
      diagnosis_of(problem, drape, kReport, StrokeEffects{"screen", {{.gripper = 0, .more = 1, .less = 1}}});
  EXPECT_EQ(diagnosis_text(diagnosis, rig), "");
  EXPECT_EQ(remedy_text(diagnosis, rig), "");
}

TEST(StrokeEffects, AreChangesOfTheSimulatedObjective) {
  const DrapeProblem problem(coarse_case());
  const Strokes strokes = wave_strokes(problem.frame());
  EvaluationLog log, other;
  const StrokeEffects effects = stroke_effects(problem, strokes, kReport, {.threads = 1}, log).value();
  ASSERT_EQ(effects.values.size(), 2 * strokes.size());
  const double here = problem.run(to_schedule(problem.frame(), strokes), kReport).score.objective;
  const StrokeEffect& first = effects.values.front();
  Strokes changed = strokes;
  (first.height ? changed[size_t(first.gripper)].height : changed[size_t(first.gripper)].start) +=
      first.height ? kHeightStep : kStartStep;
  shift_to_gauge(changed);
  EXPECT_EQ(problem.run(to_schedule(problem.frame(), changed), kReport).score.objective - here, first.more);
  for (size_t k = 1; k < effects.values.size(); ++k)
    EXPECT_GE(effects.values[k - 1].size(), effects.values[k].size());
  // Any number of threads, and the log, give the same.
  const StrokeEffects again = stroke_effects(problem, strokes, kReport, {.threads = 2}, other).value();
  const int runs = log.size();
  stroke_effects(problem, strokes, kReport, {.threads = 1}, log);
  EXPECT_EQ(log.size(), runs) << "all was served from the log";
  for (size_t k = 0; k < effects.values.size(); ++k) EXPECT_EQ(again.values[k].more, effects.values[k].more);
  EXPECT_FALSE(stroke_effects(problem, strokes, kReport, {.seconds = 1e-9}, other).has_value());
}

}  // namespace
}  // namespace drapeplan
