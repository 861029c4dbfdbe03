#include "planner/search/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "planner/drape/problem.hpp"
#include "planner/search/cmaes.hpp"
#include "planner/search/nlopt.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Schedules whose knots all agree within it count as the same finalist [s].
constexpr double kDifferentTime = 0.05;
/// NLopt searches side by side in the wave stage, COBYLA and SBPLX in turn.
constexpr int kLocalSearches = 4;
/// Of the gripper stage, in units of the box's edge: small, so that what the wave stage found is kept.
constexpr double kGripperSigma = 0.05;

/// A candidate before it has a fidelity: strokes and where they come from. One is kept per evaluation, so it
/// is small: the schedule is made from the strokes where it is needed.
struct Trial {
  std::string name;
  Strokes strokes;
  double objective = kInfinity;  ///< infinite: failed
};

Trial make_trial(std::string name, Strokes strokes) {
  return {std::move(name), std::move(strokes), kInfinity};
}

bool better(const Trial& a, const Trial& b) {
  return a.objective < b.objective;
}

/// Counts evaluations, estimates the time left and calls the user. The only part that looks at a clock.
class Meter {
 public:
  Meter(const StagedOptions& options, const std::function<void(const Progress&)>& progress)
      : progress_(progress) {
    const OptimiseOptions& o = options.optimise;
    planned_[options.wave_fidelity] += o.wave_evaluations;
    planned_[options.gripper_fidelity] += o.gripper_evaluations;
    planned_[kReport] += o.finalists + 3;  // the baselines and the centre
  }

  void count(const std::string& stage, const std::string& fidelity, const std::vector<Outcome>& outcomes) {
    const std::scoped_lock lock(mutex_);
    if (!best_.contains(fidelity)) best_[fidelity] = kInfinity;
    for (const Outcome& outcome : outcomes) {
      best_[fidelity] = std::min(best_[fidelity], value_of(outcome));
      ++done_[fidelity];
      if (outcome.cached) continue;
      ++runs_[fidelity];
      seconds_[fidelity] += outcome.wall_seconds;
    }
    if (progress_) progress_(report(stage, fidelity));
  }

 private:
  Progress report(const std::string& stage, const std::string& fidelity) {
    Progress p;
    p.stage = stage;
    p.best = best_[fidelity];
    double work = 0, dearest = 0, spent = 0;
    for (const auto& [name, seconds] : seconds_) {
      spent += seconds;
      if (runs_[name] > 0) dearest = std::max(dearest, seconds / runs_[name]);
    }
    for (const auto& [name, planned] : planned_) {
      p.done += done_[name];
      p.planned += std::max(planned, done_[name]);
      const double mean = runs_[name] > 0 ? seconds_[name] / runs_[name] : dearest;
      work += mean * std::max(planned - done_[name], 0);
    }
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    p.seconds_left =
        spent > 0 ? work * std::min(elapsed / spent, 1.0) : std::numeric_limits<double>::quiet_NaN();
    return p;
  }

  std::function<void(const Progress&)> progress_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::map<std::string, int> planned_, done_, runs_;  // per fidelity
  std::map<std::string, double> best_, seconds_;
};

class StagedSearch {
 public:
  StagedSearch(const SequenceFrame& frame, const StagedOptions& options, const BatchEvaluate& evaluate,
               const std::function<void(const Progress&)>& progress)
      : frame_(frame), options_(options), evaluate_(evaluate), meter_(options, progress) {}

  StagedResult run() {
    search_waves();
    search_grippers();
    compare_finalists();
    return std::move(result_);
  }

 private:
  void search_waves();
  void search_grippers();
  void compare_finalists();

  Schedule schedule_of(const Trial& trial) const { return to_schedule(frame_, trial.strokes); }
  std::vector<Outcome> evaluate(std::vector<Trial>& trials, const std::string& fidelity,
                                const std::string& stage);
  void record(const Trial& trial, const std::string& fidelity, const std::string& stage);
  std::vector<Trial> screen_waves();
  std::vector<NloptStart> local_starts(const std::vector<Trial>& screened, int budget) const;
  std::vector<Trial> pick_finalists() const;
  void conclude();

  const SequenceFrame& frame_;
  const StagedOptions& options_;
  const BatchEvaluate& evaluate_;
  Meter meter_;
  std::vector<Trial> trials_;            // candidates at the fidelity of the stage that was last
  std::vector<Eigen::VectorXd> starts_;  // wave coordinates of the screened waves
  std::vector<Trial> centre_;            // the last mean of CMA-ES, or empty
  std::map<std::string, double> best_;
  std::set<std::pair<std::uint64_t, std::string>> seen_;
  StagedResult result_;
};

