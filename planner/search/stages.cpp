#include "planner/search/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "planner/base/statistics.hpp"
#include "planner/drape/problem.hpp"
#include "planner/method/nlopt.hpp"
#include "planner/schedule/check.hpp"
#include "planner/schedule/families.hpp"
#include "planner/search/finalists.hpp"
#include "planner/search/interrupted.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// NLopt searches side by side, from as many of the screened waves: waves end in different valleys, and not in the order
/// in which they begin. Each has twice what COBYLA needs to look into every direction once.
constexpr int kFewestSearches = 2, kMostSearches = 6;
/// Shares of the budget after the waves at which parts of the search end: COBYLA and the composite search
/// over smooth strokes, and the latter over all grippers at the cheaper fidelities (each in so many equal
/// parts, with a check after each).
constexpr double kCobylaEnd = 0.08, kSmoothEnd = 0.16, kScreenEnd = 0.5;
/// Share at which the best are reported for the first time: what follows aims at the reporting fidelity.
constexpr double kFirstReports = 0.75;
/// Batches over smooth strokes without a gain after which that is all they have to give.
constexpr int kSmoothPatience = 12;
/// Batches that bring nothing new after which there is nothing new.
constexpr int kIdle = 10;
constexpr int kScreenParts = 3;
/// Share of a budget of time that is kept for reports, if that is more than the finalists need; so many are
/// evaluated at a time.
constexpr double kReportShare = 0.15;
constexpr int kReportBatch = 2;
/// So many schedules are compared at two fidelities; where Spearman's correlation of their ranks is below,
/// the cheaper one is left. They are spread over the ranks of the last so many.
constexpr size_t kCompared = 8, kComparedOf = 60;
constexpr double kTrustedCorrelation = 0.7;

bool better(const Trial& a, const Trial& b) {
  return a.objective() < b.objective();
}

class StagedSearch {
 public:
  StagedSearch(const SequenceFrame& frame, const StagedOptions& options, const BatchEvaluate& evaluate,
               const std::function<void(const Progress&)>& progress)
      : frame_(frame),
        options_(options),
        evaluate_(evaluate),
        budget_(options.optimise, progress),
        smooth_(frame, {}),
        grippers_(frame, {.start = Spread::each, .height = Spread::each}),
        search_(options.objective_near, options.field_scale,
                {.seed = options.optimise.seed, .threads = options.threads}) {}

  StagedResult run() {
    compare({{"uniform", uniform_strokes(frame_)}, {"wave", wave_strokes(frame_)}}, "baseline");
    result_.uniform = result_.finalists[0];
    result_.wave = result_.finalists[1];
    if (options_.kept)
      budget_.keep(
          options_.kept(std::max(result_.uniform.outcome.wall_seconds, result_.wave.outcome.wall_seconds)));
    reports_ = options_.optimise.finalists + kExpected;
    if (options_.optimise.evaluations == 0)
      reports_ = std::max(reports_, budget_.affords(kReportShare, kReport));
    budget_.reserve(reports_, kReportBatch);
    try {
      search_waves();
      if (best_at(options_.ladder.front())->ran()) {
        search_smooth();
        search_grippers();
      }
      search_reports();
      conclude(result_);
    } catch (const Interrupted&) {
      conclude_early();
    }
    return std::move(result_);
  }

 private:
  static constexpr int kExpected = 1;  ///< one more finalist: what the model expects to be best

  void search_waves();
  void search_smooth();
  void search_grippers();
  void search_until(double share, const StrokeFamily& family, size_t rung, const std::string& stage,
                    int patience = std::numeric_limits<int>::max());
  bool climb(size_t rung);
  double compare_fidelities(size_t rung);
  Eigen::VectorXd try_points(const Eigen::MatrixXd& points, const StrokeFamily& family, size_t rung,
                             const std::string& stage);
  SearchSpace space_of(const StrokeFamily& family) const;
  int level_of(const std::string& fidelity) const;
  double spent() const { return (budget_.spent() - begin_) / (1 - begin_); }
  void search_reports();
  void report_best();
  void compare(std::vector<Trial> trials, const std::string& stage);

