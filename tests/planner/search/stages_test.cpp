#include "planner/search/stages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "mapping/error.hpp"
#include "planner/drape/problem.hpp"
#include "planner/search/finalists.hpp"
#include "planner/search/interrupted.hpp"
#include "tests/planner/search/stages_kit.hpp"

namespace drapeplan {
namespace {

StagedResult search(const SequenceFrame& frame, const StagedOptions& options, EvaluationLog& log,
                    std::atomic<int>* runs = nullptr) {
  return staged_search(frame, options, make_batch_evaluate(synthetic(frame, runs), log, options.threads));
}

TEST(StagedSearch, BeatsBothBaselinesAndComesNearTheOptimum) {
  const SequenceFrame frame = frame_of(5, 5);
  EvaluationLog log;
  const StagedResult result = search(frame, options_of(600), log);
  EXPECT_TRUE(result.beats_baselines) << result.message;
  const double uniform = deviation(frame, result.uniform.schedule);
  const double wave = deviation(frame, result.wave.schedule);
  const double best = deviation(frame, result.best.schedule);
  RecordProperty("uniform", std::to_string(uniform));
  RecordProperty("wave", std::to_string(wave));
  RecordProperty("best", std::to_string(best));
  EXPECT_LE(best, 0.15 * std::min(uniform, wave));
  EXPECT_LE(result.best.outcome.score.objective, result.wave.outcome.score.objective);
  EXPECT_GT(result.failed_evaluations, 0);
}

TEST(StagedSearch, ResultDoesNotDependOnTheNumberOfThreads) {
  const SequenceFrame frame = frame_of(3, 3);
  StagedOptions one = options_of(140), two = options_of(140);
  one.threads = 1;
  two.threads = 2;
  EvaluationLog log_one, log_two;
  const StagedResult a = search(frame, one, log_one);
  expect_same(a, search(frame, two, log_two));
  EXPECT_EQ(log_one.size(), a.evaluations);
  EXPECT_EQ(log_two.size(), log_one.size());
}

TEST(StagedSearch, ResumedFromATornLogGivesTheSameResultWithoutRunningAgain) {
  const SequenceFrame frame = frame_of(3, 3);
  const StagedOptions options = options_of(140);
  const std::string path = testing::TempDir() + "drapeplan_staged_resume.jsonl";
  std::filesystem::remove(path);
  std::atomic<int> first_runs = 0, resumed_runs = 0, third_runs = 0;
  StagedResult whole;
  {
    EvaluationLog log(path, 9);
    whole = search(frame, options, log, &first_runs);
  }
  EXPECT_EQ(first_runs, whole.evaluations);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  {
    EvaluationLog log(path, 9);
    const int kept = log.size();
    EXPECT_GT(kept, 0);
    expect_same(whole, search(frame, options, log, &resumed_runs));
    EXPECT_EQ(resumed_runs, first_runs - kept);
  }
  EvaluationLog log(path, 9);
  expect_same(whole, search(frame, options, log, &third_runs));
  EXPECT_EQ(third_runs, 0);
  std::filesystem::remove(path);
}

TEST(StagedSearch, SaysSoWhenNothingBeatsTheBaselines) {
  const SequenceFrame frame = frame_of(3, 3);
  const std::uint64_t favourite = schedule_hash(to_schedule(frame, uniform_strokes(frame)));
  EvaluationLog log;
  const Evaluate evaluate = [&](const Schedule& schedule, const std::string& fidelity) {
    Outcome outcome;
    outcome.score.valid = true;
    const double lie = fidelity == "screen" ? -1 : 1;  // the screen prefers what the report does not
    outcome.score.objective = 10 + lie * (schedule_hash(schedule) == favourite ? 0 : 1);
    return outcome;
  };
  const StagedResult result = staged_search(frame, options_of(60), make_batch_evaluate(evaluate, log));
  EXPECT_FALSE(result.beats_baselines);
  EXPECT_EQ(result.best.name, "uniform");
  EXPECT_NE(result.message.find("nothing found beats the baselines"), std::string::npos) << result.message;
}

TEST(StagedSearch, EndsWithAMessageWhenEverythingFails) {
  const SequenceFrame frame = frame_of(3, 3);
  EvaluationLog log;
  const Evaluate never = [](const Schedule&, const std::string&) -> Outcome { throw NotFinished("no"); };
  const StagedResult result = staged_search(frame, options_of(60), make_batch_evaluate(never, log));
  EXPECT_FALSE(result.beats_baselines);
  EXPECT_EQ(result.failed_evaluations, result.evaluations);
  EXPECT_NE(result.message.find("no schedule could be evaluated"), std::string::npos) << result.message;
}

TEST(StagedSearch, SmallBudgetsAreKeptToAGeneration) {
  const SequenceFrame frame = frame_of(3, 3);
  for (const int budget : {1, 5, 13, 40}) {
    EvaluationLog log;
    const StagedResult result = search(frame, options_of(budget), log);
    constexpr int kBatch = 4, kReports = 2 + 4 + 1;
    EXPECT_LE(int(result.history.size()), std::max(budget, 2) + kBatch + kReports);
    EXPECT_TRUE(result.uniform.outcome.score.valid && result.wave.outcome.score.valid);
  }
}

TEST(StagedSearch, ProgressCountsUpToThePlan) {
  const SequenceFrame frame = frame_of(3, 3);
  EvaluationLog log;
  int last = 0;
  const StagedResult result = staged_search(frame, options_of(80), make_batch_evaluate(synthetic(frame), log),
                                            [&](const Progress& p) {
                                              EXPECT_GT(p.done, last);
                                              EXPECT_LE(p.done, p.planned);
                                              last = p.done;
                                            });
  EXPECT_EQ(last, int(result.history.size()));
}

/// What is counted is the clock of the log: a search that is served takes the same turns.
TEST(StagedSearch, WithABudgetOfTimeEndsInTimeAndIsServedAgainAsItWas) {
  const SequenceFrame frame = frame_of(3, 3);
  StagedOptions options;
  options.optimise.budget = 2;
  const Evaluate quick = synthetic(frame);
  std::atomic<int> runs = 0;
  const Evaluate slow = [&](const Schedule& schedule, const std::string& fidelity) {
    ++runs;
    std::this_thread::sleep_for(std::chrono::milliseconds(fidelity == kReport ? 100 : 5));
    Outcome outcome = quick(schedule, fidelity);
    outcome.wall_seconds = fidelity == kReport ? 0.1 : 0.005;
    return outcome;
  };
  const std::string path = testing::TempDir() + "drapeplan_staged_time.jsonl";
  std::filesystem::remove(path);
  StagedResult first;
  {
    EvaluationLog log(path, 9);
    first = staged_search(frame, options, make_batch_evaluate(slow, log));
    EXPECT_LE(log.elapsed(), 4) << "twice the budget: the machine may be busy";
  }
  EXPECT_GE(first.evaluations, 30);
  const int before = runs;
  EvaluationLog log(path, 9);
  expect_same(first, staged_search(frame, options, make_batch_evaluate(slow, log)));
  EXPECT_EQ(runs, before);
  std::filesystem::remove(path);
}

TEST(StagedSearch, InterruptedAtAnyMomentItKeepsTheBestAndGoesOnToTheSameEnd) {
  const SequenceFrame frame = frame_of(3, 3);
  const StagedOptions options = options_of(140);
  EvaluationLog whole_log;
  const StagedResult whole = search(frame, options, whole_log);
  for (const int after : {3, 20, 90, 150}) {
    EvaluationLog log;
    std::atomic<int> runs = 0;
    const auto stop = [&] { return runs >= after; };
    const StagedResult part =
        staged_search(frame, options, make_batch_evaluate(synthetic(frame, &runs), log, 2, 0, stop));
    const bool ended = whole.evaluations <= after;
    EXPECT_EQ(part.interrupted, !ended);
    EXPECT_LE(runs, after + 1) << "what runs is finished";
    EXPECT_EQ(log.size(), runs) << "and kept";
    EXPECT_FALSE(part.best.schedule.paths.empty());
    EXPECT_NE(part.message.find("--resume"), ended ? 0 : std::string::npos) << part.message;
    expect_same(whole, search(frame, options, log));
  }
  EvaluationLog log;
  const auto at_once = [] { return true; };
  EXPECT_THROW(staged_search(frame, options, make_batch_evaluate(synthetic(frame), log, 1, 0, at_once)),
               Interrupted);
}

TEST(StagedSearch, ASequenceThatTheRigDoesNotFollowIsNoCandidate) {
  const SequenceFrame frame = frame_of(3, 3);
  const std::uint64_t uniform = schedule_hash(to_schedule(frame, uniform_strokes(frame)));
  const auto evaluate = [&](bool any) {
    return [&frame, uniform, any, quick = synthetic(frame)](const Schedule& schedule,
                                                            const std::string& fidelity) {
      Outcome outcome = quick(schedule, fidelity);
      outcome.score.followed = any && schedule_hash(schedule) == uniform;
      return outcome;
    };
  };
  EvaluationLog log, other;
  const StagedResult followed =
      staged_search(frame, options_of(60), make_batch_evaluate(evaluate(true), log));
  EXPECT_EQ(followed.best.name, "uniform");
  ASSERT_EQ(unbeaten(followed.finalists).size(), 1u);
  EXPECT_NE(followed.message.find("nothing found beats"), std::string::npos) << followed.message;
  const StagedResult none = staged_search(frame, options_of(60), make_batch_evaluate(evaluate(false), other));
  EXPECT_NE(none.message.find("no schedule was followed"), std::string::npos) << none.message;
  EXPECT_TRUE(unbeaten(none.finalists).empty());
}

TEST(StagedSearch, WhatIsFollowedBeatsWhatIsNotAndWhatFailsBeatsNothing) {
  const SequenceFrame frame = frame_of(3, 3);
  const std::uint64_t uniform = schedule_hash(to_schedule(frame, uniform_strokes(frame)));
  const std::uint64_t wave = schedule_hash(to_schedule(frame, wave_strokes(frame)));
  EvaluationLog log, other;
  const Evaluate baselines_lag = [&](const Schedule& schedule, const std::string&) {
    const std::uint64_t hash = schedule_hash(schedule);
    Outcome outcome;
    outcome.score.valid = true;
    outcome.score.followed = hash != uniform && hash != wave;
    outcome.score.objective = outcome.score.followed ? 22 : 20;
    return outcome;
  };
  const StagedResult better = staged_search(frame, options_of(40), make_batch_evaluate(baselines_lag, log));
  EXPECT_TRUE(better.beats_baselines);
  EXPECT_EQ(better.best.outcome.score.objective, 22);
  EXPECT_NE(better.message.find("does not follow the baselines"), std::string::npos) << better.message;
  const Evaluate lags_or_fails = [&](const Schedule& schedule, const std::string&) -> Outcome {
    if (schedule_hash(schedule) == wave) throw NotFinished("not finite");
    Outcome outcome;
    outcome.score.valid = true;
    outcome.score.followed = false;
    outcome.score.objective = 20;
    return outcome;
  };
  const StagedResult lags = staged_search(frame, options_of(40), make_batch_evaluate(lags_or_fails, other));
  EXPECT_TRUE(lags.best.outcome.score.valid) << lags.message;
}

TEST(Unbeaten, HoldsWhatNoOtherBeatsInGapOffsetAndDuration) {
  const auto candidate = [](std::string name, double gap, double offset, double duration) {
    Candidate c{.name = std::move(name), .schedule = {}, .outcome = {}};
    c.outcome.score.valid = true;
    c.outcome.score.max_gap = gap;
    c.outcome.score.max_boundary_offset = offset;
    c.outcome.score.duration = duration;
    return c;
  };
  std::vector<Candidate> all{candidate("slow", 2, 2, 12),  candidate("quick", 5, 5, 4),
                             candidate("worse", 3, 2, 12), candidate("same", 2, 2, 12),
                             candidate("edge", 1, 9, 12),  candidate("not followed", 0, 0, 0),
                             candidate("failed", 0, 0, 0)};
  all[5].outcome.score.followed = false;
  all[6].outcome.score.valid = false;
  std::vector<std::string> names;
  for (const Candidate* c : unbeaten(all)) names.push_back(c->name);
  EXPECT_EQ(names, (std::vector<std::string>{"edge", "slow", "quick"}));
}

}  // namespace
}  // namespace drapeplan
