#include "fem/law/rates.hpp"

#include <algorithm>
#include <cmath>

#include "fem/law/lookup.hpp"

namespace drapeplan {
namespace {

/// Of octaves(1 + rate / floor), between the slowest and the fastest curve. A kink of the law at a rate
/// between two rows is missed by a quarter of a row at most: 1 % of the difference between the curves.
constexpr int kRateIntervals = 32;

}  // namespace

RateLookup::RateLookup(const std::function<double(double, double)>& f, double lower, double upper,
                       int intervals, double floor, double fastest)
    : per_rate_step_(kRateIntervals / octaves(Lanes(1 + fastest / floor))[0]),
      rows_(kRateIntervals),
      pieces_(size_t(intervals)) {
  for (int row = 0; row <= kRateIntervals; ++row) {
    const double rate = floor * (from_octaves(row / per_rate_step_) - 1);
    const Lookup curve([&](double strain) { return f(strain, rate); }, lower, upper, intervals);
    line_.insert(line_.end(), curve.lines().begin(), curve.lines().end());
    steepest_.insert(steepest_.end(), curve.steepest().begin(), curve.steepest().end());
    lower_ = curve.lower();
    per_step_ = curve.per_step();
  }
  last_ = intervals - 1;
}

double RateLookup::largest_slope(double gain) const {
  double largest = 0;
  for (int row = 0; row < kRateIntervals; ++row) {
    const double slope = std::exp2(-std::floor(row / per_rate_step_));  // of octaves(), largest in the row
    for (size_t piece = 0; piece < pieces_; ++piece) {
      const double* slow = &line_[(size_t(row) * pieces_ + piece) * 2];
      const double* fast = slow + 2 * pieces_;
      for (const double end : {double(piece), double(piece) + 1}) {
        const double strain = lower_ + end / per_step_;
        const double by_rate = (fast[0] - slow[0]) + (fast[1] - slow[1]) * strain;
        largest =
            std::max(largest, std::max(slow[1], fast[1]) + std::abs(by_rate) * per_rate_step_ * slope * gain);
      }
    }
  }
  return largest;
}

}  // namespace drapeplan