  Schedule schedule_of(const Trial& trial) const { return to_schedule(frame_, trial.strokes); }
  std::vector<Outcome> evaluate(std::vector<Trial>& trials, const std::string& fidelity,
                                const std::string& stage, bool report = false);
  void record(const Trial& trial, const std::string& fidelity, const std::string& stage);
  const Trial* best_at(const std::string& fidelity) const;
  void conclude_early();

  const SequenceFrame& frame_;
  const StagedOptions& options_;
  const BatchEvaluate& evaluate_;
  Budget budget_;
  std::map<std::string, std::vector<Trial>> trials_;  // per fidelity, in the order of evaluation
  double begin_ = 0;                                  // share of the budget that was spent on the waves
  StrokeFamily smooth_, grippers_;                    // places of the search are those of the latter
  CompositeSearch search_;
  int reports_ = 0;  ///< that are made, beside the baselines
  int made_ = 0;     ///< of them so far
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
    trials[k].standing = {value_of(outcomes[k]), outcomes[k].score.followed};
    trials[k].lag = outcomes[k].score.max_lag;
    record(trials[k], fidelity, stage);
    // A baseline may lie outside of what is searched: it would be learned at a place that is not its own.
    const Eigen::VectorXd place = grippers_.encode(trials[k].strokes);
    if (nearly_equal(to_schedule(frame_, grippers_.decode(place)), schedules[k]))
      search_.observe(place, level_of(fidelity), outcomes[k].fields, trials[k].objective());
  }
  return outcomes;
}

void StagedSearch::record(const Trial& trial, const std::string& fidelity, const std::string& stage) {
  double& best = best_.try_emplace(fidelity, kInfinity).first->second;
  best = std::min(best, trial.objective());
  HistoryEntry entry;
  entry.number = int(result_.history.size()) + 1;
  entry.stage = stage;
  entry.fidelity = fidelity;
  entry.schedule_hash = schedule_hash(schedule_of(trial));
  entry.objective = trial.objective();
  entry.valid = trial.ran();
  entry.best_so_far = best;
  if (seen_.insert({entry.schedule_hash, fidelity}).second) {
    ++result_.evaluations;
    result_.failed_evaluations += entry.valid ? 0 : 1;
  }
  result_.history.push_back(std::move(entry));
  trials_[fidelity].push_back(trial);
}

/// Baselines and waves, as many as an evaluation budget holds.
void StagedSearch::search_waves() {
  std::vector<Trial> trials{{"uniform", uniform_strokes(frame_)}, {"wave", wave_strokes(frame_)}};
  const WaveFamily family(frame_);
  std::vector<Eigen::VectorXd> waves = family.spread();
  if (options_.wave.size() > 0) waves.insert(waves.begin(), options_.wave);
  for (const Eigen::VectorXd& x : waves) {
    const int most = options_.optimise.evaluations;
    if (most > 0 && int(trials.size()) >= most) break;
    trials.push_back({fmt::format("wave {}", trials.size() + 1), family.decode(x)});
  }
  evaluate(trials, options_.ladder.front(), "wave");
  begin_ = std::min(budget_.spent(), 0.99);
}

const Trial* StagedSearch::best_at(const std::string& fidelity) const {
  const auto list = trials_.find(fidelity);
  if (list == trials_.end() || list->second.empty()) return nullptr;
  return &*std::min_element(list->second.begin(), list->second.end(), better);
}

SearchSpace StagedSearch::space_of(const StrokeFamily& family) const {
  return {family.dimension(),
          [&](const Eigen::VectorXd& point) { return grippers_.encode(family.decode(point)); },
          [&](const Eigen::VectorXd& place) { return family.encode(grippers_.decode(place)); },
          [&](const Eigen::VectorXd& point) {
            return rig_refusals(to_schedule(frame_, family.decode(point)), frame_.rig).empty();
          }};
}

