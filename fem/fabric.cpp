#include "fem/fabric.hpp"

#include <algorithm>

namespace drapeplan {

double Curve::operator()(double at) const {
  const auto upper = std::upper_bound(strain.begin(), strain.end(), at);
  const auto last = std::ptrdiff_t(strain.size()) - 1;
  const auto k = size_t(std::clamp<std::ptrdiff_t>(upper - strain.begin(), 1, last));
  const double slope = (stress[k] - stress[k - 1]) / (strain[k] - strain[k - 1]);
  return stress[k - 1] + slope * (at - strain[k - 1]);
}

double Curve::largest_slope() const {
  double largest = 0;
  for (size_t k = 1; k < strain.size(); ++k) {
    largest = std::max(largest, (stress[k] - stress[k - 1]) / (strain[k] - strain[k - 1]));
  }
  return largest;
}

}  // namespace drapeplan
