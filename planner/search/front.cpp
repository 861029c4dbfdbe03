#include "planner/search/front.hpp"

#include <algorithm>
#include <array>

namespace drapeplan {

std::vector<const Candidate*> unbeaten(const std::vector<Candidate>& candidates) {
  const auto good = [](const Candidate& c) { return c.outcome.score.valid && c.outcome.score.followed; };
  const auto figures = [](const Candidate& c) {
    const Score& s = c.outcome.score;
    return std::array{s.max_gap, s.max_boundary_offset, s.duration};
  };
  std::vector<const Candidate*> front;
  for (const Candidate& one : candidates) {
    const bool beaten = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& other) {
      const auto a = figures(other), b = figures(one);
      const bool as_good = a[0] <= b[0] && a[1] <= b[1] && a[2] <= b[2];
      return good(other) && as_good && (a != b || &other < &one);
    });
    if (good(one) && !beaten) front.push_back(&one);
  }
  std::stable_sort(front.begin(), front.end(),
                   [&](const Candidate* a, const Candidate* b) { return figures(*a) < figures(*b); });
  return front;
}

}  // namespace drapeplan
