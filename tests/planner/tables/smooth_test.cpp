#include "planner/tables/smooth.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace drapeplan {
namespace {

TEST(MonotoneCubic, IsMonotoneWithAContinuousSlope) {
  const MonotoneCubic curve({0, 1, 2, 4, 5}, {0, 1, 1, 5, 5.5});
  double before = curve(-0.5);
  for (double x = -0.49; x < 5.5; x += 0.01) {
    EXPECT_GE(curve(x), before - 1e-12) << x;
    EXPECT_NEAR(curve.slope(x), (curve(x + 1e-6) - curve(x - 1e-6)) / 2e-6, 1e-4) << x;
    before = curve(x);
  }
  EXPECT_EQ(curve(4), 5);
  EXPECT_EQ(curve(1.5), 1);
  EXPECT_THROW(MonotoneCubic({0, 0}, {1, 2}), std::invalid_argument);
}

TEST(NotDecreasing, PoolsNeighboursInTheWrongOrder) {
  EXPECT_EQ(not_decreasing({1, 3, 2, 4}, {1, 1, 1, 1}), (std::vector<double>{1, 2.5, 2.5, 4}));
  EXPECT_EQ(not_decreasing({3, 2, 1}, {1, 1, 1}), (std::vector<double>{2, 2, 2}));
  EXPECT_EQ(not_decreasing({2, 1}, {3, 1}), (std::vector<double>{1.75, 1.75}));
}

TEST(FitAtKnots, FindsALineThroughNoise) {
  std::vector<double> x, y;
  for (int k = 0; k <= 400; ++k) {
    x.push_back(k / 100.0);
    y.push_back(2 * x.back() + 0.01 * std::sin(37.0 * k));
  }
  const std::vector<double> values = fit_at_knots(x, y, {0, 1, 2.5, 4, 6}, 0);
  EXPECT_EQ(values[0], 0);
  EXPECT_NEAR(values[1], 2, 0.005);
  EXPECT_NEAR(values[3], 8, 0.01);
  EXPECT_NEAR(values[4], 12, 0.02) << "no point lies there: it goes on straight";
}

}  // namespace
}  // namespace drapeplan
