// Local derivative-free searches by NLopt, several side by side.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace drapeplan {

enum class LocalSearch {
  cobyla,  ///< linear models on a simplex (Powell): few evaluations, smooth objectives
  sbplx,   ///< Nelder-Mead on subspaces (Rowan): copes with jumps and noise
};

/// One independent search.
struct NloptStart {
  Eigen::VectorXd x;  ///< n values in [0, 1]
  LocalSearch algorithm = LocalSearch::cobyla;
  int evaluations = 0;  ///< budget of this search
};

struct NloptOptions {
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: OpenMP's default
};

struct NloptTrial {
  Eigen::VectorXd x;
  double value = 0;  ///< as the objective gave it; not finite: failed
};

/// What one search found.
struct NloptRun {
  std::vector<NloptTrial> trials;  ///< in the order of evaluation
  int best = -1;                   ///< index of the best trial; -1 if all failed
};

/// Minimises `objective` over [0, 1]^n from every start, each with its own budget. A search that converges
/// early starts again from its best point with half the step, until the budget is spent or the step is too
/// small. The runs depend on the starts only, not on the number of threads.
/// @param objective  safe to call concurrently. A value that is not finite is a failure: NLopt then sees a
/// finite penalty a little above the worst value of that search so far. An exception ends the search and
/// reaches the caller.
/// @return one run per start, in order. The best is taken from the trials, not from what NLopt returns:
/// COBYLA of 2.7.1 may return its last point.
std::vector<NloptRun> nlopt_search(const std::function<double(const Eigen::VectorXd&)>& objective,
                                   const std::vector<NloptStart>& starts, const NloptOptions& options);

}  // namespace drapeplan
