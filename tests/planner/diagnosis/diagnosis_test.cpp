// What is said of a drape: complete, in the units of people, and true of what was simulated.
#include "planner/diagnosis/diagnosis.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

Case coarse_case() {
  return read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json",
                   {"fem.mesh_size=40 mm", "fem.time_scaling=30", "fidelities={}"})
      .definition;
}

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
  const Diagnosis diagnosis = diagnosis_of(problem, drape, kReport, {{.gripper = 0, .more = 1, .less = 1}});
  EXPECT_EQ(diagnosis_text(diagnosis, rig), "");
  EXPECT_EQ(remedy_text(diagnosis, rig), "");
}

TEST(StrokeEffects, AreThoseOfTheObjective) {
  // The objective knows one height and one start alone, and the smallest start is 0.
  Strokes best(4, Stroke{.start = 1, .duration = 2, .height = 0.03});
  best[0].start = 0;
  const Learned learned{best, [](const Strokes& strokes) {
                          const double height = strokes[2].height - 0.03, start = strokes[1].start - 1;
                          return 7 + 1e3 * std::max(height, 0.0) + 0.5 * start * start;
                        }};
  const std::vector<StrokeEffect> effects = stroke_effects(learned);
  ASSERT_EQ(effects.size(), 8u);
  EXPECT_EQ(effects[0].gripper, 2);
  EXPECT_TRUE(effects[0].height);
  EXPECT_NEAR(effects[0].more, 5, 1e-9);
  EXPECT_NEAR(effects[0].less, 0, 1e-9);
  EXPECT_EQ(effects[1].gripper, 0) << "where the first one starts later, all others start earlier";
  EXPECT_EQ(effects[2].gripper, 1);
  for (const size_t k : {1, 2}) {
    EXPECT_FALSE(effects[k].height);
    EXPECT_NEAR(effects[k].size(), 0.125, 1e-9);
  }
  EXPECT_EQ(effects[3].size(), 0);
}

}  // namespace
}  // namespace drapeplan
