// Figures of samples: ranks and their correlation, noise of a function, orders of convergence.
#pragma once

#include <vector>

namespace drapeplan {

/// The middle value, the mean of both middle ones for an even count; NaN of nothing.
double median(std::vector<double> values);

/// Rank of each value from 1, ascending; equal values share the mean of their ranks.
std::vector<double> ranks(const std::vector<double>& values);

/// Spearman's rank correlation: Pearson's of the ranks, in [-1, 1]. NaN for fewer than two values, or where
/// all of one list are equal.
/// @throws std::invalid_argument if the lists differ in length or hold a NaN.
double spearman(const std::vector<double>& a, const std::vector<double>& b);

/// Kendall's tau-b, in [-1, 1]: pairs in the same order minus pairs in the opposite one, over the pairs, with
/// the usual correction for ties. NaN and errors as above.
double kendall(const std::vector<double>& a, const std::vector<double>& b);

/// Noise of a function, as a standard deviation, from its values at equally spaced points close together.
struct NoiseEstimate {
  double noise = 0;
  int level = 0;  ///< of differences that it was read from
  bool consistent =
      false;  ///< three levels agree within a factor of four; else `noise` is the smallest level's
};

/// ECnoise (J. J. More and S. M. Wild, "Estimating computational noise", SIAM J. Sci. Comput. 33, 2011): k-th
/// differences remove what is smooth, and (k!)^2 / (2k)! of their mean square is the variance of the noise.
/// @param values  at least four (seven in their paper), finite.
/// @throws std::invalid_argument for fewer.
NoiseEstimate difference_noise(const std::vector<double>& values);

/// Order p of errors against a reference that was itself made at a size r > 0: the p for which error /
/// (size^p - r^p) varies least (in its logarithm); with r = 0 the slope of log(error) over log(size). Pairs
/// that are not finite, whose error is not > 0 or whose size is not above r are left out. NaN for fewer than
/// two; p is sought up to 8.
double observed_order(const std::vector<double>& size, const std::vector<double>& error, double r = 0);

/// Indices of the points that no other one beats in both (smaller is better), by increasing cost.
std::vector<int> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

}  // namespace drapeplan
