// Taut spans under pressure: tension over radius is the pressure.
#include "fem/run/simulate.hpp"
#include "tests/mapping/molds.hpp"
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kLength = 0.2, kWidth = 0.02;   // [m]
constexpr Sheet kStrip{1e9, 3e-4, 0.314};  // so thin that bending does not count
constexpr double kStretch = 1e9 * 3e-4;          // force per width and strain [N/m]
constexpr double kTroughRadius = 0.5;            // at its bottom [m]

/// A strip of n elements between two hinges, pressed.
Scene span(int n, double pressure) {
  Scene scene;
  scene.mesh = grid_mesh(
      n, 1, [](double u, double v) { return Eigen::Vector2d((u - 0.5) * kLength, (v - 0.5) * kWidth); });
  scene.fabric = kStrip.fabric();
  scene.options.mass_scaling = 1;
  scene.damping = 1000;  // about that of its lowest mode when taut
  scene.pinned = {0, n, n + 1, 2 * n + 1};
  scene.press = Press{.pressure = pressure, .duration = 0.2, .ramp = 0.1};
  return scene;
}

/// Half the angle of the arc: p R = E t (arc / chord - 1), R = L / (2 sin).
double half_angle(double pressure) {
  double low = 1e-6, high = 1.5;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    const double needs = kStretch * (middle / std::sin(middle) - 1) * 2 * std::sin(middle) / kLength;
    (needs < pressure ? low : high) = middle;
  }
  return low;
}

double sagitta(double pressure) {
  return 0.5 * kLength * std::tan(0.5 * half_angle(pressure));
}

double computed_sagitta(int n, double pressure, RunResult& run) {
  run = simulate(Model(span(n, pressure)), {.duration = 1e-3});
  EXPECT_EQ(run.summary.status, RunStatus::done) << run.summary.message;
  EXPECT_LE(run.summary.energy.balance_error, 1e-11);
  return -run.final.position[size_t(n / 2)].z();
}

TEST(Span, UnderPressureIsAnArcWhoseTensionOverRadiusIsThePressure) {
  for (const double pressure : {1e3, 1e4, 4e4}) {
    RunResult coarse, fine;
    const double exact = sagitta(pressure), at_10 = computed_sagitta(10, pressure, coarse),
                 at_20 = computed_sagitta(20, pressure, fine);
    const double error = test::figure(
        "taut span under " + std::to_string(int(1e-3 * pressure)) + " kPa, sagitta", at_20, exact);
    EXPECT_LE(error, 0.003);
    EXPECT_LE(error, 0.5 * std::abs(at_10 / exact - 1) + 5e-4);
    // The load follows: a load that stays vertical would give a parabola, all of whose tension is level.
    const double strain = half_angle(pressure) / std::sin(half_angle(pressure)) - 1;
    for (const double warp : fine.final.warp_strain) EXPECT_NEAR(warp, strain, 0.01 * strain);
  }
}

/// A trough z = x^2 / (2 R) with the strip's ends on its flanks.
Scene span_over_trough(int n, double pressure) {
  Scene scene = span(n, pressure);
  scene.mold.emplace(PolynomialShape{{{2, 0, 1 / (2 * kTroughRadius)}}},
                     Extent{{-0.15, -0.15}, {0.15, 0.15}});
  const double flank = 0.5 * kLength / kTroughRadius;
  scene.start_height = 0.5 * flank * 0.5 * kLength + 0.5 * kStrip.thickness * std::hypot(1, flank);
  return scene;
}

TEST(Span, OverATroughIsPressedDownAsFarAsItsFibresStretch) {
  constexpr int kElements = 20;
  const double depth = std::pow(0.5 * kLength, 2) / (2 * kTroughRadius);
  const double arc = half_angle(2e3), strain_at_bottom = std::pow(0.5 * kLength / kTroughRadius, 2) / 6;
  const double closes = kStretch * strain_at_bottom / kTroughRadius;  // pressure at which it meets the bottom
  std::printf("  half angle at 2 kPa %.4f; the trough is filled from about %.2f kPa on\n", arc,
              1e-3 * closes);
  const RunResult partly = simulate(Model(span_over_trough(kElements, 2e3)), {.duration = 1e-3});
  ASSERT_EQ(partly.summary.status, RunStatus::done) << partly.summary.message;
  const double above = partly.final.position[kElements / 2].z() - 0.5 * kStrip.thickness;
  EXPECT_LE(test::figure("taut span over a trough at 2 kPa, gap at its middle", above, depth - sagitta(2e3)),
            0.02);
  // Filled: what the tension does not carry over the radius, the mold bears.
  const double pressure = 3 * closes;
  const Model model(span_over_trough(kElements, pressure));
  const RunResult filled = simulate(model, {.duration = 1e-3});
  ASSERT_EQ(filled.summary.status, RunStatus::done) << filled.summary.message;
  State state = filled.state;
  Workspace work(model);
  compute_forces(model, state, work);
  const Forces& contact = work.entries.back();
  ASSERT_EQ(contact.book, Book::contact);
  double borne = 0, area = 0;
  const std::vector<double> areas = nodal_areas(model.scene().mesh);
  for (int k = kElements / 4; k <= 3 * kElements / 4; ++k) {
    for (const int node : {k, k + kElements + 1}) {
      borne += test::get(contact.force, size_t(node)).norm(), area += areas[size_t(node)];
      EXPECT_LE(filled.final.position[size_t(node)].z() -
                    model.scene().mold->height(filled.final.position[size_t(node)].x(), 0),
                0.51 * kStrip.thickness);
    }
  }
  EXPECT_LE(test::figure("pressed into a trough, mean pressure on the mold", borne / area, pressure - closes),
            0.02);
  EXPECT_LE(filled.summary.energy.balance_error, 1e-11);
}

}  // namespace
}  // namespace drapeplan
