// The one place of the planner where threads are opened.
#pragma once

#include <functional>

namespace drapeplan {

/// Runs body(0) ... body(count - 1), side by side, the next free thread taking the next index. A call from
/// inside another one runs serially. An exception does not leave a thread: all indices run, then the one of
/// the lowest index is thrown again.
/// @param threads  largest number of threads; 0: OpenMP's default.
void parallel_for(int count, const std::function<void(int)>& body, int threads = 0);

/// How many threads that number means. @param threads  0: OpenMP's default.
int thread_count(int threads);

}  // namespace drapeplan