/// @return their objectives.
Eigen::VectorXd StagedSearch::try_points(const Eigen::MatrixXd& points, const StrokeFamily& family,
                                         size_t rung, const std::string& stage) {
  std::vector<Trial> trials;
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    const size_t number = result_.history.size() + size_t(k) + 1;
    trials.push_back({fmt::format("{} {}", stage, number), family.decode(points.col(k))});
  }
  evaluate(trials, options_.ladder[rung], stage);
  Eigen::VectorXd values(points.cols());
  for (Eigen::Index k = 0; k < points.cols(); ++k) values[k] = trials[size_t(k)].objective();
  return values;
}

/// COBYLA from the best waves is ahead of all others at first; then the model has seen enough.
void StagedSearch::search_smooth() {
  const std::string& fidelity = options_.ladder.front();
  std::vector<Trial> waves = trials_[fidelity];
  std::stable_sort(waves.begin(), waves.end(), better);
  const int budget = budget_.affords(kCobylaEnd * (1 - begin_), fidelity);
  const int each = 2 * (int(smooth_.dimension()) + 1);
  const int count = std::min(std::clamp(budget / each, kFewestSearches, kMostSearches), int(waves.size()));
  std::vector<NloptStart> starts;
  for (int k = 0; k < count; ++k) {
    starts.push_back({.x = smooth_.encode(waves[size_t(k)].strokes), .evaluations = (budget + k) / count});
  }
  NloptSearches cobyla(starts, options_.optimise.seed);
  while (spent() < kCobylaEnd && cobyla.stop_reason().empty()) {
    const Eigen::MatrixXd points = cobyla.ask();
    if (points.cols() == 0) break;
    cobyla.tell(try_points(points, smooth_, 0, "smooth"));
  }
  search_until(kSmoothEnd, smooth_, 0, "smooth", kSmoothPatience);
}

/// Also ends after so many batches without a gain, and where all that is asked for is known: a space of one
/// schedule has no more to give, and costs no time.
void StagedSearch::search_until(double share, const StrokeFamily& family, size_t rung,
                                const std::string& stage, int patience) {
  const std::string& fidelity = options_.ladder[rung];
  search_.set_level(int(rung));
  search_.aim_at(int(rung) + 1);
  for (int stale = 0, idle = 0; spent() < share && search_.ready() && stale < patience && idle < kIdle;) {
    const double before = best_[fidelity];
    const int known = result_.evaluations;
    try_points(search_.ask(space_of(family)), family, rung, stage);
    search_.end_batch();
    stale = best_[fidelity] < before ? 0 : stale + 1;
    idle = result_.evaluations > known ? 0 : idle + 1;
  }
}

void StagedSearch::search_grippers() {
  size_t rung = 0;
  while (rung + 1 < options_.ladder.size() && climb(rung)) ++rung;
  search_until(kFirstReports, grippers_, rung, "gripper");
  report_best();
  search_until(1, grippers_, rung, "gripper");
}

/// Searches at one fidelity until its ranks are no longer those of the next one, or its share is spent.
/// @return  there is something to go on from at the next one.
bool StagedSearch::climb(size_t rung) {
  const double begin = spent();
  for (int part = 1; part <= kScreenParts && spent() < 1; ++part) {
    const int known = result_.evaluations;
    search_until(begin + (kScreenEnd - begin) * part / kScreenParts, grippers_, rung, "gripper");
    if (part > 1 && result_.evaluations == known) break;
    // A correlation that is not defined is not trusted.
    if (spent() < 1 && !(compare_fidelities(rung) >= kTrustedCorrelation)) break;
  }
  const Trial* best = best_at(options_.ladder[rung + 1]);
  return best != nullptr && best->ran();
}

