#include "planner/search/budget.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "planner/drape/problem.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Budget::Budget(const OptimiseOptions& options, std::function<void(const Progress&)> progress)
    : options_(options), progress_(std::move(progress)) {}

void Budget::count(const std::string& stage, const std::string& fidelity,
                   const std::vector<Outcome>& outcomes, bool report) {
  Kind& kind = kinds_.try_emplace(fidelity, Kind{.best = kInfinity}).first->second;
  longest_ = 0;
  if (searched_ + reported_ == 0 && !outcomes.empty())
    begin_ = std::max(outcomes.front().elapsed - outcomes.front().wall_seconds, 0.0);
  for (const Outcome& outcome : outcomes) {
    kind.best = std::min(kind.best, value_of(outcome));
    ++(report ? reported_ : searched_);
    ++kind.runs;
    kind.seconds += outcome.wall_seconds;
    if (outcome.score.valid) {  // the parts of a failed score are not logged
      kind.duration += outcome.score.duration;
      longest_ = std::max(longest_, outcome.score.duration);
    }
    elapsed_ = std::max(elapsed_, outcome.elapsed);
  }
  if (progress_) progress_(progress(stage, kind));
}

void Budget::reserve(int runs, int at_a_time) {
  reserved_ = reported_ + runs;
  at_a_time_ = at_a_time;
}

bool Budget::holds(int reports) const {
  return options_.evaluations > 0 || elapsed_ + time_of_reports(reports) <= options_.budget;
}

double Budget::rate() const {
  double seconds = 0;
  for (const auto& [fidelity, kind] : kinds_) seconds += kind.seconds;
  return seconds > 0 ? std::min((elapsed_ - begin_) / seconds, 1.0) : 1;
}

/// A report costs in proportion to the schedule's length, and the finalists will be as long as what is
/// searched now. The last core to finish decides: one more than their share.
double Budget::time_of_reports(int count) const {
  const auto report = kinds_.find(kReport);
  if (count <= 0 || report == kinds_.end() || !(report->second.duration > 0)) return 0;
  const double each = report->second.seconds / report->second.duration * longest_;
  const double rate = std::max(this->rate(), 1.0 / at_a_time_);
  return (count * rate + (1 - rate)) * each;
}

double Budget::reports_to_come() const {
  return time_of_reports(reserved_ - reported_);
}

double Budget::limit() const {
  return options_.budget - reports_to_come();
}

double Budget::spent() const {
  if (options_.evaluations > 0) return double(searched_) / options_.evaluations;
  const double whole = limit();
  return whole > 0 ? elapsed_ / whole : kInfinity;
}

int Budget::affords(double share, const std::string& fidelity) const {
  if (options_.evaluations > 0) return int(std::max(share, 0.0) * options_.evaluations);
  const auto kind = kinds_.find(fidelity);
  if (kind == kinds_.end() || !(kind->second.seconds > 0)) return 0;
  const double each = kind->second.seconds / kind->second.runs * rate();
  return int(std::clamp(share * limit() / each, 0.0, 1e9));
}

Progress Budget::progress(const std::string& stage, const Kind& kind) const {
  Progress p{.stage = stage,
             .done = searched_ + reported_,
             .best = kind.best,
             .seconds_left = std::numeric_limits<double>::quiet_NaN()};
  if (options_.evaluations == 0) {
    p.seconds_left = std::max(options_.budget - elapsed_, 0.0);
    return p;
  }
  const int left = std::max(options_.evaluations - searched_, 0);
  p.planned = p.done + left + std::max(reserved_ - reported_, 0);
  if (kind.runs > 0) p.seconds_left = left * kind.seconds / kind.runs * rate();
  p.seconds_left += reports_to_come();
  return p;
}

}  // namespace drapeplan
