#include "planner/search/batch_evaluate.hpp"

#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "mapping/error.hpp"
#include "planner/base/parallel.hpp"
#include "planner/score/scoring.hpp"
#include "planner/search/interrupted.hpp"

namespace drapeplan {
namespace {

Outcome failed(Outcome outcome, const std::string& reason) {
  outcome.score = failed_score(reason);
  return outcome;
}

/// Per schedule the index of the first equal one: equal schedules of one batch must not race for who runs.
std::vector<size_t> first_occurrences(const std::vector<Schedule>& schedules) {
  std::map<std::uint64_t, size_t> seen;
  std::vector<size_t> first;
  for (size_t k = 0; k < schedules.size(); ++k) {
    first.push_back(seen.try_emplace(schedule_hash(schedules[k]), k).first->second);
  }
  return first;
}

}  // namespace

Outcome outcome_of(const Drape& drape) {
  return {.score = drape.score,
          .other = drape.other,
          .summary = drape.run.summary,
          .wall_seconds = drape.run.summary.wall_seconds};
}

Outcome scored(const std::function<Outcome()>& run) {
  try {
    Outcome outcome = run();
    if (outcome.score.valid && !std::isfinite(outcome.score.objective)) {
      return failed(std::move(outcome), "the objective is not finite");
    }
    return outcome;
  } catch (const WrongInput& error) {
    return failed({}, error.what());
  } catch (const NotFinished& error) {
    return failed({}, error.what());
  }
}

BatchEvaluate make_batch_evaluate(Evaluate evaluate, EvaluationLog& log, int threads, std::uint64_t design,
                                  std::function<bool()> stop) {
  return [evaluate = std::move(evaluate), &log, threads, design, stop = std::move(stop)](
             const std::vector<Schedule>& schedules, const std::string& fidelity, const std::string& stage) {
    const std::vector<size_t> first = first_occurrences(schedules);
    std::vector<Outcome> outcomes(schedules.size());
    std::vector<char> finished(schedules.size(), 0);
    size_t written = 0;
    std::mutex order;
    const auto one = [&](int i) {
      const auto k = size_t(i);
      if (stop && stop()) throw Interrupted();
      if (first[k] == k) {
        const auto run = [&] { return scored([&] { return evaluate(schedules[k], fidelity); }); };
        outcomes[k] = log.evaluate_once(candidate_hash(design, schedules[k]), fidelity, run);
      }
      const std::scoped_lock lock(order);
      finished[k] = 1;
      for (; written < schedules.size() && finished[written]; ++written) {
        if (first[written] != written || outcomes[written].cached) continue;
        log.write(candidate_hash(design, schedules[written]), fidelity, stage, outcomes[written]);
      }
    };
    parallel_for(int(schedules.size()), one, threads);
    for (size_t k = 0; k < schedules.size(); ++k) {
      if (first[k] == k) continue;
      outcomes[k] = outcomes[first[k]];
      outcomes[k].cached = true;
    }
    return outcomes;
  };
}

BatchEvaluate make_batch_evaluate(Evaluate evaluate, EvaluationLog& log, const SideRuns& runs) {
  return make_batch_evaluate(std::move(evaluate), log, runs.threads, runs.design, runs.stop);
}

}  // namespace drapeplan