std::vector<Outcome> StagedSearch::evaluate(std::vector<Trial>& trials, const std::string& fidelity,
                                            const std::string& stage) {
  std::vector<Schedule> schedules;
  for (const Trial& trial : trials) schedules.push_back(schedule_of(trial));
  std::vector<Outcome> outcomes = evaluate_(schedules, fidelity, stage);
  meter_.count(stage, fidelity, outcomes);
  for (size_t k = 0; k < trials.size(); ++k) {
    trials[k].objective = value_of(outcomes[k]);
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
}

/// Baselines, then waves from the middle, the corners and the mid-sides, as many as the budget holds. The
/// first two coordinates in `starts_` stand for the baselines.
std::vector<Trial> StagedSearch::screen_waves() {
  const WaveFamily family(frame_);
  const WaveParameters base = baseline_wave(frame_);
  WaveParameters flat = base;
  flat.delay = 0;
  flat.duration = frame_.options.uniform_duration;
  std::vector<Trial> trials{make_trial("uniform", uniform_strokes(frame_)),
                            make_trial("wave", wave_strokes(frame_))};
  starts_ = {family.encode(flat), family.encode(base)};
  if (options_.wave.size() > 0) {
    starts_.push_back(options_.wave);
    trials.push_back(make_trial(fmt::format("wave {}", trials.size() + 1), family.decode(options_.wave)));
  }
  const Eigen::Vector2d corner =
      0.5 * frame_.rig.spacing * Eigen::Vector2d(frame_.rig.columns - 1, frame_.rig.rows - 1);
  const auto add = [&](double u, double v, double delay_factor) {
    if (int(trials.size()) >= options_.optimise.wave_evaluations) return;
    WaveParameters wave = base;
    wave.start = Eigen::Vector2d(u * corner[0], v * corner[1]);
    wave.delay *= delay_factor;
    starts_.push_back(family.encode(wave));
    trials.push_back(make_trial(fmt::format("wave {}", trials.size() + 1), family.decode(starts_.back())));
  };
  for (const double v : {-1.0, 1.0}) {
    for (const double u : {-1.0, 1.0}) add(u, v, 1);
  }
  for (const double side : {-1.0, 1.0}) add(side, 0, 1);
  for (const double side : {-1.0, 1.0}) add(0, side, 1);
  add(0, 0, 3);  // a slow wave: the next group starts when the one before is nearly down
  return trials;
}

/// Starts for NLopt: the best screened waves, the budget in equal parts, the algorithms in turn.
std::vector<NloptStart> StagedSearch::local_starts(const std::vector<Trial>& screened, int budget) const {
  std::vector<size_t> order(screened.size());
  for (size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return better(screened[a], screened[b]); });
  constexpr int kLeastBudget = 2 * (WaveFamily::kDimension + 1);  // a first simplex and as many steps
  const int most = std::max(1, budget / kLeastBudget);
  const int count = std::min({kLocalSearches, most, int(order.size())});
  std::vector<NloptStart> starts;
  for (int k = 0; k < count; ++k) {
    starts.push_back({starts_[order[size_t(k)]], k % 2 == 0 ? LocalSearch::cobyla : LocalSearch::sbplx,
                      (budget + k) / count});
  }
  return starts;
}

void StagedSearch::search_waves() {
  trials_ = screen_waves();
  evaluate(trials_, options_.wave_fidelity, "wave");
  const int budget = options_.optimise.wave_evaluations - int(trials_.size());
  if (budget <= 0) return;
  const WaveFamily family(frame_);
  const auto objective = [&](const Eigen::VectorXd& x) {
    const std::vector<Outcome> outcome =
        evaluate_({to_schedule(frame_, family.decode(x))}, options_.wave_fidelity, "wave");
    meter_.count("wave", options_.wave_fidelity, outcome);
    return value_of(outcome.front());
  };
  NloptOptions nlopt;
  nlopt.seed = options_.optimise.seed;
  nlopt.threads = options_.threads;
  const std::vector<NloptRun> runs = nlopt_search(objective, local_starts(trials_, budget), nlopt);
  size_t longest = 0;
  for (const NloptRun& run : runs) longest = std::max(longest, run.trials.size());
  for (size_t turn = 0; turn < longest; ++turn) {
    for (const NloptRun& run : runs) {
      if (turn >= run.trials.size()) continue;
      Trial trial = make_trial(fmt::format("wave {}", trials_.size() + 1), family.decode(run.trials[turn].x));
      trial.objective = run.trials[turn].value;
      record(trial, options_.wave_fidelity, "wave");
      trials_.push_back(std::move(trial));
    }
  }
}

