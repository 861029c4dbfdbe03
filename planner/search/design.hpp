// The search over fields of the case together with the schedule: which rig would drape better.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "planner/drape/problem.hpp"
#include "planner/search/evaluation_log.hpp"
#include "planner/search/stages.hpp"

namespace drapeplan {

/// One field that was changed, and what that brought.
struct DesignChange {
  std::string path;
  std::string before, after;  ///< as written in a case; "null": absent
  Outcome without;            ///< the best schedule at the reporting fidelity, this field alone as it was
};

/// The case with its design, and how it was found.
struct DesignResult {
  std::shared_ptr<const DrapeProblem> problem;  ///< the changed case, made ready
  std::vector<std::string> overrides;           ///< `path=value`, in the order of the variables
  Eigen::VectorXd wave;                         ///< that went with it, in coordinates of `WaveFamily`
  std::vector<DesignChange> changes;
  int evaluations = 0;  ///< different candidates
};

/// What tells candidates apart that have the same schedule on different rigs.
std::uint64_t design_hash(const std::vector<std::string>& overrides);

/// CMA-ES over all design variables and the six numbers of `WaveFamily` together, at a cheap fidelity. Every
/// candidate is a case of its own: mapped anew, with a model of its own. One that is no good case, or cannot
/// be mapped, is a failed candidate. The result depends on the case only, not on threads.
/// @param progress  called after each generation with the number of candidates so far and the best objective.
/// @param stop  asked before each candidate; may be empty. Once it says true, what runs is finished and
/// logged.
/// @throws NotFinished if no candidate could be evaluated, Interrupted if it was stopped.
DesignResult search_design(const DrapeProblem& base, const std::string& fidelity, EvaluationLog& log,
                           int threads, const std::function<void(int, double)>& progress = {},
                           const std::function<bool()>& stop = {});

/// Fills `design.changes`: for each variable, the schedule on the changed rig with this variable as it was in
/// `base`. Heights of the schedule follow the targets.
void compare_changes(const DrapeProblem& base, const Schedule& best, EvaluationLog& log, int threads,
                     DesignResult& design);

}  // namespace drapeplan
