// Builds without a term's code: its functions are replaced by these, which only say so and stop.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace drapeplan {

[[noreturn]] inline void absent(const char* what) {
  std::fprintf(stderr, "this build has no %s\n", what);
  std::abort();
}

}  // namespace drapeplan
