// What a run is warned of: every check by its name, and none of a calm drape.
#include "planner/drape/run_checks.hpp"

#include <gtest/gtest.h>

#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

/// Pads that lie on the ply and on the mold.
const DrapeProblem& problem() {
  static const DrapeProblem problem(
      read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json", {"grippers.spacing=80 mm"}).definition);
  return problem;
}

Drape calm_drape() {
  Drape drape;
  RunSummary& run = drape.run.summary;
  run.steps = 10000;
  run.energy.external = 1;
  run.energy.internal = 0.5;
  run.energy.damping = kDampingLimit;
  run.largest_kinetic_ratio = kKineticLimit;
  run.largest_hourglass_share = kHourglassLimit;
  run.largest_penetration = 0.99 * kPenetrationLimit * problem().definition().material.thickness;
  return drape;
}

std::vector<std::string> checks_of(const Drape& drape, const DrapeProblem& of = problem()) {
  std::vector<std::string> names;
  for (const RunWarning& warning : run_warnings(of, drape, kReport)) {
    EXPECT_EQ(warning.text.find(std::string(warning.check) + ":"), 0u) << warning.text;
    names.emplace_back(warning.check);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(RunChecks, SayNothingOfACalmDrapeAndNameWhatIsNot) {
  EXPECT_EQ(checks_of(calm_drape()), Names{});
  Drape drape = calm_drape();
  drape.run.summary.largest_kinetic_ratio = 0.5;
  EXPECT_EQ(checks_of(drape), Names{"kinetic"});
  drape = calm_drape();
  drape.run.summary.energy.damping = 0.6;
  EXPECT_EQ(checks_of(drape), Names{"damping"});
  drape = calm_drape();
  drape.run.summary.largest_hourglass_share = 0.06;
  EXPECT_EQ(checks_of(drape), Names{"hourglass"});
  drape = calm_drape();
  drape.run.summary.steps = 200;  // over cells of 17 mm on 205 mm: 16.6 waves
  EXPECT_EQ(checks_of(drape), Names{"waves"});
  drape = calm_drape();
  drape.run.summary.largest_penetration *= 1.1;
  EXPECT_EQ(checks_of(drape), Names{"penetration"});
  drape = calm_drape();
  drape.score.saturated = 0.5;
  EXPECT_EQ(checks_of(drape), Names{"saturated"});
}

TEST(RunChecks, DoNotCallAPlyThrownThatSinksUndeformed) {
  Drape drape = calm_drape();
  drape.run.summary.largest_kinetic_ratio = 50;
  drape.run.summary.energy.internal = 0.09;
  EXPECT_EQ(checks_of(drape), Names{});
}

TEST(RunChecks, SeePadsThatReachBeyondThePly) {
  const DrapeProblem wide(read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json").definition);
  const std::vector<RunWarning> warnings = run_warnings(wide, calm_drape(), kReport);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NEAR(warnings[0].value, 0.100 + 0.020 - 0.1025, 1e-9);
}

TEST(RunChecks, AThrownDrapeHasNoScore) {
  const DrapeProblem strict(
      read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json", {"score.kinetic_limit=1"}).definition);
  const Schedule uniform = to_schedule(strict.frame(), uniform_strokes(strict.frame()));
  const Score score = strict.run(uniform, "screen").score;
  EXPECT_FALSE(score.valid);
  EXPECT_NE(score.reason.find("thrown"), std::string::npos) << score.reason;
}

}  // namespace
}  // namespace drapeplan
