#include "fem/law/lookup.hpp"

#include <algorithm>
#include <cmath>

namespace drapeplan {

Lookup::Lookup(const std::function<double(double)>& f, double lower, double upper, int intervals) {
  const double step = (upper - lower) / intervals;
  const int below = int(std::ceil(-lower / step));  // pieces left of zero
  per_step_ = 1 / step;
  lower_ = -below * step;
  last_ = intervals - 1;
  const auto at = [&](int k) { return (k - below) * step; };
  double sum = 0;
  for (int k = 0; k < intervals; ++k) {
    const double left = f(at(k)), right = f(at(k + 1));
    const double slope = (right - left) / step;
    // Next to zero the piece is pinned to the origin, so that no strain gives exactly no stress.
    const double intercept = (k == below || k == below - 1) ? 0 : left - slope * at(k);
    line_.push_back(intercept);
    line_.push_back(slope);
    energy_.push_back(sum);
    sum += 0.5 * (left + right) * step;
  }
  const double origin = below < intervals ? energy_[size_t(below)] : sum;
  for (double& e : energy_) e -= origin;
  for (int k = 0; k < intervals; ++k) {
    double steepest = 0;
    for (int l = std::max(0, k - kLookAhead); l <= std::min(intervals - 1, k + kLookAhead); ++l)
      steepest = std::max(steepest, std::abs(line_[2 * size_t(l) + 1]));
    steepest_.push_back(steepest);
  }
}

double Lookup::integral(double at) const {
  const size_t k = piece(at);
  const double start = lower_ + double(k) / per_step_;
  const double intercept = line_[2 * k], slope = line_[2 * k + 1];
  return energy_[k] + (at - start) * (intercept + 0.5 * slope * (at + start));
}

double Lookup::largest_slope() const {
  double largest = 0;
  for (size_t k = 1; k < line_.size(); k += 2) largest = std::max(largest, line_[k]);
  return largest;
}

}  // namespace drapeplan
