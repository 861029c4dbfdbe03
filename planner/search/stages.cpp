#include "planner/search/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "planner/base/statistics.hpp"
#include "planner/drape/problem.hpp"
#include "planner/method/nlopt.hpp"
#include "planner/method/restarts.hpp"
#include "planner/schedule/families.hpp"
#include "planner/search/interrupted.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Schedules whose knots all agree within both count as the same finalist.
constexpr double kDifferentTime = 0.05;     // [s]
constexpr double kDifferentHeight = 0.001;  // [m]
/// NLopt searches side by side, from as many of the screened waves.
constexpr int kLocalSearches = 2;
/// First step of CMA-ES in units of the box's edge: small, so that what the local search has found is kept.
constexpr double kGripperSigma = 0.05;
/// Shares of the budget at which parts of the search end: the local search over smooth strokes, CMA-ES at the
/// cheapest fidelity (in so many equal parts, with a check after each), and at the finest.
constexpr double kSmoothEnd = 0.15, kScreenEnd = 0.6, kGripperEnd = 1;
constexpr int kScreenParts = 3;
/// Spearman's rank correlation of one generation at two fidelities below which the cheaper one is left.
constexpr double kTrustedCorrelation = 0.7;

/// A candidate before it has a fidelity: strokes and where they come from. One is kept per evaluation, so it
/// is small: the schedule is made from the strokes where it is needed.
struct Trial {
  std::string name;
  Strokes strokes;
  double objective = kInfinity;  ///< infinite: failed
  bool followed = true;
};

bool better(const Trial& a, const Trial& b) {
  return a.objective < b.objective;
}

/// Of candidates that may win: first those that ran to their end, of these those whose commands were
/// followed.
bool ranks_before(const Trial& a, const Trial& b) {
  if (std::isfinite(a.objective) != std::isfinite(b.objective)) return std::isfinite(a.objective);
  return a.followed != b.followed ? a.followed : better(a, b);
}
Trial rank_of(const Outcome& outcome) {
  return {.name = {}, .strokes = {}, .objective = value_of(outcome), .followed = outcome.score.followed};
}
bool ranks_before(const Outcome& a, const Outcome& b) {
  return ranks_before(rank_of(a), rank_of(b));
}

class StagedSearch {
 public:
  StagedSearch(const SequenceFrame& frame, const StagedOptions& options, const BatchEvaluate& evaluate,
               const std::function<void(const Progress&)>& progress)
      : frame_(frame), options_(options), evaluate_(evaluate), budget_(options.optimise, progress) {}

  StagedResult run() {
    compare({{"uniform", uniform_strokes(frame_)}, {"wave", wave_strokes(frame_)}}, "baseline");
    result_.uniform = result_.finalists[0];
    result_.wave = result_.finalists[1];
    budget_.reserve(options_.optimise.finalists + kCentres);
    try {
      search_waves();
      if (std::isfinite(best_at(options_.ladder.front())->objective)) {
        search_smooth();
        search_grippers();
      }
      compare(pick_finalists(), "report");
      conclude();
    } catch (const Interrupted&) {
      conclude_early();
    }
    return std::move(result_);
  }

 private:
  using Decode = std::function<Strokes(const Eigen::VectorXd&)>;
  static constexpr int kCentres = 1;  ///< of the search distribution, which no lucky value chose

  void search_waves();
  void search_smooth();
  void climb(Method& search, const Decode& decode, size_t rung,
             const std::function<void(double, size_t)>& search_until);
  void search_grippers();
  bool advance(Method& method, const Decode& decode, const std::vector<std::string>& fidelities,
               const std::string& stage);
  void compare(std::vector<Trial> trials, const std::string& stage);

  Schedule schedule_of(const Trial& trial) const { return to_schedule(frame_, trial.strokes); }
  std::vector<Outcome> evaluate(std::vector<Trial>& trials, const std::string& fidelity,
                                const std::string& stage, bool report = false);
  void record(const Trial& trial, const std::string& fidelity, const std::string& stage);
  std::vector<Trial> screen_waves();
  std::vector<Trial> pick_finalists() const;
  const Trial* best_at(const std::string& fidelity) const;
  void conclude();
  void conclude_early();