/// Evaluates some of the better recent schedules of a fidelity at the next one, too.
/// @return Spearman's correlation of their ranks, corrected by what they differ by; NaN if there is none.
double StagedSearch::compare_fidelities(size_t rung) {
  const std::vector<Trial>& here = trials_[options_.ladder[rung]];
  std::vector<Trial> recent(here.end() - std::ptrdiff_t(std::min(here.size(), kComparedOf)), here.end());
  std::stable_sort(recent.begin(), recent.end(), better);
  const size_t half = (recent.size() + 1) / 2, count = std::min(half, kCompared);
  std::vector<Trial> chosen;
  for (size_t k = 0; k < count; ++k)
    chosen.push_back(recent[count > 1 ? k * (half - 1) / (count - 1) : 0]);
  evaluate(chosen, options_.ladder[rung + 1], "gripper");
  search_.aim_at(int(rung) + 1);
  std::vector<double> before, after;
  for (const Trial& trial : chosen) {
    before.push_back(search_.value_at(grippers_.encode(trial.strokes)));
    after.push_back(trial.objective());
  }
  return spearman(before, after);
}

/// Evaluates the best of the search at the reporting fidelity. The first time these are the best where they were
/// searched; then what they have taught is used.
void StagedSearch::report_best() {
  const int count = std::min(options_.optimise.finalists - made_, kReportBatch);
  if (count <= 0) return;
  std::vector<const std::vector<Trial>*> lists;
  std::vector<Trial> expected;
  if (made_ > 0 && search_.ready()) {
    const std::string name = fmt::format("report {}", result_.history.size() + 1);
    expected.push_back({name, grippers_.decode(search_.best_place()), {0, true}});
    lists.push_back(&expected);
  }
  for (auto fidelity = options_.ladder.rbegin(); fidelity != options_.ladder.rend(); ++fidelity)
    lists.push_back(&trials_[*fidelity]);
  std::vector<Schedule> known;
  for (const Candidate& candidate : result_.finalists) known.push_back(candidate.schedule);
  std::vector<Trial> trials = pick_finalists(frame_, lists, std::move(known), count);
  made_ += int(trials.size());
  compare(std::move(trials), "report");
}

/// The reporting fidelity is the last step of the ladder: first the best of the search are evaluated there,
/// then what the model, which has seen these, expects to be best there.
void StagedSearch::search_reports() {
  const int least = options_.optimise.finalists + kExpected;
  report_best();
  search_.set_level(level_of(kReport));
  search_.narrow();
  while (made_ < reports_ && search_.ready()) {
    const int count = std::min(reports_ - made_, kReportBatch);
    if (made_ >= least && !budget_.holds(count)) break;
    const Eigen::MatrixXd points = search_.ask(space_of(grippers_), count);
    made_ += count;
    std::vector<Trial> trials;
    for (Eigen::Index k = 0; k < points.cols(); ++k)
      trials.push_back({fmt::format("report {}", result_.history.size() + size_t(k) + 1),
                        grippers_.decode(points.col(k))});
    compare(std::move(trials), "report");
    search_.end_batch();
  }
}

int StagedSearch::level_of(const std::string& fidelity) const {
  return int(std::find(options_.ladder.begin(), options_.ladder.end(), fidelity) - options_.ladder.begin());
}

void StagedSearch::compare(std::vector<Trial> trials, const std::string& stage) {
  const std::vector<Outcome> outcomes = evaluate(trials, kReport, stage, true);
  for (size_t k = 0; k < trials.size(); ++k)
    result_.finalists.push_back({trials[k].name, schedule_of(trials[k]), outcomes[k], trials[k].strokes});
}

void StagedSearch::conclude_early() {
  conclude(result_);
  result_.interrupted = true;
  constexpr size_t kBaselines = 2;
  if (result_.finalists.size() > kBaselines && std::isfinite(value_of(result_.best.outcome))) {
    result_.message += "; interrupted, --resume goes on";
    return;
  }
  for (auto fidelity = options_.ladder.rbegin(); fidelity != options_.ladder.rend(); ++fidelity) {
    const std::vector<Trial>& list = trials_[*fidelity];
    const auto best = std::min_element(list.begin(), list.end(), [](const Trial& a, const Trial& b) {
      return ranks_before(a.standing, b.standing);
    });
    if (best == list.end() || !best->ran()) continue;
    result_.best = {best->name, schedule_of(*best), {}, best->strokes};
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
