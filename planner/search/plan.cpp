#include "planner/search/plan.hpp"

#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "fem/core/hash.hpp"
#include "planner/base/json_text.hpp"
#include "planner/base/parallel.hpp"
#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

constexpr int kFrames = 21;  // of a reported drape, for ParaView: twenty equal parts of the sequence

/// Drapes at the reporting fidelity, kept with their frames so that pictures need no second run.
class ReportedDrapes {
 public:
  void keep(std::uint64_t hash, Drape drape) {
    const std::lock_guard<std::mutex> lock(mutex_);
    drapes_[hash] = std::move(drape);
  }
  /// The drape of a schedule; run now if it came from the log of an earlier run.
  Drape take(const DrapeProblem& problem, const Schedule& schedule) {
    const auto known = drapes_.find(schedule_hash(schedule));
    return known != drapes_.end() ? known->second : problem.run(schedule, kReport, kFrames);
  }

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, Drape> drapes_;
};

}  // namespace

std::uint64_t case_hash(const Case& definition) {
  nlohmann::json relevant = resolved_case(definition);
  // Words, published results and budgets change no evaluation: a search may go on with other ones.
  for (const char* key : {"description", "references", "optimise"}) relevant.erase(key);
  Fnv1a hash;
  hash.add(std::string_view(dump_json(relevant)));
  return hash.value();
}

std::array<std::string, 3> plan_fidelities(const Case& definition) {
  const auto fidelity_or_report = [&definition](const char* name) {
    return definition.fidelities.count(name) > 0 ? std::string(name) : std::string(kReport);
  };
  return {fidelity_or_report("screen"), fidelity_or_report("search"), kReport};
}

PlanResult plan(const DrapeProblem& problem, const PlanOptions& options,
                const std::function<void(const Progress&)>& progress) {
  const auto clock = std::chrono::steady_clock::now();
  std::filesystem::create_directories(options.out);
  const std::filesystem::path file = options.out / "evaluations.jsonl";
  if (!options.resume) std::filesystem::remove(file);
  EvaluationLog log(file.string(), case_hash(problem.definition()));

  ReportedDrapes reported;
  const Evaluate evaluate = [&](const Schedule& schedule, const std::string& fidelity) {
    const bool report = fidelity == kReport;
    Drape drape = problem.run(schedule, fidelity, report ? kFrames : 0);
    Outcome outcome{
        .score = drape.score, .summary = drape.run.summary, .wall_seconds = drape.run.summary.wall_seconds};
    if (report) reported.keep(schedule_hash(schedule), std::move(drape));
    return outcome;
  };
  StagedOptions staged;
  staged.optimise = problem.definition().optimise;
  staged.threads = options.threads;
  const auto fidelities = plan_fidelities(problem.definition());
  staged.wave_fidelity = fidelities[0];
  staged.gripper_fidelity = fidelities[1];

  PlanResult result;
  result.search =
      staged_search(problem.frame(), staged, make_batch_evaluate(evaluate, log, options.threads), progress);
  const StagedResult& search = result.search;
  const std::array<std::pair<const Candidate*, Drape*>, 3> wanted{
      {{&search.uniform, &result.uniform}, {&search.wave, &result.wave}, {&search.best, &result.best}}};
  parallel_for(
      int(wanted.size()),
      [&](int k) { *wanted[size_t(k)].second = reported.take(problem, wanted[size_t(k)].first->schedule); },
      options.threads);
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return result;
}

}  // namespace drapeplan
