#include "planner/search/nlopt.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <nlopt.hpp>

#include "planner/base/parallel.hpp"

namespace drapeplan {
namespace {

using Objective = std::function<double(const Eigen::VectorXd&)>;

constexpr double kFirstPenalty = 1e3;   // for failures before any success; far above a scaled objective
constexpr double kPenaltyMargin = 0.1;  // of the spread seen so far, above the worst value

/// The objective as NLopt sees it: always finite, every trial kept.
struct Recorder {
  const Objective& objective;
  NloptRun& run;
  int budget;
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
    double value = std::numeric_limits<double>::quiet_NaN();
    try {
      value = objective(x);
    } catch (const std::exception&) {  // a failed evaluation is data; NaN stands for it
    }
    if (std::isfinite(value)) {
      if (value < lowest) run.best = int(run.trials.size());
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    run.trials.push_back({x, value});
    return std::isfinite(value) ? value : penalty();
  }

  static double call(const std::vector<double>& x, std::vector<double>&, void* self) {
    return static_cast<Recorder*>(self)->evaluate(x);
  }
  int left() const { return budget - int(run.trials.size()); }
};

/// One call of NLopt; returns why it stopped.
std::string search_once(Recorder& recorder, LocalSearch algorithm, const Eigen::VectorXd& x0, double step,
                        double smallest_step) {
  const auto n = unsigned(x0.size());
  nlopt::opt opt(algorithm == LocalSearch::cobyla ? nlopt::LN_COBYLA : nlopt::LN_SBPLX, n);
  opt.set_min_objective(&Recorder::call, &recorder);
  opt.set_lower_bounds(0.0);
  opt.set_upper_bounds(1.0);
  opt.set_maxeval(recorder.left());
  opt.set_xtol_abs(smallest_step);
  std::vector<double> x(x0.data(), x0.data() + n), inward(n);
  for (size_t i = 0; i < n; ++i) inward[i] = x[i] + step <= 1 ? step : -step;
  opt.set_initial_step(inward);
  double value = 0;
  try {
    const nlopt::result result = opt.optimize(x, value);
    return result == nlopt::MAXEVAL_REACHED ? "budget spent" : "step below the smallest";
  } catch (const nlopt::roundoff_limited&) {
    return "limited by round-off";
  } catch (const std::exception& error) {
    return std::string("NLopt: ") + error.what();
  }
}

NloptRun search(const Objective& objective, const NloptStart& start, const NloptOptions& options) {
  NloptRun run;
  run.stop_reason = "no budget";
  Recorder recorder{objective, run, start.evaluations};
  Eigen::VectorXd x = start.x.cwiseMax(0.0).cwiseMin(1.0);
  for (double step = options.first_step; recorder.left() > 0 && step >= options.smallest_step; step *= 0.5) {
    run.stop_reason = search_once(recorder, start.algorithm, x, step, options.smallest_step);
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
    runs[size_t(i)] = search(objective, starts[size_t(i)], options);
  };
  parallel_for(int(starts.size()), one, options.threads);
  return runs;
}

}  // namespace drapeplan
