#include "planner/base/parallel.hpp"

#include <omp.h>
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

#include <algorithm>
#include <exception>
#include <vector>

namespace drapeplan {
namespace {

// The thread sanitizer does not see how libgomp starts its team and waits for it: it is told.
#if defined(__SANITIZE_THREAD__)
char team_starts, team_ends;
void say(char& event) {
  __tsan_release(&event);
}
void hear(char& event) {
  __tsan_acquire(&event);
}
#else
enum Event { team_starts, team_ends };
void say(Event /*event*/) {}
void hear(Event /*event*/) {}
#endif

}  // namespace

int thread_count(int threads) {
  return threads > 0 ? threads : omp_get_max_threads();
}

void parallel_for(int count, const std::function<void(int)>& body, int threads) {
  if (count <= 0) return;
  const int team = std::min(count, omp_in_parallel() ? 1 : thread_count(threads));
  std::vector<std::exception_ptr> thrown(static_cast<size_t>(count));
  say(team_starts);
#pragma omp parallel num_threads(team) if (team > 1)
  {
    hear(team_starts);
#pragma omp for schedule(dynamic, 1) nowait
    for (int i = 0; i < count; ++i) {
      try {
        body(i);
      } catch (...) {
        thrown[size_t(i)] = std::current_exception();
      }
    }
    say(team_ends);
  }
  hear(team_ends);
  for (const std::exception_ptr& e : thrown) {
    if (e) std::rethrow_exception(e);
  }
}

}  // namespace drapeplan
