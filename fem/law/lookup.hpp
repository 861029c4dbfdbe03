// A curve resampled on equal intervals, so that lanes look it up without branches.
#pragma once

#include <functional>
#include <vector>

#include "fem/core/lanes.hpp"

namespace drapeplan {

/// Piecewise linear function on equal intervals; beyond them the last piece goes on. Zero is a grid point and
/// maps to zero exactly, so a kink there (tension against compression) is kept.
class Lookup {
 public:
  Lookup() = default;

  /// Samples f on `intervals` pieces of [lower, upper]; the grid is shifted by less than one piece so that
  /// zero is on it.
  Lookup(const std::function<double(double)>& f, double lower, double upper, int intervals);

  [[nodiscard]] double operator()(double at) const {
    const size_t k = piece(at);
    return line_[2 * k] + line_[2 * k + 1] * at;
  }
  DRAPEPLAN_INLINE [[nodiscard]] Lanes operator()(const Lanes& at) const {
    namespace stdx = std::experimental;
    const Lanes place = stdx::clamp((at - Lanes(lower_)) * Lanes(per_step_), Lanes(0.0), Lanes(last_));
    Lanes intercept, slope;
    load_pairs(line_.data(), place, intercept, slope);
    return intercept + slope * at;
  }
  /// Steepest slope within kLookAhead pieces of `at`: what a stable step must carry until it is chosen anew.
  [[nodiscard]] Lanes steepest_near(const Lanes& at) const {
    namespace stdx = std::experimental;
    const Lanes place = stdx::clamp((at - Lanes(lower_)) * Lanes(per_step_), Lanes(0.0), Lanes(last_));
    return load_entries(steepest_.data(), place);
  }
  static constexpr int kLookAhead = 2;
  /// Integral of the function from 0 to `at`.
  [[nodiscard]] double integral(double at) const;
  /// Steepest piece.
  [[nodiscard]] double largest_slope() const;

  /// The grid, for tables built of several lookups: intercept and slope of each piece; steepest slope near
  /// it; first place; pieces per unit.
  [[nodiscard]] const std::vector<double>& lines() const { return line_; }
  [[nodiscard]] const std::vector<double>& steepest() const { return steepest_; }
  [[nodiscard]] double lower() const { return lower_; }
  [[nodiscard]] double per_step() const { return per_step_; }

 private:
  [[nodiscard]] size_t piece(double at) const {
    const double place = (at - lower_) * per_step_;
    return place > 0 ? size_t(place < last_ ? place : last_) : 0;  // NaN goes to piece 0 and stays NaN
  }
  double lower_ = 0, per_step_ = 1, last_ = 0;  ///< last_: index of the last piece
  std::vector<double> line_;                    ///< intercept and slope of each piece
  std::vector<double> steepest_;                ///< slope near each piece
  std::vector<double> energy_;                  ///< integral from 0 to the start of each piece
};

}  // namespace drapeplan
