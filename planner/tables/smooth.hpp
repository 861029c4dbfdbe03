// Curves through measured points: smooth and monotone.
#pragma once

#include <functional>
#include <vector>

namespace drapeplan {

/// Monotone piecewise cubic through points: continuous slope, no value outside those of the two neighbours.
/// Beyond its ends it goes on straight. Source: F. N. Fritsch and J. Butland, "A method for constructing
/// local monotone piecewise cubic interpolants" (SIAM J. Sci. Stat. Comput. 5, 1984).
class MonotoneCubic {
 public:
  /// @param x  increasing, two values at least.
  /// @throws std::invalid_argument else.
  MonotoneCubic(std::vector<double> x, std::vector<double> y);
  [[nodiscard]] double operator()(double x) const;
  [[nodiscard]] double slope(double x) const;
  /// The last place.
  [[nodiscard]] double end() const { return x_.back(); }

 private:
  [[nodiscard]] size_t piece(double x) const;
  std::vector<double> x_, y_, slopes_;
};

/// The values that do not decrease and are nearest to the given ones in the sense of weighted least squares.
/// Source: R. E. Barlow and others, "Statistical inference under order restrictions" (1972): neighbours in
/// the wrong order are pooled.
std::vector<double> not_decreasing(const std::vector<double>& values, const std::vector<double>& weights);

/// Value of y at a value of x, straight between points; that of the end beyond the ends, and the first one that
/// is met where x stands still. @param x  not decreasing, as many as y, two at least.
double value_between(const std::vector<double>& x, const std::vector<double>& y, double at);

/// Values at knots of the piecewise linear curve that fits points best (least squares). Knots that no point
/// lies near are kept from running away by a small price on second differences.
/// @param knots  increasing.  @param first  the value at the first knot, which is not fitted.
/// @throws std::invalid_argument for fewer than two knots, or points of different number.
std::vector<double> fit_at_knots(const std::vector<double>& x, const std::vector<double>& y,
                                 const std::vector<double>& knots, double first);

/// Root mean square of what a curve misses at points.
double rms_miss(const std::vector<double>& x, const std::vector<double>& y,
                const std::function<double(double)>& curve);

}  // namespace drapeplan
