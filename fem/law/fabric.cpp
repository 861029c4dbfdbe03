#include "fem/law/fabric.hpp"

#include <algorithm>
#include <cmath>

namespace drapeplan {

double Curve::operator()(double at) const {
  const auto upper = std::upper_bound(strain.begin(), strain.end(), at);
  const auto last = std::ptrdiff_t(strain.size()) - 1;
  const auto k = size_t(std::clamp<std::ptrdiff_t>(upper - strain.begin(), 1, last));
  return stress[k - 1] + slope(k - 1) * (at - strain[k - 1]);
}

double Curve::slope(size_t piece) const {
  return (stress[piece + 1] - stress[piece]) / (strain[piece + 1] - strain[piece]);
}

double Curve::largest_slope() const {
  double largest = 0;
  for (size_t k = 0; k + 1 < strain.size(); ++k) largest = std::max(largest, slope(k));
  return largest;
}

double Curve::smallest_slope() const {
  double smallest = 0;
  for (size_t k = 0; k + 1 < strain.size(); ++k) {
    if (slope(k) > 0 && (smallest == 0 || slope(k) < smallest)) smallest = slope(k);
  }
  return smallest;
}

double StressTable::operator()(double strain, double rate, double floor) const {
  if (!rate_dependent() || !(rate > rates.front())) return curves.front()(strain);
  if (rate >= rates.back()) return curves.back()(strain);
  const auto k = size_t(std::upper_bound(rates.begin(), rates.end(), rate) - rates.begin());
  const double slow = std::log1p(rates[k - 1] / floor), fast = std::log1p(rates[k] / floor);
  const double share = (std::log1p(rate / floor) - slow) / (fast - slow);
  return (1 - share) * curves[k - 1](strain) + share * curves[k](strain);
}

}  // namespace drapeplan
