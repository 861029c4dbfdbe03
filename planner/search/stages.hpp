// The search for a better draping sequence, in stages: waves, smooth strokes, every gripper, a fair
// comparison.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "planner/method/composite.hpp"
#include "planner/schedule/strategy.hpp"
#include "planner/search/batch_evaluate.hpp"
#include "planner/search/budget.hpp"

namespace drapeplan {

/// What of a budget of time a search leaves for what comes after it [s], where a run at the reporting
/// fidelity takes `each` [s]: asked once the baselines have run. Empty: nothing.
using KeptTime = std::function<double(double each)>;

struct StagedOptions {
  OptimiseOptions optimise;
  /// Fidelities that are searched, cheapest first; finalists are compared at kReport.
  std::vector<std::string> ladder = {"screen"};
  /// What an objective is made of, and by how much fields differ (see ScoreFields); without, the search
  /// learns from objectives alone.
  ObjectiveNear objective_near = {};
  Eigen::VectorXd field_scale = {};
  Eigen::VectorXd wave = {};  ///< one more wave to start from, in coordinates; empty: none
  KeptTime kept = {};
  int threads = 0;            ///< 0: OpenMP's default; does not change the result
};

/// A schedule and what it is worth.
struct Candidate {
  std::string name;  ///< "uniform", "wave", or the stage it is from and its number there, e.g. "gripper 113"
  Schedule schedule;
  Outcome outcome;
  Strokes strokes = {};  ///< that the schedule is made of
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
  Candidate uniform, wave;  ///< the baselines, at the reporting fidelity
  /// The best at the reporting fidelity whose commands were followed; a baseline if nothing beats them. Of an
  /// interrupted search the best at the finest fidelity so far.
  Candidate best;
  std::string best_fidelity;
  std::vector<Candidate> finalists;  ///< all that were re-evaluated, best first, baselines included
  bool beats_baselines = false;
  bool interrupted = false;
  std::string message;  ///< the outcome in a sentence
  std::vector<HistoryEntry> history;
  int evaluations = 0;  ///< different (schedule, fidelity) pairs
  int failed_evaluations = 0;
};

/// Minimises the objective over schedules.
/// 1 baseline  both are evaluated at the reporting fidelity: what is to be beaten, and what a report costs;
/// 2 wave      screens up to nine waves at the cheapest fidelity (`ladder`);
/// 3 smooth    NLopt's COBYLA over StrokeFamily with smooth starts and heights, from the best waves; then
///             CompositeSearch over the same, which knows all evaluations so far;
/// 4 gripper   CompositeSearch over a start and a height of each gripper. It climbs from the cheapest fidelity
///             to the finest, when the ranks of a few schedules at both no longer agree, or when the share of
///             the cheaper one is spent; what it knows from the cheaper ones it keeps.
///             What it seeks is what will be best at the next one, as far as schedules that were seen at both
///             tell; for the reporting fidelity these are the best two after three quarters of the budget;
/// 5 report    the best of that, then what the model expects to be best there, are evaluated at the reporting
///             fidelity; the best there wins.
/// The result depends on frame, options and evaluate only: not on threads, nor on what was served from a log.
/// Where the budget is a time, it depends on the clock of the log, too.
/// @param evaluate  safe to call concurrently. Once it throws Interrupted, the search ends with what it has.
/// @param progress  called after each batch of evaluations; may be empty.
/// @throws Interrupted before the baselines are known.
StagedResult staged_search(const SequenceFrame& frame, const StagedOptions& options,
                           const BatchEvaluate& evaluate,
                           const std::function<void(const Progress&)>& progress = {});

}  // namespace drapeplan
