#include "planner/parallel.hpp"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <vector>

namespace drapeplan {

void parallel_for(int count, const std::function<void(int)>& body, int threads) {
  if (count <= 0) return;
  const int team = std::min(count, omp_in_parallel() ? 1 : threads > 0 ? threads : omp_get_max_threads());
  std::vector<std::exception_ptr> thrown(static_cast<size_t>(count));
#pragma omp parallel for schedule(dynamic, 1) num_threads(team) if (team > 1)
  for (int i = 0; i < count; ++i) {
    try {
      body(i);
    } catch (...) {
      thrown[size_t(i)] = std::current_exception();
    }
  }
  for (const std::exception_ptr& e : thrown) {
    if (e) std::rethrow_exception(e);
  }
}

}  // namespace drapeplan
