#include "planner/search/design.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "mapping/error.hpp"
#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

/// The quick case with two variables and a budget of two generations.
Case designed(const std::string& variables) {
  const auto file = std::filesystem::path(DRAPEPLAN_SOURCE_DIR) / "cases/flexdraper-quick.json";
  const CaseReading reading =
      read_case(file, {"optimise.design=" + variables, "optimise.design_evaluations=22"});
  EXPECT_TRUE(reading.errors.empty());
  return reading.definition;
}

const char* const kTwo = R"([{"path": "grippers.joint_offset", "from": "0 mm", "to": "4 mm"},
                             {"path": "grippers.interlinks.length", "from": "97 mm", "to": "101 mm"}])";

TEST(SearchDesign, FindsTheSameRigWhateverTheThreadsAndServesItFromTheLog) {
  const DrapeProblem base(designed(kTwo));
  EvaluationLog log;
  const DesignResult first = search_design(base, "screen", log, 1);
  const int runs = log.size();
  EXPECT_EQ(first.evaluations, 20) << "whole generations of 4 + floor(3 ln 8) = 10";
  EXPECT_EQ(runs, 20);
  const DesignResult again = search_design(base, "screen", log, 2);
  EXPECT_EQ(log.size(), runs) << "all known";
  EvaluationLog other;
  const DesignResult two = search_design(base, "screen", other, 2);
  EXPECT_EQ(first.overrides, again.overrides);
  EXPECT_EQ(first.overrides, two.overrides);
  EXPECT_EQ(first.wave, two.wave);
  const RigOptions& rig = *first.problem->definition().grippers;
  EXPECT_LE(rig.joint_offset, 0.004);
  EXPECT_EQ(rig.interlinks->lengths.size(), 12u);
}

TEST(SearchDesign, TellsWhatEveryChangeBrought) {
  const DrapeProblem base(designed(kTwo));
  EvaluationLog log;
  DesignResult design = search_design(base, "screen", log, 0);
  const SequenceFrame& frame = design.problem->frame();
  compare_changes(base, to_schedule(frame, uniform_strokes(frame)), log, 0, design);
  ASSERT_EQ(design.changes.size(), 2u);
  EXPECT_EQ(design.changes[0].before, "1 mm");
  EXPECT_EQ(design.changes[1].before, "spacing");
  EXPECT_TRUE(design.changes[1].after.ends_with(" mm"));
  for (const DesignChange& change : design.changes) EXPECT_TRUE(change.without.score.valid) << change.path;
}

TEST(SearchDesign, EndsWithAReasonWhereNoDesignIsACase) {
  const DrapeProblem base(designed(R"([{"path": "grippers.spacing", "from": "1 mm", "to": "2 mm"}])"));
  EvaluationLog log;
  EXPECT_THROW(search_design(base, "screen", log, 0), NotFinished);
}

}  // namespace
}  // namespace drapeplan
