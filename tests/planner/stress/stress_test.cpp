// The fast part of the matrix of `drapeplan stress`, and its judge.
#include "planner/stress/stress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "planner/base/parallel.hpp"
#include "planner/stress/exact.hpp"

namespace drapeplan {
namespace {

const StressScene& named(const std::vector<StressScene>& scenes, const std::string& text) {
  for (const StressScene& scene : scenes) {
    if ((scene.group + ": " + scene.name).find(text) != std::string::npos) return scene;
  }
  throw std::runtime_error("no scene " + text);
}

TEST(Stress, FindsNoSilentNonsenseInTheFastScenes) {
  std::vector<StressScene> fast;
  for (StressScene& scene : stress_scenes()) {
    scene.bisect = false;
    if (scene.fast) fast.push_back(std::move(scene));
  }
  EXPECT_GE(fast.size(), 12u);
  std::vector<StressOutcome> outcomes(fast.size());
  parallel_for(int(fast.size()), [&](int k) { outcomes[size_t(k)] = play_stress(fast[size_t(k)]); });
  size_t right = 0;
  for (const StressOutcome& o : outcomes) {
    EXPECT_NE(o.verdict, Verdict::wrong) << o.group << ": " << o.name << ": " << o.reason;
    right += o.verdict == Verdict::right;
  }
  EXPECT_GE(right, 10u);  // not all of them refused
}

TEST(Stress, NamesEverySceneOnce) {
  std::set<std::string> names;
  for (const StressScene& scene : stress_scenes())
    EXPECT_TRUE(names.insert(scene.group + ": " + scene.name).second) << scene.group << ": " << scene.name;
  EXPECT_GE(names.size(), 150u);
}

TEST(Stress, CallsARunWrongWhoseFigureIsNotTheRightOne) {
  StressScene scene = named(stress_scenes(), "size: two elements");
  EXPECT_EQ(play_stress(scene).verdict, Verdict::right);
  const auto judge = scene.judge;
  scene.judge = [judge](const StressRun& run) {
    std::vector<StressCheck> checks = judge(run);
    for (StressCheck& check : checks) check.least *= 2, check.most *= 2;
    return checks;
  };
  const StressOutcome outcome = play_stress(scene);
  EXPECT_EQ(outcome.verdict, Verdict::wrong);
  EXPECT_NE(outcome.reason.find("sag"), std::string::npos) << outcome.reason;
  scene.judge = [](const StressRun&) { return std::vector{at_most("not a number", std::nan(""), 1)}; };
  EXPECT_EQ(play_stress(scene).verdict, Verdict::wrong);
  scene.judge = nullptr;
  scene.most_balance = -1;  // what holds for all scenes counts, too
  EXPECT_EQ(play_stress(scene).verdict, Verdict::wrong);
}

TEST(Stress, CallsARefusalOrAStopWrongThatIsNotExpectedOrSaysNothing) {
  StressScene refused = named(stress_scenes(), "mesh: every node is held");
  EXPECT_EQ(play_stress(refused).verdict, Verdict::refused);
  refused.says = "something else";
  EXPECT_EQ(play_stress(refused).verdict, Verdict::wrong);
  refused.says = "";
  refused.otherwise = Verdict::right;
  EXPECT_EQ(play_stress(refused).verdict, Verdict::wrong);

  StressScene stopped = named(stress_scenes(), "ends of tables: tension to 0.3: torn");
  EXPECT_EQ(play_stress(stopped).verdict, Verdict::stopped);
  stopped.otherwise = Verdict::refused;
  EXPECT_EQ(play_stress(stopped).verdict, Verdict::wrong);
}

TEST(Stress, WritesTablesInWhichFailuresStandOut) {
  StressOutcome good{"size", "one \"row\"", Verdict::right, "sag | 1"};
  good.estimated_step = 1e-6, good.true_step = 1.1e-6;
  const StressOutcome bad{"size", "two", Verdict::wrong, "nonsense"};
  const nlohmann::json result = stress_json({good, bad});
  ASSERT_EQ(result["failures"].size(), 1u);
  EXPECT_EQ(result["failures"][0], "size: two");
  EXPECT_NEAR(result["scenes"][0]["true_over_estimated_step"].get<double>(), 1.1, 1e-12);
  EXPECT_TRUE(result["scenes"][1]["true_over_estimated_step"].is_null());
  EXPECT_NE(stress_csv({good, bad}).find("\"one \"\"row\"\"\",right,"), std::string::npos);
  const std::string table = stress_markdown({good, bad});
  EXPECT_NE(table.find("| two | **wrong** | nonsense |"), std::string::npos) << table;
  EXPECT_NE(table.find("sag \\| 1"), std::string::npos) << table;
}

// Published: heavy elastica; a plate strip whose bending (u = 0) or stretch alone bears the load.
TEST(StressExact, HasThePublishedFigures) {
  EXPECT_NEAR(elastica_drop(1), 0.12347, 1e-5);
  EXPECT_NEAR(elastica_drop(10), 0.70020, 1e-5);
  // 5 q L^4 / (384 D), and the shallow cable: s^3 = 3 q L^4 / (64 E t).
  const HingedSag bent = hinged_sag({1, 1e-6, 1, 1e9, 1e-3});
  EXPECT_NEAR(bent.sag, 5e-3 / 384, 1e-9);
  const HingedSag cable = hinged_sag({1, 1e5, 1e-9, 1e9, 1});
  EXPECT_NEAR(cable.sag, std::cbrt(3.0 / 64 / 1e5), 2e-5);
  EXPECT_NEAR(cable.tension, 1 / (8 * cable.sag), 0.01 / cable.sag);
  // tau = G angle, force for 60 degrees.
  const double angle = 1.0471975511965976;
  EXPECT_NEAR(trellis_angle({{0, 2}, {0, 2e5}}, 1e5 * angle / 0.5), angle, 1e-12);
}

}  // namespace
}  // namespace drapeplan
