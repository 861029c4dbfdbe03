// A case that names no numerical settings: where they begin, what is chosen, and that a plan which goes on
// chooses the same again.
#include "planner/trust/choice.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "planner/case/file.hpp"
#include "planner/search/plan.hpp"
#include "planner/trust/claim.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

fs::path scratch(const std::string& name) {
  return fs::path(testing::TempDir()) / (name + std::to_string(getpid()));
}

/// The quick case without its numerical settings, with a small budget.
Case bare_case(const std::vector<std::string>& overrides = {}) {
  nlohmann::json file =
      nlohmann::json::parse(std::ifstream(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json"));
  file.erase("fem");
  file.erase("fidelities");
  file["material"] = DRAPEPLAN_SOURCE_DIR "/cases/materials/bmi-4hs.json";
  const fs::path path = scratch("bare_case");
  std::ofstream(path) << file;
  CaseReading reading = read_case(path, overrides);
  fs::remove(path);
  for (const InputError& error : reading.errors) ADD_FAILURE() << error.message;
  return std::move(reading.definition);
}

SettingRuns runs_of(std::vector<double> gaps, double offset = 0.01) {
  SettingRuns runs;
  for (const double gap : gaps) {
    Outcome outcome;
    outcome.score.max_gap = outcome.score.objective = gap;
    outcome.score.max_boundary_offset = offset;
    outcome.score.valid = gap > 0;
    runs.outcomes.push_back(outcome);
  }
  return runs;
}

TEST(Fidelities, FollowFromSizesWhereAFileNamesNone) {
  const Case bare = bare_case();
  EXPECT_TRUE(bare.chooses_fidelities);
  ASSERT_EQ(bare.fidelities.size(), 3u);
  // One, two and three cells along the radius of a pad, here 20 mm.
  EXPECT_NEAR(bare.fidelities.at("screen").mesh_size, 20.2e-3, 1e-9);
  EXPECT_NEAR(bare.fidelities.at("search").mesh_size, 10.1e-3, 1e-9);
  EXPECT_NEAR(bare.fidelities.at("report").mesh_size, 6.73e-3, 1e-9);
  // The wave's strokes of 3.5 s in 2.5 times what the ply with 20 times its mass falls through 30 mm in.
  EXPECT_NEAR(bare.fidelities.at("report").time_scaling, 3.5 / (2.5 * std::sqrt(2 * 0.03 * 20 / 9.81)), 0.01);
  EXPECT_NEAR(
      bare_case({"mold.extent=[[\"0 mm\", \"450 mm\"], [\"0 mm\", \"450 mm\"]]", "grippers.pad_radius=2 mm"})
          .fidelities.at("screen")
          .mesh_size,
      1.01 * 0.1 / 8, 1e-4)
      << "pads that are much smaller than the ply between them give no size to cells";
  EXPECT_FALSE(bare_case({"fem.mesh_size=20 mm"}).chooses_fidelities);
  EXPECT_FALSE(changed_case(bare, {}).definition.chooses_fidelities) << "a resolved case names its settings";
}

TEST(Difference, IsRelativeToTheLargerOfAFigureAndItsTarget) {
  const ScoreOptions score;  // targets: 1 mm and 2 mm
  EXPECT_NEAR(difference(runs_of({0.011}), runs_of({0.010}), score), 0.1, 1e-12);
  EXPECT_NEAR(difference(runs_of({0.0003}), runs_of({0.0002}), score), 0.1, 1e-12) << "below the target";
  EXPECT_NEAR(difference(runs_of({0.010}, 0.0025), runs_of({0.010}, 0.002), score), 0.25, 1e-12);
  EXPECT_NEAR(difference(runs_of({0.010, 0.010}), runs_of({0.010, 0.008}), score), 0.25, 1e-12)
      << "the worst schedule";
  EXPECT_TRUE(std::isinf(difference(runs_of({0}), runs_of({0.01}), score))) << "a failed run";
}

TEST(Choice, IsTheSameForAnyNumberOfThreadsAndFromTheLog) {
  const Case bare = bare_case({"optimise.evaluations=30", "optimise.finalists=1"});
  EvaluationLog one, two;
  const FidelityChoice choice = choose_fidelities(bare, one, 1), again = choose_fidelities(bare, two, 2);
  EXPECT_EQ(choice_json(choice)["chosen"].size(), choice.chosen.size());
  const auto options_of = [](const FidelityChoice& from) {
    std::vector<std::string> list;
    for (const ChosenFidelity& fidelity : from.chosen)
      list.push_back(fidelity.name + ": " + setting_text(fidelity.options));
    return list;
  };
  EXPECT_EQ(options_of(choice), options_of(again));
  const int runs = one.size();
  EXPECT_EQ(options_of(choose_fidelities(bare, one, 1)), options_of(choice));
  EXPECT_EQ(one.size(), runs) << "all was served from the log";

  ASSERT_FALSE(choice.chosen.empty());
  EXPECT_EQ(choice.chosen.back().name, kReport);
  if (choice.chosen.size() > 1) {
    EXPECT_EQ(choice.chosen.front().name, kSearched.front()) << "cheapest first";
    EXPECT_GE(choice.chosen.front().ranks, kScreenRanks);
  }
  for (const Level& level : choice.levels) EXPECT_GE(level.error, 0);
  EXPECT_NE(choice_table(choice, bare.optimise, 1).find("report"), std::string::npos);
}

TEST(Choice, PlansGoOnWithIt) {
  const fs::path run = scratch("choice_plan");
  fs::remove_all(run);
  Case bare = bare_case({"optimise.evaluations=2", "optimise.finalists=1"});
  OutputFolder out(run, "plan", kEvaluations);
  const std::uint64_t hash = case_hash(bare);
  EvaluationLog log = start_log(bare, out, {});
  FemOptions coarse;
  coarse.mesh_size = 0.04;
  coarse.time_scaling = 30;
  coarse.rates = false;
  bare.fidelities = {{kReport, coarse}};
  EXPECT_EQ(case_hash(bare), hash)
      << "the log of a case that chooses its settings is known whatever it chose";
  plan(DrapeProblem(bare), log, {.threads = 1});
  const int evaluations = log.size();
  plan(DrapeProblem(bare), log, {.threads = 1});
  EXPECT_EQ(log.size(), evaluations);
  bare.fidelities.at(kReport).mesh_size = 0.05;
  plan(DrapeProblem(bare), log, {.threads = 1});
  EXPECT_EQ(log.size(), 2 * evaluations) << "the same names with other settings are other evaluations";
  fs::remove_all(run);
}

StagedResult searched(double uniform, double wave, double best) {
  StagedResult search;
  for (const auto& [candidate, objective] :
       {std::pair(&search.uniform, uniform), {&search.wave, wave}, {&search.best, best}}) {
    candidate->outcome.score.objective = objective;
    candidate->outcome.score.valid = true;
  }
  search.best.name = "gripper 7";
  search.beats_baselines = true;
  search.message = "better";
  return search;
}

TEST(Claim, StandsOnlyBeyondTheError) {
  StagedResult far = searched(30, 28, 21);
  claim_beyond(0.05, far);
  EXPECT_TRUE(far.beats_baselines);
  EXPECT_EQ(far.message, "better; objectives may be off by 5.0 %");
  StagedResult near = searched(30, 28, 27);
  claim_beyond(0.05, near);
  EXPECT_FALSE(near.beats_baselines);
  EXPECT_NE(near.message.find("no better than the baselines within the error of 5.0 %"), std::string::npos);
  StagedResult unfollowed = searched(30, 28, 29);  // wins, since the rig does not follow the baselines
  claim_beyond(0.05, unfollowed);
  EXPECT_TRUE(unfollowed.beats_baselines);
}

}  // namespace
}  // namespace drapeplan
