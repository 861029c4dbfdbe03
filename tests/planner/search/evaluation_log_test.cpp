#include "planner/search/evaluation_log.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "mapping/error.hpp"
#include "planner/base/parallel.hpp"
#include "planner/score/scoring.hpp"
#include "planner/search/batch_evaluate.hpp"

namespace drapeplan {
namespace {

Schedule schedule_ending_at(double z) {
  return {{{{0, 0.1}, {1, z}}}, 0.1};
}

Outcome outcome_of(double objective) {
  Outcome outcome;
  outcome.score.valid = true;
  outcome.score.objective = objective;
  outcome.score.max_gap = objective / 3;
  outcome.summary.steps = 12345678901;
  outcome.summary.message = "end of the schedule";
  outcome.summary.state_hash = 0xfedcba9876543210ULL;
  outcome.wall_seconds = 0.25;
  return outcome;
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A fresh file name per test.
class EvaluationLogFile : public testing::Test {
 protected:
  EvaluationLogFile()
      : path_(testing::TempDir() + "drapeplan_" +
              testing::UnitTest::GetInstance()->current_test_info()->name() + ".jsonl") {
    std::filesystem::remove(path_);
  }
  ~EvaluationLogFile() override { std::filesystem::remove(path_); }
  std::string path_;
};

TEST(ScheduleHash, SeesEveryNumberButNotTheSignOfZero) {
  const Schedule a = schedule_ending_at(0.01);
  EXPECT_EQ(schedule_hash(a), schedule_hash(schedule_ending_at(0.01)));
  EXPECT_NE(schedule_hash(a), schedule_hash(schedule_ending_at(std::nextafter(0.01, 1))));
  Schedule b = a;
  b.blend_time = 0.2;
  EXPECT_NE(schedule_hash(a), schedule_hash(b));
  EXPECT_EQ(schedule_hash(schedule_ending_at(0.0)), schedule_hash(schedule_ending_at(-0.0)));
  EXPECT_NE(schedule_hash({{{{0, 1}}, {{0, 1}}}, 0}), schedule_hash({{{{0, 1}, {0, 1}}}, 0}));
}

TEST_F(EvaluationLogFile, KeepsFieldsToTheBit) {
  Outcome outcome = outcome_of(0.1);
  outcome.fields = {1.0f / 3, -0.0f, 1e-30f, 4e5f};
  EvaluationLog(path_, 42).write(schedule_hash(schedule_ending_at(0.01)), "screen", "wave", outcome);
  const std::vector<Evaluation> read = read_evaluations(path_);
  ASSERT_EQ(read.size(), 1u);
  ASSERT_EQ(read[0].outcome.fields.size(), outcome.fields.size());
  EXPECT_EQ(std::memcmp(read[0].outcome.fields.data(), outcome.fields.data(), 16), 0);
}

TEST_F(EvaluationLogFile, KeepsBothScoresOfAPressedPly) {
  for (const bool before : {true, false}) {
    std::filesystem::remove(path_);
    Outcome pressed = outcome_of(0.1);
    pressed.other = OtherScore{before, outcome_of(0.3).score};
    EvaluationLog(path_, 42).write(schedule_hash(schedule_ending_at(0.01)), "screen", "wave", pressed);
    const std::vector<Evaluation> read = read_evaluations(path_);
    ASSERT_EQ(read.size(), 1u);
    ASSERT_TRUE(read[0].outcome.other);
    EXPECT_EQ(read[0].outcome.other->before, before);
    EXPECT_EQ(read[0].outcome.other->score.max_gap, pressed.other->score.max_gap);
    EXPECT_EQ(read[0].outcome.score.max_gap, pressed.score.max_gap);
  }
}

TEST_F(EvaluationLogFile, ServesAKnownScheduleAfterReopeningToTheLastBit) {
  const double third = 1.0 / 3;
  {
    EvaluationLog log(path_, 42);
    for (const double z : {0.01, 0.02}) {
      const Outcome o = log.evaluate_once(schedule_hash(schedule_ending_at(z)), "screen",
                                          [&] { return outcome_of(z * third); });
      EXPECT_FALSE(o.cached);
      log.write(schedule_hash(schedule_ending_at(z)), "screen", "wave", o);
    }
  }
  EvaluationLog log(path_, 42);
  const auto must_not_run = []() -> Outcome { throw std::logic_error("ran"); };
  const Outcome o = log.evaluate_once(schedule_hash(schedule_ending_at(0.02)), "screen", must_not_run);
  EXPECT_TRUE(o.cached);
  EXPECT_TRUE(o.score.valid);
  EXPECT_EQ(o.score.objective, 0.02 * third);
  EXPECT_EQ(o.score.max_gap, 0.02 * third / 3);
  EXPECT_EQ(o.summary.steps, 12345678901);
  EXPECT_EQ(o.summary.state_hash, 0xfedcba9876543210ULL);
  EXPECT_EQ(o.summary.message, "end of the schedule");
  EXPECT_FALSE(
      log.evaluate_once(schedule_hash(schedule_ending_at(0.02)), "report", [] { return outcome_of(1); })
          .cached);
  log.write(schedule_hash(schedule_ending_at(0.02)), "report", "report", outcome_of(1));
  EXPECT_EQ(log.size(), 3);
  const auto lines = read_evaluations(path_);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[2].number, 3);
  EXPECT_EQ(lines[1].best_so_far, 0.01 * third);
  EXPECT_EQ(lines[2].best_so_far, 1);
}

TEST_F(EvaluationLogFile, KeepsFailuresWithAnyReasonAndAnyNumber) {
  {
    EvaluationLog log(path_, 1);
    Outcome failed = outcome_of(std::numeric_limits<double>::infinity());
    failed.score.valid = false;
    failed.score.reason = "not finite at node 812\n\xff";
    failed.summary.status = RunStatus::diverged;
    log.write(schedule_hash(schedule_ending_at(0)), "screen", "wave", failed);
  }
  EXPECT_EQ(EvaluationLog(path_, 1).size(), 1);
  const auto lines = read_evaluations(path_);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_FALSE(lines[0].outcome.score.valid);
  EXPECT_FALSE(std::isfinite(lines[0].outcome.score.objective));
  EXPECT_FALSE(std::isfinite(lines[0].best_so_far));
  EXPECT_EQ(lines[0].outcome.score.reason.substr(0, 23), "not finite at node 812\n");
  EXPECT_EQ(lines[0].outcome.summary.status, RunStatus::diverged);
}

TEST_F(EvaluationLogFile, CutsATornLastLineWhereverItIsTorn) {
  {
    EvaluationLog log(path_, 1);
    for (const double z : {0.0, 0.01})
      log.write(schedule_hash(schedule_ending_at(z)), "screen", "wave", outcome_of(z));
  }
  const std::string whole = text_of(path_);
  const size_t header = whole.find('\n') + 1, second = whole.find('\n', header) + 1;
  for (size_t length = 0; length <= whole.size(); length += 7) {
    put(path_, whole.substr(0, length));
    {
      EvaluationLog log(path_, 1);
      EXPECT_EQ(log.size(), length < second ? 0 : length < whole.size() ? 1 : 2);
      log.write(schedule_hash(schedule_ending_at(0.5)), "screen", "wave", outcome_of(5));
    }
    EXPECT_EQ(read_evaluations(path_).back().outcome.score.objective, 5);
  }
}

TEST_F(EvaluationLogFile, RefusesAnotherCaseABrokenLineOrAForeignFileAndLeavesItAlone) {
  {
    EvaluationLog log(path_, 1);
    for (const double z : {0.0, 0.01})
      log.write(schedule_hash(schedule_ending_at(z)), "screen", "wave", outcome_of(z));
  }
  const std::string whole = text_of(path_);
  std::string broken = whole;
  broken[broken.find('\n') + 3] = '\\';
  const std::string foreign = "my diary", foreign_line = "{\"format\": \"other\"}\n";
  for (const std::string& text : {broken, foreign, foreign_line}) {
    put(path_, text);
    EXPECT_THROW(EvaluationLog(path_, 1), WrongInput);
    EXPECT_THROW(read_evaluations(path_), WrongInput);
    EXPECT_EQ(text_of(path_), text);
  }
  put(path_, whole);
  EXPECT_THROW(EvaluationLog(path_, 2), WrongInput);
  EXPECT_THROW(read_evaluations(path_, 2), WrongInput);
  EXPECT_EQ(text_of(path_), whole);
  EXPECT_EQ(read_evaluations(path_, 1).size(), 2u);
  EXPECT_THROW(read_evaluations("/dev/null"), WrongInput) << "a device is no log";
}

TEST(EvaluationLog, RunsAScheduleOnceThoughManyThreadsAskForIt) {
  EvaluationLog log;
  std::atomic<int> runs = 0;
  parallel_for(
      64,
      [&](int i) {
        const Schedule schedule = schedule_ending_at(i % 4);
        log.evaluate_once(schedule_hash(schedule), "screen", [&] {
          ++runs;
          return outcome_of(i % 4);
        });
      },
      4);
  EXPECT_EQ(runs, 4);
}

TEST_F(EvaluationLogFile, ReadingLeavesATornLineWhereItIs) {
  {
    EvaluationLog log(path_, 1);
    for (const double z : {0.0, 0.01})
      log.write(schedule_hash(schedule_ending_at(z)), "screen", "wave", outcome_of(z));
  }
  const std::string torn = text_of(path_).substr(0, text_of(path_).size() - 9);
  put(path_, torn);
  EXPECT_EQ(read_evaluations(path_, 1).size(), 1u);
  EXPECT_EQ(text_of(path_), torn);
}

TEST_F(EvaluationLogFile, BatchEvaluateWritesABatchInItsOrderAndTurnsWhatAScheduleCannotDoIntoFailures) {
  const auto evaluate = [](const Schedule& schedule, const std::string&) {
    const double z = schedule.paths[0][1].z;
    double burn = 0;
    for (int i = 0; i < int(20000 * (5 - z)); ++i) burn += std::sqrt(double(i));  // the first take longest
    if (z == 2) throw WrongInput("no such mold");
    return outcome_of(z == 3 ? std::nan("") : z + 0 * burn);
  };
  std::vector<Schedule> schedules;
  for (const double z : {0.0, 1.0, 2.0, 3.0, 1.0, 4.0}) schedules.push_back(schedule_ending_at(z));
  for (const int threads : {1, 2, 4}) {
    std::filesystem::remove(path_);
    EvaluationLog log(path_, 1);
    const auto outcomes = make_batch_evaluate(evaluate, log, threads)(schedules, "screen", "gripper");
    ASSERT_EQ(outcomes.size(), 6u);
    EXPECT_EQ(outcomes[1].score.objective, 1);
    EXPECT_EQ(outcomes[4].score.objective, 1);
    EXPECT_TRUE(outcomes[4].cached);
    EXPECT_EQ(outcomes[2].score.reason, "no such mold");
    EXPECT_EQ(outcomes[2].score.objective, kFailedObjective);
    EXPECT_FALSE(outcomes[3].score.valid);
    EXPECT_EQ(outcomes[3].score.objective, kFailedObjective);
    const auto lines = read_evaluations(path_);
    ASSERT_EQ(lines.size(), 5u);
    const int order[] = {0, 1, 2, 3, 5};
    for (size_t k = 0; k < 5; ++k) {
      EXPECT_EQ(lines[k].number, int(k) + 1);
      EXPECT_EQ(lines[k].schedule_hash, schedule_hash(schedules[size_t(order[k])]));
      EXPECT_EQ(lines[k].best_so_far, 0);
    }
  }
}

TEST_F(EvaluationLogFile, ABugInAnEvaluationPassesAndIsNoFailedSchedule) {
  std::atomic<int> runs = 0;
  const auto evaluate = [&runs](const Schedule& schedule, const std::string&) {
    if (schedule.paths[0][1].z == 1 && ++runs == 1) throw std::logic_error("index out of range");
    return outcome_of(schedule.paths[0][1].z);
  };
  const std::vector<Schedule> schedules{schedule_ending_at(0), schedule_ending_at(1)};
  EvaluationLog log(path_, 1);
  const BatchEvaluate batch = make_batch_evaluate(evaluate, log, 2);
  EXPECT_THROW(batch(schedules, "screen", "gripper"), std::logic_error);
  EXPECT_EQ(read_evaluations(path_).size(), 1u);
  EXPECT_EQ(batch(schedules, "screen", "gripper")[1].score.objective, 1) << "nobody waits for it for ever";
}

TEST(ParallelFor, RunsEveryIndexOnceAndThrowsTheFirstException) {
  std::vector<int> hits(100, 0);
  const auto body = [&](int i) {
    ++hits[size_t(i)];
    if (i == 70 || i == 30) throw std::runtime_error(std::to_string(i));
  };
  try {
    parallel_for(100, body, 3);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "30");
  }
  for (const int hit : hits) EXPECT_EQ(hit, 1);
}

}  // namespace
}  // namespace drapeplan
