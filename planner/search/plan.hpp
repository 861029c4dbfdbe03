// The main job: map, check reach, evaluate the baselines, optimise, re-evaluate at the reporting fidelity.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "planner/drape/problem.hpp"
#include "planner/search/stages.hpp"

namespace drapeplan {

struct PlanOptions {
  std::filesystem::path out;  ///< run directory; made if absent
  bool resume = false;        ///< continue from the evaluations that the run directory holds
  int threads = 0;            ///< 0: one per core
};

/// What a plan run found; files are written by `write_plan` (planner/report/run_files.hpp).
struct PlanResult {
  StagedResult search;
  Drape uniform, wave, best;  ///< at the reporting fidelity, with frames
  double wall_seconds = 0;
};

/// Fidelities that a plan of the case runs: of the wave's search, of the grippers' search, of reports.
std::array<std::string, 3> plan_fidelities(const Case& definition);

/// Searches for the best schedule of the problem. The result depends on the case only: not on threads, nor on
/// what was resumed. Evaluations are appended to `out`/evaluations.jsonl as they end.
/// @throws std::runtime_error if the log cannot be written or belongs to another case.
PlanResult plan(const DrapeProblem& problem, const PlanOptions& options,
                const std::function<void(const Progress&)>& progress);

/// Hash of what an evaluation depends on: the resolved case without words, references and budgets.
std::uint64_t case_hash(const Case& definition);

}  // namespace drapeplan
