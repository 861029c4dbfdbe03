// The staged search where outcomes come with fields, over two fidelities and the reports.
#include "planner/search/stages.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "planner/drape/problem.hpp"
#include "tests/planner/search/stages_kit.hpp"

namespace drapeplan {
namespace {

/// What each gripper's arrival lacks [s], of a ply that is scored by their root mean square and largest one.
std::vector<float> misses(const SequenceFrame& frame, const Schedule& schedule) {
  const std::vector<double> liked = liked_arrivals(frame);
  std::vector<float> list;
  for (size_t g = 0; g < liked.size(); ++g) {
    const auto& path = schedule.paths[g];
    list.push_back(float(path[path.size() - 2].time - frame.options.preshape_duration - liked[g]));
  }
  return list;
}

double objective_of_misses(const Eigen::VectorXd& fields) {
  const Eigen::VectorXd free = fields.array() - fields.mean();
  return 0.1 + free.norm() / std::sqrt(double(free.size())) + free.lpNorm<Eigen::Infinity>();
}

/// Three fidelities with fields; the cheapest is biased, and one in seven drapes fails there.
Evaluate with_fields(const SequenceFrame& frame, std::atomic<int>* runs = nullptr) {
  return [frame, runs](const Schedule& schedule, const std::string& fidelity) {
    if (runs) ++*runs;
    if (fidelity == "screen" && schedule_hash(schedule) % 7 == 3) throw NotFinished("not finite at node 3");
    Outcome outcome;
    outcome.fields = misses(frame, schedule);
    if (fidelity == "screen") outcome.fields[0] += 0.4f;
    const Eigen::VectorXf all =
        Eigen::Map<const Eigen::VectorXf>(outcome.fields.data(), Eigen::Index(outcome.fields.size()));
    outcome.score.objective = objective_of_misses(all.cast<double>());
    outcome.score.valid = true;
    outcome.score.duration = schedule.duration();
    return outcome;
  };
}

StagedOptions options_with_fields(const SequenceFrame& frame, int evaluations, int threads) {
  StagedOptions options = options_of(evaluations);
  options.ladder = {"screen", "search"};
  options.threads = threads;
  options.objective_near = [](const Eigen::VectorXd&) { return objective_of_misses; };
  options.field_scale = Eigen::VectorXd::Constant(frame.rig.count(), 0.1);
  return options;
}

TEST(StagedSearch, LearnsFieldsAndClimbsAndGivesTheSameWithOneTwoAndFourThreadsAndAfterAStop) {
  const SequenceFrame frame = frame_of(4, 4);
  const auto run = [&](int threads, EvaluationLog& log, std::atomic<int>* runs = nullptr,
                       const std::function<bool()>& stop = {}) {
    return staged_search(frame, options_with_fields(frame, 160, threads),
                         make_batch_evaluate(with_fields(frame, runs), log, threads, 0, stop));
  };
  EvaluationLog log, two_log, four_log;
  const StagedResult one = run(1, log);
  expect_same(one, run(2, two_log));
  expect_same(one, run(4, four_log));
  EXPECT_GT(one.failed_evaluations, 5);
  EXPECT_LE(one.best.outcome.score.objective, 0.25 * one.wave.outcome.score.objective) << one.message;
  int at_search = 0;
  for (const HistoryEntry& entry : one.history) at_search += entry.fidelity == "search" ? 1 : 0;
  EXPECT_GT(at_search, 30);
  const int whole = log.size();
  for (const int after : {5, 40, 100, whole - 2}) {
    EvaluationLog part_log;
    std::atomic<int> runs = 0;
    const StagedResult part = run(2, part_log, &runs, [&] { return runs >= after; });
    EXPECT_TRUE(part.interrupted);
    const bool reports_only = after == 5, reports_so_far = after == whole - 2;
    EXPECT_EQ(part.best_fidelity == kReport, reports_only || reports_so_far);
    expect_same(one, run(2, part_log));
  }
}

/// Of outcomes without fields nothing is learned, and nothing breaks.
TEST(StagedSearch, FieldsThatAreMissingSometimesAreNoTrouble) {
  const SequenceFrame frame = frame_of(3, 3);
  const Evaluate whole = with_fields(frame);
  EvaluationLog log;
  const StagedResult result = staged_search(frame, options_with_fields(frame, 80, 2),
                                            make_batch_evaluate(
                                                [&](const Schedule& schedule, const std::string& fidelity) {
                                                  Outcome outcome = whole(schedule, fidelity);
                                                  if (fidelity == kReport || schedule_hash(schedule) % 3 == 0)
                                                    outcome.fields.clear();
                                                  return outcome;
                                                },
                                                log));
  EXPECT_TRUE(result.beats_baselines) << result.message;
}

/// A family of one schedule: every batch is known after the first.
TEST(StagedSearch, EndsWhereThereIsNothingNewToTry) {
  SequenceFrame frame = frame_of(2, 2);
  frame.longest_sequence = frame.shortest_stroke = 2;
  frame.options.preshape_height = frame.options.overtravel = 0;
  StagedOptions options;
  options.optimise.budget = 1e6;
  EvaluationLog log;
  const StagedResult result =
      staged_search(frame, options, make_batch_evaluate(synthetic(frame), log, options.threads));
  EXPECT_LE(result.evaluations, 40) << result.message;
}

}  // namespace
}  // namespace drapeplan
