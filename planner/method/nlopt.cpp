#include "planner/method/nlopt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>
#include <optional>
#include <stdexcept>

namespace drapeplan {
namespace {

constexpr double kFirstPenalty = 1e3;   // for failures before any success; far above a scaled objective
constexpr double kPenaltyMargin = 0.1;  // of the spread seen so far, above the worst value
// In units of the box's edge: of the first simplex, and where a search ends.
constexpr double kFirstStep = 0.1, kSmallestStep = 2e-3;

nlopt::algorithm algorithm_of(NloptAlgorithm algorithm) {
  switch (algorithm) {
    case NloptAlgorithm::cobyla:
      return nlopt::LN_COBYLA;
    case NloptAlgorithm::sbplx:
      return nlopt::LN_SBPLX;
    case NloptAlgorithm::bobyqa:
      return nlopt::LN_BOBYQA;
    case NloptAlgorithm::direct_l:
      return nlopt::GN_DIRECT_L;
    case NloptAlgorithm::crs2:
      return nlopt::GN_CRS2_LM;
    case NloptAlgorithm::isres:
      return nlopt::GN_ISRES;
    case NloptAlgorithm::esch:
      return nlopt::GN_ESCH;
  }
  throw std::invalid_argument("NloptSearches: no such algorithm");
}

/// Plays a search again: answers what is known, and stops it at the first point that is not.
struct Replay {
  const std::vector<NloptTrial>& known;
  size_t at = 0;
  std::optional<Eigen::VectorXd> next = {};
  int best = -1;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  double penalty() const {
    if (!std::isfinite(highest)) return kFirstPenalty;
    const double spread = std::max(highest - lowest, std::abs(highest) + std::numeric_limits<double>::min());
    return highest + kPenaltyMargin * spread;
  }

  double answer(const std::vector<double>& coordinates) {
    if (at == known.size()) {
      const auto n = Eigen::Index(coordinates.size());
      next = Eigen::Map<const Eigen::VectorXd>(coordinates.data(), n).cwiseMax(0.0).cwiseMin(1.0);
      throw nlopt::forced_stop();
    }
    const double value = known[at].value;
    if (std::isfinite(value)) {
      if (value < lowest) best = int(at);
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    ++at;
    return std::isfinite(value) ? value : penalty();
  }

  static double call(const std::vector<double>& x, std::vector<double>&, void* self) {
    return static_cast<Replay*>(self)->answer(x);
  }
};

/// One call of NLopt: until a point is not known, the budget is spent or the step is below the smallest.
void search_once(Replay& replay, const NloptStart& start, const Eigen::VectorXd& x0, double step) {
  const auto n = unsigned(x0.size());
  nlopt::opt opt(algorithm_of(start.algorithm), n);
  opt.set_min_objective(&Replay::call, &replay);
  opt.set_lower_bounds(0.0);
  opt.set_upper_bounds(1.0);
  opt.set_maxeval(start.evaluations - int(replay.at));
  opt.set_xtol_abs(kSmallestStep);
  std::vector<double> x(x0.data(), x0.data() + n), inward(n);
  for (size_t i = 0; i < n; ++i) inward[i] = x[i] + step <= 1 ? step : -step;
  opt.set_initial_step(inward);
  double value = 0;
  try {
    opt.optimize(x, value);
  } catch (const std::runtime_error&) {  // round-off, or a point that is not known
  }
}

/// The point that a search wants to know next; none if it has ended.
std::optional<Eigen::VectorXd> next_point(const NloptStart& start, const std::vector<NloptTrial>& known,
                                          unsigned long seed) {
  nlopt::srand(seed);  // the state is per thread
  Replay replay{known};
  Eigen::VectorXd x = start.x.cwiseMax(0.0).cwiseMin(1.0);
  for (double step = kFirstStep; step >= kSmallestStep; step *= 0.5) {
    if (int(replay.at) >= start.evaluations) break;
    search_once(replay, start, x, step);
    if (replay.next) return replay.next;
    if (replay.best >= 0) x = known[size_t(replay.best)].x;
  }
  return std::nullopt;
}

}  // namespace

NloptSearches::NloptSearches(const std::vector<NloptStart>& starts, std::uint64_t seed) : seed_(seed) {
  for (const NloptStart& start : starts) runs_.push_back({start, {}, start.evaluations <= 0});
}

const Eigen::MatrixXd& NloptSearches::ask() {
  std::vector<Eigen::VectorXd> points;
  asked_.clear();
  for (size_t k = 0; k < runs_.size(); ++k) {
    Run& run = runs_[k];
    if (run.ended) continue;
    const auto next = next_point(run.start, run.trials, static_cast<unsigned long>(seed_ + k));
    run.ended = !next;
    if (!next) continue;
    asked_.push_back(k);
    points.push_back(*next);
  }
  batch_.resize(points.empty() ? 0 : points.front().size(), Eigen::Index(points.size()));
  for (size_t k = 0; k < points.size(); ++k) batch_.col(Eigen::Index(k)) = points[k];
  return batch_;
}

void NloptSearches::tell(const Eigen::VectorXd& values) {
  if (values.size() != batch_.cols())
    throw std::invalid_argument("NloptSearches::tell: one value per point of the last batch is needed");
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    Run& run = runs_[asked_[size_t(k)]];
    run.trials.push_back({batch_.col(k), values[k]});
    run.ended = int(run.trials.size()) >= run.start.evaluations;
  }
}

std::string NloptSearches::stop_reason() const {
  const bool ended = std::all_of(runs_.begin(), runs_.end(), [](const Run& run) { return run.ended; });
  return ended ? "converged: all searches have ended" : "";
}

}  // namespace drapeplan
