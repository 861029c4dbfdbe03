// What a plan does once its search has ended: who wins, one fidelity above, in plants that differ, what may
// be claimed.
#pragma once

#include <functional>

#include "planner/search/plan.hpp"
#include "planner/trust/claim.hpp"

namespace drapeplan {

/// Shares of a budget of time that the two runs one fidelity above may take, and the runs in disturbed plants
/// of each schedule that is compared there.
inline constexpr double kConfirmShare = 0.1, kSpreadShare = 0.05;
/// So many schedules are compared in disturbed plants where these decide (`optimise.choose`).
inline constexpr int kRobustCandidates = 3;

/// Runs of a plan after its search that may take a share of its budget.
SideRuns runs_after_search(double share, const OptimiseOptions& optimise, const PlanResult& result,
                           const PlanOptions& options);

/// What of the budget a search leaves for all of this [s].
/// @param each  what a run at the reporting fidelity takes [s].
double seconds_after_search(const Case& definition, double each, int threads);

/// Where `optimise.choose` says so, and there is time, the best of the search becomes the finalist that does
/// best in disturbed plants. Then it is confirmed, claims are checked against errors, and its spread is
/// found.
/// @param given  the problem of the plan.  @param result  of a search that was not interrupted, with a
/// winner.
/// @throws Interrupted; what is known by then is in `result` and `trust`.
void look_closer(const DrapeProblem& given, EvaluationLog& log, const PlanOptions& options,
                 const std::function<void(const Progress&)>& progress, PlanResult& result, PlanTrust& trust);

}  // namespace drapeplan
