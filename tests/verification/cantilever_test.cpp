// The heavy cantilever strip against the elastica: bending stiffness, large rotations, gravity and damping
// together.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fem/run/simulate.hpp"
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kGravity = 9.81;

/// Tip drop over length of the heavy elastica D theta'' = -w (L - s) cos theta, theta(0) = 0, theta'(L) = 0,
/// with beta = w L^3 / D. Shooting from the root: bisection on theta'(0), classical Runge-Kutta.
double elastica_drop(double beta) {
  constexpr int kSteps = 2000;
  const double h = 1.0 / kSteps;
  double drop = 0;
  const auto end_slope = [&](double root_slope) {
    std::array<double, 3> y{0, root_slope, 0};  // theta, theta', drop
    const auto rate = [beta](double s, const std::array<double, 3>& q) {
      return std::array<double, 3>{q[1], -beta * (1 - s) * std::cos(q[0]), std::sin(q[0])};
    };
    const auto along = [](const std::array<double, 3>& q, double step, const std::array<double, 3>& k) {
      return std::array<double, 3>{q[0] + step * k[0], q[1] + step * k[1], q[2] + step * k[2]};
    };
    for (int n = 0; n < kSteps; ++n) {
      const double s = n * h;
      const auto k1 = rate(s, y), k2 = rate(s + h / 2, along(y, h / 2, k1));
      const auto k3 = rate(s + h / 2, along(y, h / 2, k2)), k4 = rate(s + h, along(y, h, k3));
      for (size_t k = 0; k < 3; ++k) y[k] += h / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
    }
    drop = y[2];
    return y[1];
  };
  double low = 0,
         high = beta;  // theta'(L) grows with theta'(0); beta / 2 is the root slope of small deflections
  for (int n = 0; n < 100; ++n) (end_slope(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
  return drop;
}

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

/// Tip drop over length of a strip of n elements whose weight is beta D / L^3.
double heavy_drop(double beta, int n) {
  const test::Sheet sheet{1e9, 4e-3, 1};  // transverse shear adds beta (t / L)^2 / 5: 6e-5 at most
  Scene scene = test::cantilever(sheet, 1, 0.05, n);
  scene.gravity = beta * sheet.bending_stiffness() / sheet.density;
  const Model model(scene);
  return -test::at_rest(model, 1e-6).position.z[size_t(n)];
}

TEST(Cantilever, DropsWithSecondOrderFromSmallToLargeRotations) {
  for (const double beta : {0.1, 1.0, 4.0, 10.0, 20.0}) {
    const double exact = elastica_drop(beta);
    const double coarse = heavy_drop(beta, 8), fine = heavy_drop(beta, 16);
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
