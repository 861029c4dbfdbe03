// From "evaluate one schedule" to "evaluate a batch": parallel, cached, logged; a bad candidate is a score.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "planner/drape/problem.hpp"
#include "planner/search/evaluation_log.hpp"

namespace drapeplan {

/// What a search keeps of a drape.
Outcome outcome_of(const Drape& drape);

/// What a candidate cannot do is a score with a reason, and so is an objective that is not finite. All else
/// that is thrown passes: no memory, or a bug.
Outcome scored(const std::function<Outcome()>& run);

/// One simulation and its score. WrongInput and NotFinished are failed outcomes; whatever else it throws (no
/// memory, a bug) ends the batch. Safe to call concurrently.
using Evaluate = std::function<Outcome(const Schedule& schedule, const std::string& fidelity)>;

/// Runs that a plan makes beside its search: what they may take, and whose they are.
struct SideRuns {
  double seconds = 0;        ///< that all may take side by side [s]; 0: no limit
  std::uint64_t design = 0;  ///< of the rig, see candidate_hash
  int threads = 0;
  std::function<bool()> stop = {};  ///< asked before each run; may be empty
};

/// All that an optimiser sees. Outcomes in the order of the schedules. Safe to call concurrently.
using BatchEvaluate = std::function<std::vector<Outcome>(
    const std::vector<Schedule>& schedules, const std::string& fidelity, const std::string& stage)>;

/// Wraps `evaluate`: repeated schedules are served by the log, bad schedules and non-finite objectives
/// become failed outcomes, new outcomes are written to the log. Within a batch lines are written in the order
/// of the batch, each as soon as all before it are finished: a killed run loses at most the few that
/// overtook. Batches of concurrent callers interleave in the order of their completion.
/// @param log  outlives the returned function.
/// @param design  of the rig that schedules are played on, see candidate_hash.
/// @param stop  asked before each run; may be empty. Once it says true, what runs is finished and logged, and
/// the batch throws Interrupted.
BatchEvaluate make_batch_evaluate(Evaluate evaluate, EvaluationLog& log, int threads = 0,
                                  std::uint64_t design = 0, std::function<bool()> stop = {});
/// Of runs beside a search; their time is not looked at.
BatchEvaluate make_batch_evaluate(Evaluate evaluate, EvaluationLog& log, const SideRuns& runs);

}  // namespace drapeplan
