// A statistical model of many fields at once, as functions of a place: what a search knows of what it has
// seen.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace drapeplan {

/// What was seen at a place.
struct Observation {
  Eigen::VectorXd place;
  int level = 0;           ///< of fidelity, 0 is the cheapest
  Eigen::VectorXd fields;  ///< as many for every observation
  double value = 0;        ///< finite
};

/// What the kernel of a model is made of; see FieldModel.
struct Kernel {
  double linear = 0.6;  ///< share of the variance, [0, 1]
  double length = 1;    ///< of the other share, in medians of the distances between observations
  double noise = 0.02;  ///< variance over that of the fields
  double shared = 1;    ///< of what levels have in common, [0, 1]
};

/// Gaussian processes with one kernel for all fields, of their principal components. Of two observations with
/// places a, b and levels p, q the covariance is
///   (linear c a.b + (1 - linear) exp(-|a - b|^2 / (2 length^2))) (p = q ? 1 : shared) + (p = q ? 1 : 0)
/// where a and b are taken from the mean place, c makes the mean of c a.a one, and the last summand, an
/// offset of each level, is there with several levels only. Source: C. E. Rasmussen and C. K. I. Williams,
/// "Gaussian Processes for Machine Learning" (2006), eqs. 2.25, 2.26 (prediction), 5.10 to 5.12 (leaving one
/// out). Deviation: the kernel is the one of a small grid whose predictions are best where one is left out,
/// not the most likely one.
class FieldModel {
 public:
  struct Prediction {
    Eigen::VectorXd fields;
    double spread = 0;  ///< standard deviation, noise included, over that of the fields as observed
  };
  struct Miss {
    Eigen::VectorXd fields;  ///< as observed, less as predicted
    double spread = 0;       ///< of the prediction
  };

  /// @param observations  two or more.
  /// @param scale    a small difference of each field: principal components are those of fields over it.
  /// @param level    whose fields are predicted.
  /// @param kernel   null: the best of the grid; else this one, which saves most of the time.
  /// @param threads  see parallel_for; does not change the result.
  FieldModel(const std::vector<const Observation*>& observations, const Eigen::VectorXd& scale, int level,
             const Kernel* kernel, int threads);

  [[nodiscard]] Prediction predict(const Eigen::VectorXd& place) const;
  /// What all other observations miss at one.
  [[nodiscard]] Miss left_out(Eigen::Index observation) const;
  [[nodiscard]] const Kernel& kernel() const { return kernel_; }
  /// Share of the variance of the fields that predictions miss where one is left out.
  [[nodiscard]] double missed() const { return missed_; }

 private:
  void reduce(const Eigen::MatrixXd& fields);
  void choose_kernel(int threads);
  [[nodiscard]] Eigen::MatrixXd inverse_covariance(const Kernel& kernel) const;
  [[nodiscard]] double missed_by(const Eigen::MatrixXd& inverse) const;

  Kernel kernel_;
  double missed_ = 0;
  Eigen::MatrixXd places_;  ///< from their mean, one column each
  Eigen::VectorXd mean_place_;
  double place_square_ = 1, typical_distance2_ = 1;  ///< mean of |a|^2; median of |a - b|^2
  std::vector<int> levels_;
  int level_ = 0;
  bool several_levels_ = false;
  Eigen::MatrixXd fields_;      ///< as given, one column each
  Eigen::VectorXd mean_;        ///< of the fields
  Eigen::MatrixXd basis_;       ///< principal components, in units of the fields
  Eigen::MatrixXd components_;  ///< one row per observation
  double variance_ = 1;         ///< of all components together, per observation
  Eigen::MatrixXd inverse_;     ///< of the covariance
  Eigen::MatrixXd weights_;     ///< inverse times components
};

}  // namespace drapeplan
