// The heavy cantilever strip against the elastica: bending stiffness, large rotations, gravity and damping
// together.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/run/simulate.hpp"
#include "planner/stress/exact.hpp"
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kGravity = 9.81;

/// Tip drop of a strip of `elements` along its 150 mm [m].
double strip_drop(double modulus, int elements) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.15, 0.01, 0.15 / elements);
  scene.fabric = test::linear_fabric(modulus, 1e6, 1e7);
  scene.options.mass_scaling = 1;
  scene.gravity = kGravity;
  scene.damping = 22;  // twice the lowest angular frequency: critical, at rest after 1.5 s
  for (int n = 0; n < scene.mesh.node_count(); ++n) {
    if (scene.mesh.rest[size_t(n)].x() < -0.0749) scene.clamped.push_back(n);
  }
  const RunResult run = simulate(Model(scene), {.schedule = nullptr, .duration = 1.5});
  EXPECT_EQ(run.summary.status, RunStatus::done);
  EXPECT_LE(run.summary.energy.balance_error, 1e-6);
  return -run.final.position.back().z();
}

TEST(Elastica, HasThePublishedDrops) {  // heavy elastica, tip drop over length
  EXPECT_NEAR(elastica_drop(1), 0.12347, 1e-5);
  EXPECT_NEAR(elastica_drop(4), 0.42516, 1e-5);
  EXPECT_NEAR(elastica_drop(10), 0.70020, 1e-5);
}

TEST(Cantilever, DropsLikeTheElasticaAndConvergesToIt) {
  const double modulus = 0.69e9, stiffness = modulus * std::pow(3e-4, 3) / 12;
  const double exact = 0.15 * elastica_drop(0.314 * kGravity * std::pow(0.15, 3) / stiffness);
  EXPECT_NEAR(exact, 0.0882175, 2e-5);  // other codes, with a slightly different gravity
  const double coarse = std::abs(strip_drop(modulus, 8) - exact),
               fine = std::abs(strip_drop(modulus, 16) - exact);
  EXPECT_LE(fine, 0.005 * exact);
  const double slope = std::log2(coarse / fine);
  EXPECT_GE(slope, 1.5);
  EXPECT_LE(slope, 2.5);
}

TEST(Cantilever, DropsWithSecondOrderFromSmallToLargeRotations) {
  for (const double beta : {0.1, 1.0, 4.0, 10.0, 20.0}) {
    const double exact = elastica_drop(beta);
    const double coarse = drop_under_weight(beta, 8), fine = drop_under_weight(beta, 16);
    char name[64];
    std::snprintf(name, sizeof name, "heavy strip, w L^3/D = %g, drop/L", beta);
    EXPECT_LE(test::figure(name, fine, exact), 0.005);
    // Small rotations: nodes of a straight strip are exact up to where the run stops (1e-6 of the length).
    if (beta < 1) continue;
    test::expect_second_order(coarse - exact, fine - exact);
  }
}

}  // namespace
}  // namespace drapeplan
