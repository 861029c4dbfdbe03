// Where something begins to hold.
#pragma once

namespace drapeplan {

/// The smallest x in [low, high] for which `above` holds, if it holds from some x on; down to round-off. Never
/// fails: where it holds nowhere, the result is `high`.
template <class Above>
double bisect(double low, double high, const Above& above) {
  constexpr int kBisections = 60;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (low + high);
    (above(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace drapeplan
