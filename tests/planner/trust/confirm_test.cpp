// The winner one fidelity above the reporting one: what is played, what it costs, what may be said.
#include "planner/trust/confirm.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planner/search/batch_evaluate.hpp"
#include "planner/trust/claim.hpp"
#include "tests/planner/trust/coarse_case.hpp"

namespace drapeplan {
namespace {

/// A search that ended with the wave.
StagedResult ended(const DrapeProblem& problem) {
  const auto candidate = [&](const char* name, const Strokes& strokes) {
    Candidate one{name, to_schedule(problem.frame(), strokes), {}};
    one.outcome = outcome_of(problem.run(one.schedule, kReport));
    return one;
  };
  StagedResult search;
  search.uniform = candidate("uniform", uniform_strokes(problem.frame()));
  search.wave = candidate("wave", wave_strokes(problem.frame()));
  search.best = search.wave;
  search.best_fidelity = kReport;
  return search;
}

TEST(Confirmation, PlaysBothOnFinerCellsAndSlower) {
  const DrapeProblem problem(coarse_case());
  const StagedResult search = ended(problem);
  EvaluationLog log, other;
  const Confirmation one = confirm(problem, search, {.threads = 1}, log).value();
  const FemOptions& report = problem.definition().fidelities.at(kReport);
  EXPECT_NEAR(one.options.mesh_size, report.mesh_size / 1.5, 1e-15);
  EXPECT_NEAR(one.options.time_scaling, report.time_scaling / 2, 1e-15);
  EXPECT_EQ(one.reported.objective, search.wave.outcome.score.objective);
  EXPECT_NE(one.finer.objective, one.reported.objective);
  EXPECT_EQ(one.error(&Score::max_gap), std::abs(one.finer.max_gap - one.reported.max_gap));
  EXPECT_EQ(log.size(), 2);
  EXPECT_EQ(confirmation_json(one),
            confirmation_json(confirm(problem, search, {.threads = 2}, other).value()));
  confirm(problem, search, {.threads = 1}, log);
  EXPECT_EQ(log.size(), 2) << "all was served from the log";
}

TEST(Confirmation, TakesWhatThereIsTimeFor) {
  const DrapeProblem problem(coarse_case());
  StagedResult search = ended(problem);
  search.best.outcome.wall_seconds = search.uniform.outcome.wall_seconds = search.wave.outcome.wall_seconds =
      10;
  EvaluationLog log;
  const auto with = [&](double seconds, int threads) {
    return confirm(problem, search, {.seconds = seconds, .threads = threads}, log);
  };
  const FemOptions& report = problem.definition().fidelities.at(kReport);
  EXPECT_FALSE(with(15, 2).has_value());
  EXPECT_EQ(with(20.1, 2)->options.mesh_size, report.mesh_size) << "twice the time";
  EXPECT_FALSE(with(20.1, 1).has_value()) << "one after the other";
  EXPECT_EQ(with(34, 2)->options.time_scaling, report.time_scaling) << "1.5^3 the time";
  EXPECT_LT(with(68, 2)->options.time_scaling, report.time_scaling);
  EXPECT_EQ(confirm_seconds(report, 10, {.seconds = 15, .threads = 2}), 0);
  EXPECT_EQ(confirm_seconds(report, 10, {.seconds = 30, .threads = 2}), 20);
  EXPECT_NEAR(confirm_seconds(report, 10, {.seconds = 60, .threads = 2}), 33.75, 1e-9);
  search.best_fidelity = "screen";
  EXPECT_FALSE(with(0, 2).has_value()) << "there is no winner at the reporting fidelity";
}

TEST(Confirmation, OfAGainNeedsMoreThanItsError) {
  const auto confirmation = [](double best, double baseline) {
    Confirmation one;
    one.reported.objective = 20, one.reported_baseline.objective = 24;
    one.finer.objective = best, one.finer_baseline.objective = baseline;
    one.reported.valid = one.reported_baseline.valid = one.finer.valid = one.finer_baseline.valid = true;
    return one;
  };
  // Both may be wrong, to the same side.
  EXPECT_TRUE(confirmation(25, 29).confirmed());
  EXPECT_TRUE(confirmation(20, 23).confirmed());
  EXPECT_TRUE(confirmation(20, 40).confirmed()) << "a larger gain is no doubt of a gain";
  EXPECT_FALSE(confirmation(20, 21).confirmed());
  EXPECT_FALSE(confirmation(20, 19).confirmed());
  StagedResult search;
  search.beats_baselines = true;
  search.message = "as it was";
  claim_confirmed(confirmation(20, 23), search);
  EXPECT_TRUE(search.beats_baselines);
  EXPECT_EQ(search.message, "as it was");
  claim_confirmed(confirmation(20, 21), search);
  EXPECT_FALSE(search.beats_baselines);
  EXPECT_NE(search.message.find("no better than the baselines as far as a finer run shows"),
            std::string::npos);
  search.beats_baselines = true;
  Confirmation failed = confirmation(20, 30);
  failed.finer = {};
  failed.finer.reason = "thrown";
  EXPECT_FALSE(failed.confirmed());
  claim_confirmed(failed, search);
  EXPECT_FALSE(search.beats_baselines);
  EXPECT_NE(search.message.find("it fails: thrown"), std::string::npos) << search.message;
  EXPECT_TRUE(confirmation_json(failed)["errors"]["max_gap"].is_null());
  // Where neither can be played nothing is known, and where the baseline alone fails the winner is better.
  search.beats_baselines = true;
  failed.finer_baseline = {};
  claim_confirmed(failed, search);
  EXPECT_TRUE(search.beats_baselines);
  failed.finer = confirmation(20, 30).finer;
  EXPECT_TRUE(failed.confirmed());
  // The rig must follow it there, too.
  Confirmation late = confirmation(20, 23);
  late.finer.followed = false;
  claim_confirmed(late, search);
  EXPECT_FALSE(search.beats_baselines);
}

}  // namespace
}  // namespace drapeplan
