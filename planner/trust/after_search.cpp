#include "planner/trust/after_search.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "planner/search/finalists.hpp"
#include "planner/search/interrupted.hpp"

namespace drapeplan {
namespace {

class AfterSearch {
 public:
  AfterSearch(const DrapeProblem& given, EvaluationLog& log, const PlanOptions& options,
              const std::function<void(const Progress&)>& progress, PlanResult& result)
      : given_(given),
        problem_(planned_problem(given, result)),
        log_(log),
        options_(options),
        progress_(progress),
        result_(result) {}

  /// @return the rule by which the winner was chosen.
  Choose choose_winner() {
    const Choose rule = optimise().choose;
    if (rule == Choose::nominal) return rule;
    tell("spread");
    const Candidate* winner = nullptr;
    Worth best, nominal;
    int compared = 0;
    for (const Candidate& candidate : result_.search.finalists) {
      if (!candidate.outcome.score.valid || !candidate.outcome.score.followed) continue;
      if (compared++ == kRobustCandidates) break;
      const std::optional<PlantSpread> spread = spread_of_schedule(candidate.schedule);
      if (!spread) {
        result_.search.message += fmt::format(
            "; there was no time to choose by the {} objective in plants that differ", name_of(rule));
        return Choose::nominal;
      }
      const Worth worth = worth_of(*spread, rule);
      if (compared == 1) nominal = worth;
      if (winner == nullptr || worth.before(best)) best = worth, winner = &candidate;
    }
    if (winner != nullptr && winner->name != result_.search.best.name) declare(*winner, best, nominal, rule);
    return winner == nullptr ? Choose::nominal : rule;
  }

  [[nodiscard]] std::optional<Confirmation> confirm_winner() {
    tell("confirm");
    return confirm(problem_, result_.search, runs_within(kConfirmShare), log_);
  }

  [[nodiscard]] std::optional<PlantSpread> spread_of_winner() {
    tell("spread");
    return spread_of_schedule(result_.search.best.schedule);
  }

 private:
  /// Makes a finalist that is not the best in the case as it is the winner.
  void declare(const Candidate& winner, const Worth& worth, const Worth& nominal, Choose rule) {
    const std::string before = result_.search.best.name;
    Drape drape = drape_of(winner);
    declare_best(result_.search, winner);
    const auto text_of = [](const Worth& one) {
      return one.failures > 0 ? fmt::format("{:.4g} ({} fail)", one.value, one.failures)
                              : fmt::format("{:.4g}", one.value);
    };
    if (!result_.search.beats_baselines)
      result_.search.message =
          fmt::format("in the case as it is, {} does not beat the baselines", winner.name);
    result_.search.message += fmt::format(
        "; it was chosen for its {} objective of {} in plants that differ, where \"{}\", the "
        "best in the case as it is, has {}",
        name_of(rule), text_of(worth), before, text_of(nominal));
    result_.best = std::move(drape);
    if (result_.design) compare_changes(given_, winner.schedule, log_, options_.threads, *result_.design);
  }

  /// With its frames.
  [[nodiscard]] Drape drape_of(const Candidate& candidate) const {
    if (candidate.name == result_.search.uniform.name) return result_.uniform;
    if (candidate.name == result_.search.wave.name) return result_.wave;
    if (options_.stop && options_.stop()) throw Interrupted();
    return problem_.run(candidate.schedule, kReport, kReportFrames);
  }

  [[nodiscard]] const OptimiseOptions& optimise() const { return problem_.definition().optimise; }
  [[nodiscard]] SideRuns runs_within(double share) const {
    return runs_after_search(share, optimise(), result_, options_);
  }
  /// The first that is asked for decides at which fidelity: all are compared at one.
  [[nodiscard]] std::optional<PlantSpread> spread_of_schedule(const Schedule& schedule) {
    SideRuns runs = runs_within(kSpreadShare);
    if (fidelity_known_) runs.seconds = 0;
    std::optional<PlantSpread> spread =
        spread_of(problem_, schedule, better_baseline(result_.search).schedule, fidelities_, runs, log_);
    if (spread) fidelities_ = {spread->fidelity}, fidelity_known_ = true;
    return spread;
  }

  void tell(const char* stage) const {
    if (!progress_) return;
    progress_({.stage = stage,
               .done = log_.size(),
               .best = result_.best.score.objective,
               .seconds_left = std::numeric_limits<double>::quiet_NaN()});
  }

  const DrapeProblem& given_;
  const DrapeProblem& problem_;
  EvaluationLog& log_;
  const PlanOptions& options_;
  const std::function<void(const Progress&)>& progress_;
  PlanResult& result_;
  std::vector<std::string> fidelities_ = plan_ladder(problem_.definition());
  bool fidelity_known_ = false;
};

}  // namespace

SideRuns runs_after_search(double share, const OptimiseOptions& optimise, const PlanResult& result,
                           const PlanOptions& options) {
  return {.seconds = optimise.evaluations > 0 ? 0 : share * optimise.budget,
          .design = result.design ? design_hash(result.design->overrides) : 0,
          .threads = options.threads,
          .stop = options.stop};
}

double seconds_after_search(const Case& definition, double each, int threads) {
  const OptimiseOptions& optimise = definition.optimise;
  if (optimise.evaluations > 0) return 0;
  const int compared = optimise.choose == Choose::nominal ? 1 : kRobustCandidates;
  const SideRuns confirmed{.seconds = kConfirmShare * optimise.budget, .threads = threads};
  return confirm_seconds(definition.fidelities.at(kReport), each, confirmed) +
         compared * kSpreadShare * optimise.budget;
}

void look_closer(const DrapeProblem& given, EvaluationLog& log, const PlanOptions& options,
                 const std::function<void(const Progress&)>& progress, PlanResult& result, PlanTrust& trust) {
  const auto claim = [&] {
    if (trust.choice) claim_beyond(trust.choice->chosen.back().objective_error, result.search);
  };
  claim();  // of the best of the search: what follows may be interrupted
  AfterSearch after(given, log, options, progress, result);
  const std::string best = result.search.best.name;
  trust.rule = after.choose_winner();
  if (result.search.best.name != best) claim();
  trust.confirmation = after.confirm_winner();
  if (trust.confirmation)
    claim_confirmed(*trust.confirmation, result.search);
  else
    result.search.message += "; no time was left to play it again at a finer setting";
  trust.spread = after.spread_of_winner();
}

}  // namespace drapeplan
