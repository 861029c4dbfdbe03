// The search for a better draping sequence, in stages: waves, then every gripper, then a fair comparison.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "planner/drape/strategy.hpp"
#include "planner/search/batch_evaluate.hpp"

namespace drapeplan {

struct StagedOptions {
  OptimiseOptions optimise;
  std::string wave_fidelity = "screen";
  std::string gripper_fidelity = "screen";  ///< finalists are compared at kReport
  Eigen::VectorXd wave = {};                ///< one more wave to start from, in coordinates; empty: none
  int threads = 0;                          ///< 0: OpenMP's default; does not change the result
};

/// A schedule and what it is worth.
struct Candidate {
  std::string name;  ///< "uniform", "wave", or the stage it is from and its number there, e.g. "gripper 113"
  Schedule schedule;
  Outcome outcome;
};

/// One evaluation as the search saw it. Searches that run side by side are listed in turns.
struct HistoryEntry {
  int number = 0;  ///< from 1
  std::string stage;
  std::string fidelity;
  std::uint64_t schedule_hash = 0;
  double objective = 0;
  bool valid = false;
  double best_so_far = 0;  ///< lowest valid objective at this fidelity; infinite if there is none
};

struct StagedResult {
  Candidate uniform, wave;           ///< the baselines, at the reporting fidelity
  Candidate best;                    ///< the best at the reporting fidelity; a baseline if nothing beats them
  std::vector<Candidate> finalists;  ///< all that were re-evaluated, best first, baselines included
  bool beats_baselines = false;
  std::string message;  ///< the outcome in a sentence
  std::vector<HistoryEntry> history;
  int evaluations = 0;  ///< different (schedule, fidelity) pairs
  int failed_evaluations = 0;
};

struct Progress {
  std::string stage;
  int done = 0, planned = 0;  ///< evaluations; `planned` is an upper bound
  double best = 0;            ///< lowest valid objective at the stage's fidelity; infinite if there is none
  double seconds_left = 0;    ///< estimate from the mean run time per fidelity; NaN before the first run
};

/// Minimises the objective over schedules in three stages.
/// 1 wave     screens the baselines and up to nine waves, then NLopt from the best of them;
/// 2 gripper  CMA-ES over the starts of all grippers' strokes and one factor on their durations, with a small
///            first step, from the best of stage 1. On synthetic objectives, also one that asks for different
///            durations, one common factor came closer with up to 750 evaluations than a duration for each;
/// 3 report   the baselines, the best few different schedules and the centre of the last search distribution
///            are evaluated at the reporting fidelity; the best there wins.
/// The result depends on frame, options and evaluate only: not on threads, nor on what was served from a log.
/// @param evaluate  safe to call concurrently.
/// @param progress  called after each evaluation, one call at a time, from any thread; may be empty.
StagedResult staged_search(const SequenceFrame& frame, const StagedOptions& options,
                           const BatchEvaluate& evaluate,
                           const std::function<void(const Progress&)>& progress = {});

}  // namespace drapeplan
