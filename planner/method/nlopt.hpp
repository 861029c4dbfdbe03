// Derivative-free searches of NLopt, several side by side, that ask and are told.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "planner/method/method.hpp"

namespace drapeplan {

enum class NloptAlgorithm {
  cobyla,    ///< linear models on a simplex (Powell): few evaluations, smooth objectives
  sbplx,     ///< Nelder-Mead on subspaces (Rowan): copes with jumps and noise
  bobyqa,    ///< quadratic models (Powell): smooth objectives
  direct_l,  ///< divides the box (Gablonsky, Kelley): global, no start
  crs2,      ///< controlled random search (Kaelo, Ali): global
  isres,     ///< evolution strategy with stochastic ranking (Runarsson, Yao): global
  esch,      ///< evolutionary (da Silva Santos): global
};

/// One independent search.
struct NloptStart {
  Eigen::VectorXd x;  ///< n values in [0, 1]
  NloptAlgorithm algorithm = NloptAlgorithm::cobyla;
  int evaluations = std::numeric_limits<int>::max();  ///< budget of this search
};

struct NloptTrial {
  Eigen::VectorXd x;
  double value = 0;  ///< as it was told; not finite: failed
};

/// Searches from every start, each with its own budget; a batch has one point of each that still goes on, in
/// the order of the starts. One that converges early starts again from its best point with half the step,
/// until its budget is spent or the step is too small. NLopt calls its objective and has no ask: each `ask`
/// plays every search again from its start, with the values that are known, up to the first that is not. That
/// costs microseconds per known value, and nothing beside a drape. A failure is told to NLopt as a finite
/// penalty a little above the worst value of that search so far.
class NloptSearches : public Method {
 public:
  NloptSearches(const std::vector<NloptStart>& starts, std::uint64_t seed);

  const Eigen::MatrixXd& ask() override;
  void tell(const Eigen::VectorXd& values) override;
  [[nodiscard]] std::string stop_reason() const override;

  /// All points of a search and their values, in the order of evaluation.
  [[nodiscard]] const std::vector<NloptTrial>& trials(size_t search) const { return runs_[search].trials; }

 private:
  struct Run {
    NloptStart start;
    std::vector<NloptTrial> trials;
    bool ended = false;
  };
  std::vector<Run> runs_;
  std::vector<size_t> asked_;  ///< searches that the columns of the last batch belong to
  Eigen::MatrixXd batch_;
  std::uint64_t seed_;
};

}  // namespace drapeplan