  const SequenceFrame& frame_;
  const StagedOptions& options_;
  const BatchEvaluate& evaluate_;
  Budget budget_;
  std::map<std::string, std::vector<Trial>> trials_;  // per fidelity, in the order of evaluation
  std::vector<Trial> centres_;                        // last means of CMA-ES
  double correlation_ = 1;                            // of the last generation at two fidelities
  std::map<std::string, double> best_;
  std::set<std::pair<std::uint64_t, std::string>> seen_;
  StagedResult result_;
};

std::vector<Outcome> StagedSearch::evaluate(std::vector<Trial>& trials, const std::string& fidelity,
                                            const std::string& stage, bool report) {
  std::vector<Schedule> schedules;
  for (const Trial& trial : trials) schedules.push_back(schedule_of(trial));
  std::vector<Outcome> outcomes = evaluate_(schedules, fidelity, stage);
  budget_.count(stage, fidelity, outcomes, report);
  for (size_t k = 0; k < trials.size(); ++k) {
    trials[k].objective = value_of(outcomes[k]);
    trials[k].followed = outcomes[k].score.followed;
    record(trials[k], fidelity, stage);
  }
  return outcomes;
}

void StagedSearch::record(const Trial& trial, const std::string& fidelity, const std::string& stage) {
  double& best = best_.try_emplace(fidelity, kInfinity).first->second;
  best = std::min(best, trial.objective);
  HistoryEntry entry;
  entry.number = int(result_.history.size()) + 1;
  entry.stage = stage;
  entry.fidelity = fidelity;
  entry.schedule_hash = schedule_hash(schedule_of(trial));
  entry.objective = trial.objective;
  entry.valid = std::isfinite(trial.objective);
  entry.best_so_far = best;
  if (seen_.insert({entry.schedule_hash, fidelity}).second) {
    ++result_.evaluations;
    result_.failed_evaluations += entry.valid ? 0 : 1;
  }
  result_.history.push_back(std::move(entry));
  trials_[fidelity].push_back(trial);
}

/// Baselines, then waves from the middle, the corners and the mid-sides, as many as an evaluation budget
/// holds.
std::vector<Trial> StagedSearch::screen_waves() {
  const WaveFamily family(frame_);
  const WaveParameters base = baseline_wave(frame_);
  std::vector<Trial> trials{{"uniform", uniform_strokes(frame_)}, {"wave", wave_strokes(frame_)}};
  const auto add_member = [&](const Eigen::VectorXd& x) {
    const int most = options_.optimise.evaluations;
    if (most > 0 && int(trials.size()) >= most) return;
    trials.push_back({fmt::format("wave {}", trials.size() + 1), family.decode(x)});
  };
  if (options_.wave.size() > 0) add_member(options_.wave);
  const Eigen::Vector2d corner =
      0.5 * frame_.rig.spacing * Eigen::Vector2d(frame_.rig.columns - 1, frame_.rig.rows - 1);
  const auto add = [&](double u, double v, double delay_factor) {
    WaveParameters wave = base;
    wave.start = Eigen::Vector2d(u * corner[0], v * corner[1]);
    wave.delay *= delay_factor;
    add_member(family.encode(wave));
  };
  for (const double v : {-1.0, 1.0}) {
    for (const double u : {-1.0, 1.0}) add(u, v, 1);
  }
  for (const double side : {-1.0, 1.0}) add(side, 0, 1);
  for (const double side : {-1.0, 1.0}) add(0, side, 1);
  add(0, 0, 3);  // a slow wave: the next group starts when the one before is nearly down
  return trials;
}

void StagedSearch::search_waves() {
  std::vector<Trial> screened = screen_waves();
  evaluate(screened, options_.ladder.front(), "wave");
}

const Trial* StagedSearch::best_at(const std::string& fidelity) const {
  const auto list = trials_.find(fidelity);
  if (list == trials_.end() || list->second.empty()) return nullptr;
  return &*std::min_element(list->second.begin(), list->second.end(), better);
}

