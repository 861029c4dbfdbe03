#include "planner/views/history.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fem/run/monitor.hpp"
#include "fem/run/simulate.hpp"
#include "planner/case/file.hpp"
#include "planner/drape/problem.hpp"
#include "planner/views/files.hpp"

namespace drapeplan {
namespace {

Case shipped(const std::string& name, const std::vector<std::string>& overrides) {
  CaseReading reading = read_case(std::string(DRAPEPLAN_SOURCE_DIR) + "/cases/" + name, overrides);
  EXPECT_TRUE(reading.errors.empty());
  return reading.definition;
}

/// Plays a case without grippers from `from` on.
RunResult play(const Model& model, const Case& definition, Recorder& recorder, const State* from = nullptr,
               double pause = 0) {
  RunRequest request{.duration = definition.duration, .from = from, .pause = pause};
  request.samples = kHistoryInstants;
  request.sample = [&recorder](const Snapshot& now) { recorder.see(now); };
  RunResult run = simulate(model, request);
  recorder.see(run.final);
  return run;
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

TEST(History, OfAPulledStripHasTheGripsWayAndTheSameForceAtBothEnds) {
  const Case definition = shipped("bias-extension.json", {"fem.mesh_size=30 mm"});
  const Model model = model_of(definition, definition.fidelities.at(kReport));
  Recorder recorder(definition, model, nullptr);
  const RunResult run = play(model, definition, recorder);
  ASSERT_EQ(run.summary.status, RunStatus::done);
  const History& history = recorder.history();
  ASSERT_EQ(history.time.size(), size_t(kHistoryInstants));
  EXPECT_EQ(history.time.front(), 0);
  EXPECT_LE(std::abs(history.time.back() - 250), 1e-6);
  EXPECT_EQ(history.time_scaling, 250);
  ASSERT_EQ(history.grips.size(), 2u);
  const GripTrack &foot = history.grips[0], &head = history.grips[1];
  EXPECT_EQ(foot.name, "foot");
  EXPECT_LE(foot.displacement.back().norm(), 1e-12);
  // 10 mm/min for 250 s, of which the ramp of 20 s counts half.
  EXPECT_LE((head.displacement.back() - Eigen::Vector3d(0, 0.04, 0)).norm(), 1e-6);
  EXPECT_GE(head.force.back().y(), 5);
  EXPECT_LE((head.force.back() + foot.force.back()).norm(), 0.02 * head.force.back().norm());
  // The middle goes half the way.
  EXPECT_LE(
      (history.probes.at(0).place.back() - history.probes[0].start - Eigen::Vector3d(0, 0.02, 0)).norm(),
      5e-4);
  EXPECT_TRUE(history.probes[0].gap.empty());
  EXPECT_EQ(
      first_line(grips_csv(history)),
      "time [s],simulated time [s],foot displacement x [mm],foot displacement y [mm],foot displacement z "
      "[mm],"
      "foot force x [N],foot force y [N],foot force z [N],head displacement x [mm],head displacement y [mm],"
      "head displacement z [mm],head force x [N],head force y [N],head force z [N]");
  EXPECT_EQ(probes_json(history)["head"]["force"][1], head.force.back().y());
}

TEST(History, OfAPausedAndContinuedRunIsThatOfTheWholeInTwoParts) {
  Case definition = shipped("cantilever-150.json", {"fem.mesh_size=12.5 mm", "duration=0.2 s"});
  definition.instants = {{"early", 0.05}, {"late", 0.15}, {"never", 1}};
  const Model model = model_of(definition, definition.fidelities.at(kReport));
  Recorder whole(definition, model, nullptr), first(definition, model, nullptr),
      second(definition, model, nullptr);
  play(model, definition, whole);
  const RunResult half = play(model, definition, first, nullptr, 0.1004);  // between two instants
  play(model, definition, second, &half.state);
  std::vector<double> times = first.history().time;
  ASSERT_GE(times.size(), 100u);
  times.pop_back();  // the pause itself
  times.insert(times.end(), second.history().time.begin(), second.history().time.end());
  EXPECT_EQ(times, whole.history().time);
  // Both count from the flat strip.
  EXPECT_EQ(second.history().probes[0].start, whole.history().probes[0].start);
  EXPECT_EQ(second.history().probes[0].place.back(), whole.history().probes[0].place.back());
  ASSERT_EQ(whole.instants().size(), 2u);
  EXPECT_LE(std::abs(whole.instants()[0].ply.time - 0.05), 0.2 / (kHistoryInstants - 1));
  ASSERT_EQ(first.instants().size(), 1u);
  EXPECT_EQ(first.instants()[0].name, "early");
  ASSERT_EQ(second.instants().size(), 1u);
  EXPECT_EQ(second.instants()[0].name, "late");
}

TEST(History, OfAPointOverAMoldHasItsGap) {
  const Case definition = shipped("incline.json", {"duration=0.02 s"});
  const Model model = model_of(definition, definition.fidelities.at(kReport));
  Recorder recorder(definition, model, nullptr);
  play(model, definition, recorder);
  const ProbeTrack& probe = recorder.history().probes.at(0);
  ASSERT_EQ(probe.gap.size(), recorder.history().time.size());
  for (const double gap : probe.gap) EXPECT_LE(std::abs(gap), 15e-6);  // it lies on the plane
  EXPECT_NE(first_line(probes_csv(recorder.history())).find(probe.name + " gap [mm]"), std::string::npos);
}

TEST(History, QuotesNamesThatWouldBreakATable) {
  History history;
  history.time = {0, 1};
  history.probes = {{"a,\"b\"", {0, 0, 0}, {{0, 0, 0}, {0, 0, -0.0015}}, {}}};
  const std::string text = probes_csv(history);
  EXPECT_EQ(text.substr(0, 36), "time [s],\"a,\"\"b\"\" x [mm]\",\"a,\"\"b\"\" y");
  EXPECT_EQ(text.substr(text.find("\n1,")), "\n1,0,0,-1.5,0,0,-1.5,1.5\n");
}

}  // namespace
}  // namespace drapeplan
