// Good enough or not: by the tolerances, by the share of the ply, and by what any schedule could do.
#include "planner/drape/acceptance.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "fem/mesh/mesh.hpp"
#include "planner/case/file.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

/// The quick case with these tolerances, and a drape of it.
struct Laid {
  Laid(const std::string& gap, const std::string& edge)
      : problem([&] {
          CaseReading reading = read_case(
              DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json",
              {"score.target_gap=\"" + gap + "\"", "score.target_boundary_offset=\"" + edge + "\""});
          EXPECT_TRUE(reading.errors.empty());
          return std::move(reading.definition);
        }()) {
    drape = problem.run(to_schedule(problem.frame(), uniform_strokes(problem.frame())), "screen");
  }
  DrapeProblem problem;
  Drape drape;
};

TEST(Acceptance, SaysByHowMuchAndWhere) {
  const Laid strict("1 mm", "2 mm");
  const Acceptance acceptance = acceptance_of(strict.problem, strict.drape, "screen");
  EXPECT_FALSE(acceptance.accepted());
  ASSERT_EQ(acceptance.tolerances.size(), 2U);
  const Tolerance& gap = acceptance.tolerances[0];
  EXPECT_EQ(gap.value, strict.drape.score.max_gap);
  EXPECT_FALSE(gap.kept());
  // What is above a millimetre is a wrinkle, or bridges a hollow.
  const std::vector<double> areas = nodal_areas(strict.problem.model("screen").scene().mesh);
  double area = 0;
  for (const double part : areas) area += part;
  EXPECT_GE(gap.share * area, strict.drape.score.wrinkled_area * (1 - 1e-12));
  EXPECT_LT(gap.share, 1);
  EXPECT_GT(acceptance.tolerances[1].share, 0);
  const std::string text = acceptance_text(acceptance);
  EXPECT_EQ(text.rfind("Not accepted: the largest gap is ", 0), 0U) << text;
  EXPECT_NE(text.find("of the edge is farther off"), std::string::npos) << text;
  EXPECT_EQ(acceptance_json(acceptance)["tolerances"][1]["part"], "max_boundary_offset");
}

TEST(Acceptance, AcceptsWhatIsWithinTolerance) {
  const Laid loose("50 mm", "50 mm");
  const Acceptance acceptance = acceptance_of(loose.problem, loose.drape, "screen");
  EXPECT_TRUE(acceptance.accepted());
  EXPECT_EQ(acceptance.tolerances[0].share, 0);
  EXPECT_EQ(acceptance_text(acceptance).rfind("Accepted: the largest gap is ", 0), 0U);
  EXPECT_EQ(out_of_reach_text(loose.problem, acceptance), "");
}

TEST(Acceptance, NamesOnlyWhatIsMissed) {
  const Laid half("50 mm", "0.1 mm");
  const std::string text = acceptance_text(acceptance_of(half.problem, half.drape, "screen"));
  EXPECT_EQ(text.rfind("Not accepted: the largest offset of the edge is ", 0), 0U) << text;
}

TEST(Acceptance, OfAFailedDrapeIsRefused) {
  Laid laid("1 mm", "2 mm");
  laid.drape.score = failed_score("torn");
  const Acceptance acceptance = acceptance_of(laid.problem, laid.drape, "screen");
  EXPECT_FALSE(acceptance.accepted());
  EXPECT_EQ(acceptance_text(acceptance), "Not accepted: torn.");
}

FloorPoint floor_at(double edge, double gap, bool converged = true) {
  FloorPoint point;
  point.boundary_tolerance = edge;
  point.gap = gap;
  point.converged = converged;
  return point;
}

TEST(OutOfReach, TakesTheTightestEdgeThatIsNotTighterThanTheTolerance) {
  FloorFront front;
  front.points = {floor_at(0.001, 0.02), floor_at(0.005, 0.004),
                  floor_at(std::numeric_limits<double>::infinity(), 0.002)};
  ASSERT_NE(out_of_reach(front, 0.001, 0.002), nullptr);
  EXPECT_EQ(out_of_reach(front, 0.001, 0.002)->gap, 0.004);
  EXPECT_EQ(out_of_reach(front, 0.001, 0.006)->gap, 0.002);
  EXPECT_EQ(out_of_reach(front, 0.005, 0.002), nullptr);  // some schedule may
  front.points[1].converged = false;
  EXPECT_EQ(out_of_reach(front, 0.001, 0.002)->gap, 0.002);
  EXPECT_EQ(out_of_reach({}, 0.001, 0.002), nullptr);
}

TEST(ShareBeyond, IsTheShareOfTheLength) {
  // One side of a square of 100 mm is shifted out by 5 mm.
  const std::vector<Eigen::Vector3d> boundary{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}, {0, 0, 0}};
  const std::vector<Eigen::Vector3d> edge{{0, 0, 0}, {0.105, 0, 0}, {0.105, 0.1, 0}, {0, 0.1, 0}, {0, 0, 0}};
  EXPECT_NEAR(share_beyond(edge, boundary, 0.002), (0.1 + 2 * 0.003) / 0.41, 0.004);
  EXPECT_EQ(share_beyond(edge, boundary, 0.006), 0);
}

}  // namespace
}  // namespace drapeplan