/// One batch of a method at one fidelity or several, the last of which is told; false if it has none left.
bool StagedSearch::advance(Method& method, const Decode& decode, const std::vector<std::string>& fidelities,
                           const std::string& stage) {
  if (!method.stop_reason().empty()) return false;
  const Eigen::MatrixXd x = method.ask();
  if (x.cols() == 0) return false;
  std::vector<Trial> trials;
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    const size_t number = result_.history.size() + size_t(k) + 1;
    trials.push_back({fmt::format("{} {}", stage, number), decode(x.col(k))});
  }
  std::vector<double> before, values;
  for (const std::string& fidelity : fidelities) {
    evaluate(trials, fidelity, stage);
    before = std::move(values);
    values.clear();
    for (const Trial& trial : trials) values.push_back(trial.objective);
  }
  if (!before.empty()) correlation_ = spearman(before, values);
  method.tell(Eigen::Map<const Eigen::VectorXd>(values.data(), x.cols()));
  return true;
}

/// COBYLA from the best waves: at the start, a hundred evaluations of it bring what CMA-ES finds with four
/// hundred.
void StagedSearch::search_smooth() {
  const std::string& fidelity = options_.ladder.front();
  const StrokeFamily family(frame_, {});
  std::vector<Trial> waves = trials_[fidelity];
  std::stable_sort(waves.begin(), waves.end(), better);
  const int budget = budget_.affords(kSmoothEnd - budget_.spent(), fidelity);
  const int count = std::min(kLocalSearches, int(waves.size()));
  std::vector<NloptStart> starts;
  for (int k = 0; k < count; ++k) {
    starts.push_back({.x = family.encode(waves[size_t(k)].strokes), .evaluations = (budget + k) / count});
  }
  NloptSearches search(starts, options_.optimise.seed);
  const Decode decode = [&](const Eigen::VectorXd& x) { return family.decode(x); };
  while (budget_.spent() < kSmoothEnd && advance(search, decode, {fidelity}, "smooth")) {
  }
}

void StagedSearch::search_grippers() {
  const StrokeFamily family(frame_, {.start = Spread::each, .height = Spread::each});
  RestartedCmaEs search(family.encode(best_at(options_.ladder.front())->strokes),
                        {.sigma0 = kGripperSigma, .seed = options_.optimise.seed});
  const Decode decode = [&](const Eigen::VectorXd& x) { return family.decode(x); };
  const auto search_until = [&](double end, size_t rung) {
    while (budget_.spent() < end && advance(search, decode, {options_.ladder[rung]}, "gripper")) {
    }
  };
  const size_t finest = options_.ladder.size() - 1;
  for (size_t rung = 0; rung < finest; ++rung) {
    climb(search, decode, rung, search_until);
    search.forget_values();
  }
  search_until(kGripperEnd, finest);
  if (search.generations() > 0) centres_.push_back({"gripper centre", family.decode(search.mean())});
}

/// Searches at one fidelity until its ranks are no longer those of the next one, or its share is spent. Where
/// they are compared, one generation is evaluated at both, and the finer values are told.
void StagedSearch::climb(Method& search, const Decode& decode, size_t rung,
                         const std::function<void(double, size_t)>& search_until) {
  const std::string &here = options_.ladder[rung], &next = options_.ladder[rung + 1];
  const double begin = budget_.spent();
  for (int part = 1; part <= kScreenParts; ++part) {
    search_until(begin + (kScreenEnd - begin) * part / kScreenParts, rung);
    if (budget_.spent() >= kScreenEnd || !advance(search, decode, {here, next}, "gripper")) return;
    if (!(correlation_ >= kTrustedCorrelation)) return;  // one that is not defined is not trusted
  }
}

bool nearly_equal(const Schedule& a, const Schedule& b) {
  for (size_t g = 0; g < a.paths.size(); ++g) {
    if (a.paths[g].size() != b.paths[g].size()) return false;
    for (size_t k = 0; k < a.paths[g].size(); ++k) {
      if (std::abs(a.paths[g][k].time - b.paths[g][k].time) > kDifferentTime) return false;
      if (std::abs(a.paths[g][k].z - b.paths[g][k].z) > kDifferentHeight) return false;
    }
  }
  return true;
}

