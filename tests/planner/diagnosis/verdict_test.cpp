#include "planner/diagnosis/verdict.hpp"

#include <gtest/gtest.h>

namespace drapeplan {
namespace {

FloorPoint floor_at(double edge, double gap, bool converged = true) {
  FloorPoint point;
  point.boundary_tolerance = edge;
  point.gap = gap;
  point.converged = converged;
  return point;
}

ScoreOptions tolerances(double gap, double edge) {
  ScoreOptions options;
  options.target_gap = gap;
  options.target_boundary_offset = edge;
  return options;
}

Score score_of(double gap, double edge, bool valid = true) {
  Score score;
  score.valid = valid;
  score.max_gap = gap;
  score.max_boundary_offset = edge;
  return score;
}

TEST(Verdict, AShapeThatKeepsBothTolerancesShowsThatTheRigDoesNotForbidThem) {
  const ScoreOptions options = tolerances(0.001, 0.002);
  const FloorFront front{
      .points = {floor_at(0.001, 0.0009), floor_at(0.002, 0.0005), floor_at(0.005, 0.0002)}};
  const std::string text = within_reach_text(front, 0.0006, options);
  EXPECT_NE(text.find("within 2 mm"), std::string::npos) << text;
  EXPECT_NE(text.find("within 0.5 mm of the mold"), std::string::npos) << text;
  EXPECT_NE(text.find("within 0.6 mm of their targets"), std::string::npos) << text;
}

TEST(Verdict, NothingIsSaidWhereOnlyALooserEdgeKeepsTheGapOrTheFloorIsNotKnown) {
  const ScoreOptions options = tolerances(0.001, 0.002);
  EXPECT_EQ(within_reach_text({.points = {floor_at(0.002, 0.0015), floor_at(0.005, 0.0005)}}, 0, options),
            "");
  EXPECT_EQ(within_reach_text({.points = {floor_at(0.002, 0.0005, false)}}, 0, options), "");
  EXPECT_EQ(within_reach_text({}, 0, options), "");
}

TEST(Verdict, PlantsCountWhereTheDrapeKeepsBothTolerances) {
  PlantSpread spread;
  // The first one is the case itself.
  for (const Score& best : {score_of(0, 0), score_of(0.0009, 0.0019), score_of(0.0011, 0.0019),
                            score_of(0.0009, 0.0021), score_of(0, 0, false)})
    spread.pairs.push_back({"", best, {}});
  EXPECT_EQ(accepted_plants(spread, tolerances(0.001, 0.002)), 1);
}

}  // namespace
}  // namespace drapeplan
