// What verification tests share: printing figures, orders of convergence. Problems that `drapeplan validate` plays, too,
// lie in planner/validate/shell_problems.hpp.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "fem/mesh/grid.hpp"
#include "planner/validate/shell_problems.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan::test {

/// Prints a figure of tests/bench/fem.md and returns its relative error.
inline double figure(const std::string& what, double computed, double published) {
  const double error = computed / published - 1;
  std::printf("  %-44s computed %.6g  published %.6g  error %+.3f %%\n", what.c_str(), computed, published,
              100 * error);
  return std::abs(error);
}

/// Requires that an error that is halved in mesh size falls with order two: |slope| between 1.7 and 2.4.
inline void expect_second_order(double coarse, double fine) {
  const double slope = std::log2(std::abs(coarse / fine));
  std::printf("  order %.2f\n", slope);
  EXPECT_GE(slope, 1.7);
  EXPECT_LE(slope, 2.4);
}

}  // namespace drapeplan::test
