// The main job: map, check reach, evaluate the baselines, optimise, re-evaluate at the reporting fidelity.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planner/base/output_folder.hpp"
#include "planner/drape/problem.hpp"
#include "planner/search/design.hpp"
#include "planner/search/stages.hpp"

namespace drapeplan {

/// The log of a plan in its run folder.
inline constexpr const char* kEvaluations = "evaluations.jsonl";
/// Of a reported drape, for ParaView: twenty equal parts of the sequence.
inline constexpr int kReportFrames = 21;

struct PlanOptions {
  bool resume = false;  ///< continue from the evaluations that the run folder holds
  int threads = 0;      ///< 0: one per core
  /// Asked before each run; once it says true, the search ends with what it has. May be empty.
  std::function<bool()> stop = {};
  KeptTime kept = {};
  /// Called with the folder that the results of an earlier run were moved to, if there were some.
  std::function<void(const std::filesystem::path&)> moved = {};
};

/// What a plan run found; files are written by `write_plan` (planner/report/run_files.hpp).
struct PlanResult {
  StagedResult search;
  std::optional<DesignResult> design;  ///< where the case has design variables: all drapes are on its rig
  Score given;                ///< then: uniform on the case as it was given, at the reporting fidelity
  Drape uniform, wave, best;  ///< at the reporting fidelity, with frames
  double wall_seconds = 0;
};

/// Fidelities that a plan of the case searches, cheapest first: `screen` and `search`, where it has them.
std::vector<std::string> plan_ladder(const Case& definition);

/// Builds the models of all fidelities that a plan uses: what cannot be built is found before anything is
/// written.
/// @throws WrongInput, and NotFinished where the memory does not suffice.
void build_models(const DrapeProblem& problem);

/// The case that the drapes of a plan are of: with its design, if there is one.
inline const DrapeProblem& planned_problem(const DrapeProblem& given, const PlanResult& result) {
  return result.design ? *result.design->problem : given;
}

/// The log of a plan that starts now in a folder: a known one if it is resumed; whatever else the folder
/// holds is set aside. Writes resolved.json.
/// @throws WrongInput if the log that is to be resumed belongs to another case; the folder is then as it was.
/// @throws NotFinished if a file cannot be written.
EvaluationLog start_log(const Case& definition, OutputFolder& out, const PlanOptions& options);
void write_resolved(const Case& definition, const OutputFolder& out);

/// Searches for the best schedule of the problem; where the case has design variables, for the best rig
/// first. With a budget of evaluations the result depends on the case only: not on threads, nor on what was
/// resumed. Results of an earlier
/// run in `out` are set aside, resolved.json is written, and evaluations are appended to evaluations.jsonl as
/// they end. Memory: per evaluation its outcome, its strokes and its line of the history, a few kilobytes;
/// whole drapes are kept of the two baselines and of the best so far only.
/// Errors as those of start_log.
PlanResult plan(const DrapeProblem& problem, OutputFolder& out, const PlanOptions& options = {},
                const std::function<void(const Progress&)>& progress = {});
/// The same in a folder that has been made ready, with its log.
PlanResult plan(const DrapeProblem& problem, EvaluationLog& log, const PlanOptions& options = {},
                const std::function<void(const Progress&)>& progress = {});

/// Hash of what an evaluation depends on: the resolved case without names, sources, other words, references
/// and budgets; without numerical settings where a plan chooses them, which each evaluation names itself.
std::uint64_t case_hash(const Case& definition);

}  // namespace drapeplan
