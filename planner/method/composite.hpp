// A search that learns the fields which an objective is made of, and minimises what they are expected to
// give.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "planner/method/field_model.hpp"

namespace drapeplan {

/// The objective as a function of the fields, for fields that are not far from the given ones.
using ObjectiveNear =
    std::function<std::function<double(const Eigen::VectorXd&)>(const Eigen::VectorXd& fields)>;

/// The points that a search chooses from, [0, 1]^dimension, and the places of a model that they stand for.
struct SearchSpace {
  Eigen::Index dimension = 0;
  std::function<Eigen::VectorXd(const Eigen::VectorXd& point)> place;
  std::function<Eigen::VectorXd(const Eigen::VectorXd& place)> nearest_point;
  /// Whether a point is worth an evaluation: false where it is known to fail. Empty: all are.
  std::function<bool(const Eigen::VectorXd& point)> possible = {};
};

struct CompositeOptions {
  int batch = 4;  ///< two that the model likes best, the others beside them, to learn more
  std::uint64_t seed = 1;
  int threads = 0;  ///< for the model's own work; does not change the result
};

/// Minimises g(f(place)), where f is costly and g is cheap and known: Gaussian processes learn the fields f,
/// and a batch minimises the expected g over a ball around the best observation. The expectation is over the
/// errors of the model, taken from what it misses where one observation is left out: since g has largest
/// values and thresholds, the g of expected fields would be too good to be true.
/// Source: R. Astudillo and P. I. Frazier, "Bayesian Optimization of Composite Functions" (ICML 2019); ball:
/// D. Eriksson et al., "Scalable Global Optimization via Local Bayesian Optimization" (NeurIPS 2019).
/// Deviations: expected value instead of expected improvement, residuals that were seen instead of Gaussian
/// samples; the ball grows when a batch brings a gain and shrinks when it does not.
/// What g does not explain of a value is one more field. So it works without any fields, too: on values.
/// What it hands out depends on what it was told alone, not on threads.
class CompositeSearch {
 public:
  /// @param objective  g.  @param scale  a small difference of each field; empty: there are no fields.
  CompositeSearch(ObjectiveNear objective, Eigen::VectorXd scale, const CompositeOptions& options);

  /// Takes note of a value, of whatever search it is from. A failure (not finite) teaches nothing, nor does
  /// what was seen before, or comes without its fields.
  /// @param level  fidelity, from 0, the cheapest.
  /// @param fields  as many as the scale has.
  void observe(const Eigen::VectorXd& place, int level, const std::vector<float>& fields, double value);

  /// The fidelity that is searched from now on, for its own sake.
  void set_level(int level);
  /// What is searched is what is expected to be best at another fidelity: fields are corrected by the mean of
  /// what they differ by at the places that were seen at both. Without such places nothing is corrected.
  void aim_at(int level);
  /// The ball is the smallest from now on: where few evaluations are to come, no time is left to learn.
  void narrow();
  /// The next batch: points of the space, one column each.
  /// @param count  how many; 0: as the options and the patience of the search say.
  /// @throws std::logic_error if the search is not ready.
  Eigen::MatrixXd ask(const SearchSpace& space, int count = 0);
  /// After a batch was observed: the ball is resized.
  void end_batch();

  [[nodiscard]] bool ready() const;  ///< there are two observations, one at this level
  /// The corrected value of a place that was seen at this level; infinite if it was not.
  [[nodiscard]] double value_at(const Eigen::VectorXd& place) const;
  /// Of the places seen at this level the one with the lowest (corrected) value. @throws std::logic_error if
  /// there is none.
  [[nodiscard]] Eigen::VectorXd best_place() const;

 private:
  /// The model of one batch: what is expected of a place, around the best one.
  struct Expectation;
  [[nodiscard]] double value_of(const Observation& one) const;
  void correct(Eigen::VectorXd correction);
  /// Of those at the searched level the lowest corrected value; null if there is none.
  [[nodiscard]] const Observation* best() const;
  [[nodiscard]] Expectation expectation();
  [[nodiscard]] Eigen::VectorXd minimise(const Expectation& expectation, const SearchSpace& space,
                                         double radius);
  [[nodiscard]] Eigen::VectorXd minimise_over(const Expectation& expectation, const SearchSpace& space,
                                              double radius);
  [[nodiscard]] Eigen::VectorXd beside(const Eigen::VectorXd& point, const SearchSpace& space);

  ObjectiveNear objective_;
  Eigen::VectorXd scale_;
  CompositeOptions options_;
  std::vector<Observation> seen_;
  std::vector<double> corrected_;  ///< their values; of other levels than the searched one as they were
  int level_ = 0;
  Eigen::VectorXd correction_;  ///< of fields, and of what they do not explain; empty: none
  std::optional<Kernel> kernel_;
  size_t kernel_from_ = 0;  ///< how many observations the kernel was chosen from
  int kernel_level_ = 0;
  double radius_;
  double before_ = 0;  ///< best value when the last batch was asked for
  int without_gain_ = 0, batch_ = 0;
  std::mt19937_64 bits_;
};

}  // namespace drapeplan
