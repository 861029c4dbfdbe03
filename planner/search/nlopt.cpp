#include "planner/search/nlopt.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <nlopt.hpp>
#include <stdexcept>

#include "planner/base/parallel.hpp"

namespace drapeplan {
namespace {

using Objective = std::function<double(const Eigen::VectorXd&)>;

constexpr double kFirstPenalty = 1e3;   // for failures before any success; far above a scaled objective
constexpr double kPenaltyMargin = 0.1;  // of the spread seen so far, above the worst value
// In units of the box's edge: of the first simplex, and where a search ends.
constexpr double kFirstStep = 0.1, kSmallestStep = 2e-3;

/// The objective as NLopt sees it: always finite, every trial kept.
struct Recorder {
  const Objective& objective;
  NloptRun& run;
  int budget;
  std::exception_ptr fault = nullptr;  ///< what the objective threw
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  double penalty() const {
    if (!std::isfinite(highest)) return kFirstPenalty;
    const double spread = std::max(highest - lowest, std::abs(highest) + std::numeric_limits<double>::min());
    return highest + kPenaltyMargin * spread;
  }

  double evaluate(const std::vector<double>& coordinates) {
    Eigen::VectorXd x =
        Eigen::Map<const Eigen::VectorXd>(coordinates.data(), Eigen::Index(coordinates.size()));
    x = x.cwiseMax(0.0).cwiseMin(1.0);
    const double value = objective(x);
    if (std::isfinite(value)) {
      if (value < lowest) run.best = int(run.trials.size());
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    run.trials.push_back({x, value});
    return std::isfinite(value) ? value : penalty();
  }

  /// An exception cannot pass NLopt: it is kept, and the search ends.
  static double call(const std::vector<double>& x, std::vector<double>&, void* self) {
    auto& recorder = *static_cast<Recorder*>(self);
    try {
      return recorder.evaluate(x);
    } catch (...) {
      recorder.fault = std::current_exception();
      throw nlopt::forced_stop();
    }
  }
  int left() const { return budget - int(run.trials.size()); }
};

/// One call of NLopt: until the budget is spent or the step is below the smallest.
void search_once(Recorder& recorder, LocalSearch algorithm, const Eigen::VectorXd& x0, double step) {
  const auto n = unsigned(x0.size());
  nlopt::opt opt(algorithm == LocalSearch::cobyla ? nlopt::LN_COBYLA : nlopt::LN_SBPLX, n);
  opt.set_min_objective(&Recorder::call, &recorder);
  opt.set_lower_bounds(0.0);
  opt.set_upper_bounds(1.0);
  opt.set_maxeval(recorder.left());
  opt.set_xtol_abs(kSmallestStep);
  std::vector<double> x(x0.data(), x0.data() + n), inward(n);
  for (size_t i = 0; i < n; ++i) inward[i] = x[i] + step <= 1 ? step : -step;
  opt.set_initial_step(inward);
  double value = 0;
  try {
    opt.optimize(x, value);
  } catch (const std::runtime_error&) {  // round-off, or the objective threw: what was tried is kept
  }
  if (recorder.fault) std::rethrow_exception(recorder.fault);
}

NloptRun search(const Objective& objective, const NloptStart& start) {
  NloptRun run;
  Recorder recorder{objective, run, start.evaluations};
  Eigen::VectorXd x = start.x.cwiseMax(0.0).cwiseMin(1.0);
  for (double step = kFirstStep; recorder.left() > 0 && step >= kSmallestStep; step *= 0.5) {
    search_once(recorder, start.algorithm, x, step);
    if (run.best >= 0) x = run.trials[size_t(run.best)].x;
  }
  return run;
}

}  // namespace

std::vector<NloptRun> nlopt_search(const Objective& objective, const std::vector<NloptStart>& starts,
                                   const NloptOptions& options) {
  std::vector<NloptRun> runs(starts.size());
  const auto one = [&](int i) {
    nlopt::srand(static_cast<unsigned long>(options.seed) +
                 static_cast<unsigned long>(i));  // state is per thread
    runs[size_t(i)] = search(objective, starts[size_t(i)]);
  };
  parallel_for(int(starts.size()), one, options.threads);
  return runs;
}

}  // namespace drapeplan
