#include "planner/trust/after_search.hpp"

#include <fmt/format.h>

#include <limits>

#include "planner/search/finalists.hpp"

namespace drapeplan {
namespace {

class AfterSearch {
 public:
  AfterSearch(const DrapeProblem& problem, EvaluationLog& log, const PlanOptions& options,
              const std::function<void(const Progress&)>& progress, PlanResult& result)
      : problem_(problem), log_(log), options_(options), progress_(progress), result_(result) {}

  void choose_winner() {
    const Choose rule = optimise().choose;
    if (rule == Choose::nominal) return;
    tell("spread");
    const Candidate* winner = nullptr;
    double lowest = std::numeric_limits<double>::infinity(), nominal = lowest;
    int compared = 0;
    for (const Candidate& candidate : result_.search.finalists) {
      if (!candidate.outcome.score.valid || !candidate.outcome.score.followed) continue;
      if (compared++ == kRobustCandidates) break;
      const std::optional<PlantSpread> spread = spread_of_schedule(candidate.schedule);
      if (!spread) return;
      const double value = worth(*spread, rule);
      if (compared == 1) nominal = value;
      if (value < lowest) lowest = value, winner = &candidate;
    }
    if (winner == nullptr || winner->name == result_.search.best.name) return;
    const std::string before = result_.search.best.name;
    declare_best(result_.search, *winner);
    result_.search.message += fmt::format(
        "; it was chosen for its {} objective of {:.4g} in plants that differ, where \"{}\" has {:.4g}",
        rule == Choose::mean ? "mean" : "worst", lowest, before, nominal);
    result_.search.learned.reset();  // it is of the other one's neighbourhood
    result_.best = problem_.run(result_.search.best.schedule, kReport, int(result_.best.frames.size()));
  }

  [[nodiscard]] std::optional<Confirmation> confirm_winner() {
    tell("confirm");
    return confirm(problem_, result_.search,
                   {.seconds = seconds_of(kConfirmShare),
                    .design = design(),
                    .threads = options_.threads,
                    .stop = options_.stop},
                   log_);
  }

  [[nodiscard]] std::optional<PlantSpread> spread_of_winner() {
    tell("spread");
    return spread_of_schedule(result_.search.best.schedule);
  }

 private:
  [[nodiscard]] const OptimiseOptions& optimise() const { return problem_.definition().optimise; }
  [[nodiscard]] std::uint64_t design() const {
    return result_.design ? design_hash(result_.design->overrides) : 0;
  }
  /// 0: there is no limit.
  [[nodiscard]] double seconds_of(double share) const {
    return optimise().evaluations > 0 ? 0 : share * optimise().budget;
  }

  /// The first that is asked for decides at which fidelity: all are compared at one.
  [[nodiscard]] std::optional<PlantSpread> spread_of_schedule(const Schedule& schedule) {
    std::optional<PlantSpread> spread =
        spread_of(problem_, schedule, better_baseline(result_.search).schedule,
                  {.fidelities = fidelities_,
                   .seconds = seconds_of(kSpreadShare),
                   .design = design(),
                   .threads = options_.threads,
                   .stop = options_.stop},
                  log_);
    if (spread) fidelities_ = {spread->fidelity};
    return spread;
  }

  void tell(const char* stage) const {
    if (!progress_) return;
    progress_({.stage = stage,
               .done = log_.size(),
               .best = result_.best.score.objective,
               .seconds_left = std::numeric_limits<double>::quiet_NaN()});
  }

  const DrapeProblem& problem_;
  EvaluationLog& log_;
  const PlanOptions& options_;
  const std::function<void(const Progress&)>& progress_;
  PlanResult& result_;
  std::vector<std::string> fidelities_ = plan_ladder(problem_.definition());
};

}  // namespace

double share_after_search(const OptimiseOptions& optimise) {
  return kConfirmShare + kSpreadShare * (optimise.choose == Choose::nominal ? 1 : kRobustCandidates);
}

void look_closer(const DrapeProblem& problem, EvaluationLog& log, const PlanOptions& options,
                 const std::function<void(const Progress&)>& progress, PlanResult& result, PlanTrust& trust) {
  AfterSearch after(problem, log, options, progress, result);
  after.choose_winner();
  if (trust.choice) claim_beyond(trust.choice->chosen.back().objective_error, result.search);
  trust.confirmation = after.confirm_winner();
  if (trust.confirmation) claim_confirmed(*trust.confirmation, result.search);
  trust.spread = after.spread_of_winner();
}

}  // namespace drapeplan
