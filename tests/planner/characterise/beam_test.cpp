#include "planner/characterise/beam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planner/method/normal.hpp"

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

TEST(BendingLawOfProfile, FindsALawThroughNoise) {
  const BendingLaw truth{{0, 0.1, 0.6}, {0, 0.4, 12}};
  const StripAtRest strip = strip_at_rest(truth, 1, 1);
  std::mt19937_64 bits(1);
  std::vector<Eigen::Vector2d> places;
  for (size_t k = 0; k < strip.places.size(); k += 10)
    places.push_back(strip.places[k] + 5e-4 * Eigen::Vector2d(0, k > 0 ? standard_normal(bits) : 0));
  const BendingLaw law = bending_law_of_profile(places, 1, 10);
  for (size_t k = 1; k < law.stress.size(); ++k) EXPECT_GE(law.stress[k], law.stress[k - 1]);
  for (double moment = 0.05; moment <= strip.moment.front(); moment += 0.05)
    EXPECT_NEAR(law(moment), truth(moment), 0.1 * truth(strip.moment.front())) << moment;
  EXPECT_NEAR(strip_at_rest(law, 1, 1).tip(), strip.tip(), 0.002 * strip.tip());
}

TEST(BendingLawOfProfile, RefusesTooFewPlacesAndAStripThatTurnsBack) {
  const std::vector<Eigen::Vector2d> places = strip_at_rest(linear_bending(1), 1, 1).places;
  EXPECT_THROW(bending_law_of_profile(places, 1, int(places.size()) / 2 + 1), std::invalid_argument);
  std::vector<Eigen::Vector2d> back = places;
  for (size_t k = 30; k < back.size(); ++k) back[k].x() = 2 * back[30].x() - back[k].x();
  EXPECT_THROW(bending_law_of_profile(back, 1), std::invalid_argument);
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
