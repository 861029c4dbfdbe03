// Plants that differ from the case: what is changed, and that both schedules meet the same plants.
#include "planner/trust/spread.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/planner/trust/coarse_case.hpp"

namespace drapeplan {
namespace {

TEST(Disturbances, ChangeOneThingEachUpAndDown) {
  const Case nominal = coarse_case();
  const std::vector<Disturbance> list = disturbances(nominal);
  ASSERT_EQ(list.size(), 15u);
  EXPECT_EQ(list[0].name, "");
  const auto disturbed = [&](const std::string& name) {
    Case plant = nominal;
    Schedule schedule{.paths = {{{0, 0.1}, {2, 0}}}, .release = {3.0}};
    for (const Disturbance& disturbance : list) {
      if (disturbance.name == name) disturbance.apply(plant, schedule);
    }
    return std::pair(plant, schedule);
  };
  EXPECT_NEAR(*disturbed("friction - 20 %").first.friction, 0.8 * *nominal.friction, 1e-12);
  EXPECT_NEAR(disturbed("rig + 2 mm in y").first.ply.position.y(), nominal.ply.position.y() + 0.002, 1e-12);
  EXPECT_NEAR(disturbed("rig turned by - 1 deg").first.ply.angle, nominal.ply.angle - 0.0174533, 1e-6);
  EXPECT_NEAR(disturbed("shear stress + 50 %").first.material.shear.slowest().stress.back(),
              1.5 * nominal.material.shear.slowest().stress.back(), 1e-6);
  EXPECT_NEAR(disturbed("joints - 0.5 mm").first.grippers->joint_offset, 0.0005, 1e-12);
  const Schedule late = disturbed("times + 5 %").second;
  EXPECT_NEAR(late.paths[0][1].time, 2.1, 1e-12);
  EXPECT_NEAR(*late.release[0], 3.15, 1e-12);
}

TEST(PlantSpread, IsTheSameForAnyNumberOfThreadsAndFromTheLog) {
  const DrapeProblem problem(coarse_case());
  const Schedule uniform = to_schedule(problem.frame(), uniform_strokes(problem.frame()));
  const Schedule wave = to_schedule(problem.frame(), wave_strokes(problem.frame()));
  EvaluationLog log, other;
  const PlantSpread spread = spread_of(problem, wave, uniform, {kReport}, {.threads = 1}, log).value();
  ASSERT_EQ(spread.pairs.size(), 15u);
  EXPECT_EQ(spread.fidelity, kReport);
  EXPECT_EQ(spread.pairs[0].best.objective, problem.run(wave, kReport).score.objective);
  EXPECT_EQ(spread.pairs[0].baseline.objective, problem.run(uniform, kReport).score.objective);
  EXPECT_NE(spread.pairs[1].best.objective, spread.pairs[0].best.objective);
  EXPECT_EQ(spread_json(spread),
            spread_json(*spread_of(problem, wave, uniform, {kReport}, {.threads = 2}, other)));
  EXPECT_EQ(log.size(), 30);
  spread_of(problem, wave, uniform, {kReport}, {.threads = 1}, log);
  EXPECT_EQ(log.size(), 30) << "all was served from the log";
}

TEST(PlantSpread, SaysHowOftenTheBestStaysBetterAndWhatFails) {
  Score good, bad, failed;
  good.valid = bad.valid = true;
  good.objective = 1;
  bad.objective = 2;
  failed.reason = "it diverged";
  PlantSpread spread{.fidelity = "search", .pairs = {{"", good, bad}, {"a", bad, good}, {"b", good, failed}}};
  EXPECT_EQ(spread.better(), 1);
  EXPECT_NE(spread_text(spread).find("in 1 of them"), std::string::npos) << spread_text(spread);
  EXPECT_NE(spread_text(spread).find("worst with a"), std::string::npos);
  spread.pairs.push_back({"c", failed, good});
  EXPECT_NE(spread_text(spread).find("it fails in 1, the last with c: it diverged"), std::string::npos);
}

TEST(PlantSpread, IsLeftOutWhereTheTimeIsNotEnough) {
  const DrapeProblem problem(coarse_case());
  const Schedule uniform = to_schedule(problem.frame(), uniform_strokes(problem.frame()));
  EvaluationLog log;
  EXPECT_FALSE(spread_of(problem, uniform, uniform, {kReport}, {.seconds = 1e-9, .threads = 1}, log));
  EXPECT_EQ(log.size(), 1) << "the undisturbed run alone tells so";
}

TEST(Disturbances, MoveTheCommandedPlacesWithTheRig) {
  const Case nominal = coarse_case();
  for (const Disturbance& disturbance : disturbances(nominal)) {
    if (disturbance.name.find("rig") == std::string::npos) continue;
    Case plant = nominal;
    const Eigen::Vector2d corner = nominal.ply.position + Eigen::Vector2d(0.1, 0);
    Schedule schedule{.paths = {{{0, 0.1}}}, .plane_paths = {{{0, corner}}}};
    disturbance.apply(plant, schedule);
    const Eigen::Vector2d joint =
        plant.ply.position + Eigen::Rotation2Dd(plant.ply.angle) * Eigen::Vector2d(0.1, 0);
    EXPECT_LT((schedule.plane_paths[0][0].xy - joint).norm(), 1e-12) << disturbance.name;
  }
}

TEST(PlantSpread, IsWorthWhatTheRuleSays) {
  PlantSpread spread;
  for (const double objective : {20.0, 22.0, 30.0}) {
    DisturbedPair pair;
    pair.best.valid = true;
    pair.best.objective = objective;
    spread.pairs.push_back(pair);
  }
  EXPECT_EQ(worth_of(spread, Choose::nominal).value, 20);
  EXPECT_EQ(worth_of(spread, Choose::mean).value, 24);
  EXPECT_EQ(worth_of(spread, Choose::worst).value, 30);
  EXPECT_EQ(spread_json(spread, Choose::worst)["rule"],
            "the best is the candidate with the lowest worst objective over all plants");
  const Worth all = worth_of(spread, Choose::worst);
  spread.pairs.back().best.valid = false;
  EXPECT_EQ(worth_of(spread, Choose::nominal).failures, 0);
  EXPECT_EQ(worth_of(spread, Choose::mean).value, 21);
  EXPECT_EQ(worth_of(spread, Choose::worst).failures, 1);
  EXPECT_TRUE(all.before(worth_of(spread, Choose::worst))) << "a failure is worse than any objective";
}

}  // namespace
}  // namespace drapeplan
