#include "planner/characterise/beam.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace drapeplan {
namespace {

TEST(StripAtRest, IsTheHeavyElastica) {
  // beta = load length^3 / D, tip drop over length.
  for (const auto& [beta, drop] : {std::pair(1.0, 0.12347), {4.0, 0.42516}, {10.0, 0.70020}}) {
    const StripAtRest strip = strip_at_rest(linear_bending(1 / beta), 1, 1);
    EXPECT_NEAR(strip.tip(), drop, 1e-5) << beta;
    EXPECT_NEAR(strip.moment.back(), 0, 1e-9);
    EXPECT_NEAR(stiffness_of(strip.tip(), 1, 1), 1 / beta, 1e-6 / beta);
  }
  EXPECT_THROW(stiffness_of(2, 1, 1), std::invalid_argument);
}

TEST(StripAtRest, FollowsALawThatSoftens) {
  // Curvature 100 times as soft above a moment: the strip hangs down from a hinge beside the clamp.
  const BendingLaw soft{{0, 0.1, 0.101}, {0, 0.01, 1.01}};
  const StripAtRest strip = strip_at_rest(soft, 1, 1);
  for (size_t k = 0; k < strip.moment.size(); ++k)
    EXPECT_NEAR(soft(strip.moment[k]), strip.curvature[k], 1e-9);
  EXPECT_GT(strip.tip(), 0.9);
}

TEST(SectionMoment, HasTheClosedFormOfTwoModuli) {
  const double thickness = 0.3e-3, in_tension = 8e9, in_compression = 0.5e9;
  const Curve tension{{0, 1}, {0, in_tension}}, compression{{0, 0.001, 1}, {0, 0.5e6, 0.5e9}};
  const double sum = std::sqrt(in_tension) + std::sqrt(in_compression);
  const double stiffness = std::pow(thickness, 3) / 12 * 4 * in_tension * in_compression / (sum * sum);
  for (const double curvature : {0.1, 3.0, 20.0})
    EXPECT_NEAR(section_moment(tension, compression, thickness, curvature), stiffness * curvature,
                1e-9 * stiffness * curvature);
}

}  // namespace
}  // namespace drapeplan
