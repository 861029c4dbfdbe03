#include "fem/law/lookup.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace drapeplan {
namespace {

TEST(Lookup, IsExactForAKinkAtZeroAndGoesOnBeyondItsEnds) {
  const Lookup law([](double e) { return e > 0 ? 10 * e : e; }, -0.013, 0.02, 100);
  EXPECT_EQ(law(0.0), 0);
  EXPECT_NEAR(law(0.005), 0.05, 1e-15);
  EXPECT_NEAR(law(-0.005), -0.005, 1e-15);
  EXPECT_NEAR(law(0.5), 5, 1e-12);
  EXPECT_NEAR(law(-0.5), -0.5, 1e-12);
  EXPECT_NEAR(law.largest_slope(), 10, 1e-9);
}

TEST(Lookup, GivesLanesTheSameBitsAsScalars) {
  const Lookup law([](double e) { return std::tanh(e); }, -1, 1, 57);
  for (double start = -1.5; start < 1.5; start += 0.0137) {
    const Lanes at([&](auto l) { return start + 0.01 * double(l); });
    const Lanes out = law(at);
    for (size_t l = 0; l < size_t(kLanes); ++l) EXPECT_DOUBLE_EQ(out[l], law(at[l]));
  }
}

TEST(Lookup, ApproachesACurveWithSecondOrder) {
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const Lookup law([](double e) { return std::sinh(e); }, -1, 1, 50 << k);
    error[k] = 0;
    for (double e = -1; e <= 1; e += 0.001) error[k] = std::max(error[k], std::abs(law(e) - std::sinh(e)));
  }
  const double slope = std::log2(error[0] / error[1]);
  EXPECT_GE(slope, 1.9);
  EXPECT_LE(slope, 2.1);
}

TEST(Lookup, IntegratesItself) {
  const Lookup law([](double e) { return 3 * e * std::abs(e); }, -1, 1, 400);
  EXPECT_NEAR(law.integral(0.7), 0.343, 1e-5);
  EXPECT_NEAR(law.integral(-0.7), 0.343, 1e-5);
  EXPECT_EQ(law.integral(0), 0);
}

TEST(Lookup, PassesNotANumberOn) {
  const Lookup law([](double e) { return e; }, -1, 1, 10);
  EXPECT_TRUE(std::isnan(law(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace drapeplan