void StagedSearch::search_grippers() {
  const int budget = options_.optimise.gripper_evaluations;
  if (budget <= 0) return;
  const Trial base = *std::min_element(trials_.begin(), trials_.end(), better);
  if (options_.gripper_fidelity != options_.wave_fidelity) {  // objectives of two fidelities do not compare
    std::vector<Trial> again{base};
    evaluate(again, options_.gripper_fidelity, "gripper");
    trials_ = std::move(again);
  }
  const GripperFamily family(frame_, base.strokes);
  constexpr int kLeastGenerations = 4, kLeastPopulation = 4;
  const int usual = 4 + int(std::floor(3 * std::log(double(family.dimension()))));
  CmaEsOptions cma;
  cma.sigma0 = kGripperSigma;
  cma.seed = options_.optimise.seed;
  cma.population = std::max(kLeastPopulation, std::min(usual, budget / kLeastGenerations));
  CmaEs search(family.encode_base(), cma);
  for (int done = 0; done + search.population() <= budget && search.stop_reason().empty();
       done += search.population()) {
    const Eigen::MatrixXd x = search.ask();
    std::vector<Trial> generation;
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      generation.push_back(make_trial(fmt::format("gripper {}", done + k + 1), family.decode(x.col(k))));
    }
    evaluate(generation, options_.gripper_fidelity, "gripper");
    Eigen::VectorXd values(x.cols());
    for (Eigen::Index k = 0; k < x.cols(); ++k) values[k] = generation[size_t(k)].objective;
    search.tell(values);
    trials_.insert(trials_.end(), generation.begin(), generation.end());
  }
  centre_ = {make_trial("gripper centre", family.decode(search.mean()))};
}

bool nearly_equal(const Schedule& a, const Schedule& b) {
  for (size_t g = 0; g < a.paths.size(); ++g) {
    if (a.paths[g].size() != b.paths[g].size()) return false;
    for (size_t k = 0; k < a.paths[g].size(); ++k) {
      if (std::abs(a.paths[g][k].time - b.paths[g][k].time) > kDifferentTime) return false;
    }
  }
  return true;
}

/// The baselines; the best few that differ; the centre of the search distribution, which no lucky value
/// chose.
std::vector<Trial> StagedSearch::pick_finalists() const {
  std::vector<Trial> finalists;
  std::vector<Schedule> schedules;
  const auto add = [&](const Trial& trial) {
    finalists.push_back(trial);
    schedules.push_back(schedule_of(trial));
  };
  const auto add_if_new = [&](const Trial& trial) {
    const Schedule schedule = schedule_of(trial);
    if (std::none_of(schedules.begin(), schedules.end(),
                     [&](const Schedule& other) { return nearly_equal(other, schedule); }))
      add(trial);
  };
  add(make_trial("uniform", uniform_strokes(frame_)));
  add(make_trial("wave", wave_strokes(frame_)));
  std::vector<const Trial*> sorted;
  for (const Trial& trial : trials_) sorted.push_back(&trial);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Trial* a, const Trial* b) { return better(*a, *b); });
  const size_t wanted = finalists.size() + size_t(std::max(options_.optimise.finalists, 0));
  for (const Trial* trial : sorted) {
    if (finalists.size() >= wanted || !std::isfinite(trial->objective)) break;
    add_if_new(*trial);
  }
  for (const Trial& trial : centre_) add_if_new(trial);
  return finalists;
}

void StagedSearch::compare_finalists() {
  std::vector<Trial> finalists = pick_finalists();
  const std::vector<Outcome> outcomes = evaluate(finalists, kReport, "report");
  for (size_t k = 0; k < finalists.size(); ++k) {
    result_.finalists.push_back({finalists[k].name, schedule_of(finalists[k]), outcomes[k]});
  }
  result_.uniform = result_.finalists[0];
  result_.wave = result_.finalists[1];
  std::stable_sort(
      result_.finalists.begin(), result_.finalists.end(),
      [](const Candidate& a, const Candidate& b) { return value_of(a.outcome) < value_of(b.outcome); });
  result_.best = result_.finalists.front();
  conclude();
}

void StagedSearch::conclude() {
  const double baseline = std::min(value_of(result_.uniform.outcome), value_of(result_.wave.outcome));
  const double best = value_of(result_.best.outcome);
  result_.beats_baselines = best < baseline;
  const std::string& name = result_.best.name;
  if (!std::isfinite(best)) {
    result_.message = fmt::format("no schedule could be evaluated at fidelity \"{}\"", kReport);
  } else if (!std::isfinite(baseline)) {
    result_.message =
        fmt::format("both baselines failed; the best schedule, {}, has an objective of {:.6g}", name, best);
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
}

}  // namespace

StagedResult staged_search(const SequenceFrame& frame, const StagedOptions& options,
                           const BatchEvaluate& evaluate,
                           const std::function<void(const Progress&)>& progress) {
  return StagedSearch(frame, options, evaluate, progress).run();
}

}  // namespace drapeplan