/// The best few that differ from each other and from the baselines, of the finest fidelity that has some;
/// and the centres of the search distributions.
std::vector<Trial> StagedSearch::pick_finalists() const {
  std::vector<Trial> finalists;
  std::vector<Schedule> schedules{result_.uniform.schedule, result_.wave.schedule};
  const auto add_if_new = [&](const Trial& trial) {
    Schedule schedule = schedule_of(trial);
    if (std::any_of(schedules.begin(), schedules.end(),
                    [&](const Schedule& other) { return nearly_equal(other, schedule); }))
      return;
    finalists.push_back(trial);
    schedules.push_back(std::move(schedule));
  };
  const auto wanted = size_t(std::max(options_.optimise.finalists, 0));
  for (auto fidelity = options_.ladder.rbegin(); fidelity != options_.ladder.rend(); ++fidelity) {
    const auto list = trials_.find(*fidelity);
    if (list == trials_.end()) continue;
    std::vector<const Trial*> sorted;
    for (const Trial& trial : list->second) sorted.push_back(&trial);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Trial* a, const Trial* b) { return ranks_before(*a, *b); });
    for (const Trial* trial : sorted) {
      if (finalists.size() >= wanted || !std::isfinite(trial->objective)) break;
      add_if_new(*trial);
    }
  }
  for (const Trial& trial : centres_) add_if_new(trial);
  return finalists;
}

void StagedSearch::compare(std::vector<Trial> trials, const std::string& stage) {
  const std::vector<Outcome> outcomes = evaluate(trials, kReport, stage, true);
  for (size_t k = 0; k < trials.size(); ++k)
    result_.finalists.push_back({trials[k].name, schedule_of(trials[k]), outcomes[k]});
}

void StagedSearch::conclude() {
  std::stable_sort(result_.finalists.begin(), result_.finalists.end(),
                   [](const Candidate& a, const Candidate& b) { return ranks_before(a.outcome, b.outcome); });
  result_.best = result_.finalists.front();
  result_.best_fidelity = kReport;
  const Outcome& better_baseline = ranks_before(result_.wave.outcome, result_.uniform.outcome)
                                       ? result_.wave.outcome
                                       : result_.uniform.outcome;
  const double baseline = value_of(better_baseline), best = value_of(result_.best.outcome);
  result_.beats_baselines = ranks_before(result_.best.outcome, better_baseline);
  const std::string& name = result_.best.name;
  if (!std::isfinite(best)) {
    result_.message = fmt::format("no schedule could be evaluated at fidelity \"{}\"", kReport);
  } else if (!std::isfinite(baseline)) {
    result_.message =
        fmt::format("both baselines failed; the best schedule, {}, has an objective of {:.6g}", name, best);
  } else if (result_.beats_baselines && best >= baseline) {
    result_.message = fmt::format(
        "the optimised sequence (candidate \"{}\") has an objective of {:.4g}; the rig does not follow the "
        "baselines, of which the better one has {:.4g}",
        name, best, baseline);
  } else if (result_.beats_baselines) {
    result_.message = fmt::format(
        "the optimised sequence (candidate \"{}\") has an objective of {:.4g}, {:.1f} % below the better "
        "baseline's {:.4g}",
        name, best, 100 * (baseline - best) / std::abs(baseline), baseline);
  } else {
    result_.message = fmt::format(
        "nothing found beats the baselines at the reporting fidelity: {} stays the best, objective {:.6g}",
        name, best);
  }
  if (std::isfinite(best) && !result_.best.outcome.score.followed)
    result_.message += "; no schedule was followed by the rig within the tolerance of lag";
}

void StagedSearch::conclude_early() {
  conclude();
  result_.interrupted = true;
  for (auto fidelity = options_.ladder.rbegin(); fidelity != options_.ladder.rend(); ++fidelity) {
    const std::vector<Trial>& list = trials_[*fidelity];
    const auto best = std::min_element(list.begin(), list.end(),
                                       [](const Trial& a, const Trial& b) { return ranks_before(a, b); });
    if (best == list.end() || !std::isfinite(best->objective)) continue;
    result_.best = {best->name, schedule_of(*best), {}};
    result_.best_fidelity = *fidelity;
    break;
  }
  if (!std::isfinite(value_of(result_.best.outcome)) && result_.best_fidelity == kReport) {
    result_.message += "; interrupted, --resume goes on";
    return;
  }
  result_.message = fmt::format(
      "interrupted after {} evaluations; the best so far is {}, at fidelity \"{}\"; --resume goes on",
      result_.evaluations, result_.best.name, result_.best_fidelity);
}

}  // namespace

StagedResult staged_search(const SequenceFrame& frame, const StagedOptions& options,
                           const BatchEvaluate& evaluate,
                           const std::function<void(const Progress&)>& progress) {
  return StagedSearch(frame, options, evaluate, progress).run();
}

}  // namespace drapeplan
