// Strips with large rotations against the elastica: tip force, tip moment, pure bending with two moduli.
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

using test::get;

constexpr double kLength = 1, kWidth = 0.05;
constexpr test::Sheet kThin{1e9, 2e-3, 1};  // transverse shear and stretch change the tip by 2e-5 L at most

struct Tip {
  double x = 0, z = 0;
};

/// Tip of a cantilever of n elements under a dead tip force of k D / L^2 per width, upwards.
Tip under_end_shear(double k, int n) {
  Scene scene = test::cantilever(kThin, kLength, kWidth, n);
  const double force = k * kThin.bending_stiffness() / (kLength * kLength) * kWidth;
  scene.loads = Loads{.forces = {{n, {0, 0, force / 2}}, {2 * n + 1, {0, 0, force / 2}}}};
  const Model model(scene);
  const State state = test::at_rest(model, 1e-6 * kLength);
  return {state.position.x[size_t(n)], state.position.z[size_t(n)]};
}

/// Tip of a strip bent by an end moment into a circle.
Tip rolled_up(int n) {
  Scene scene = test::cantilever(kThin, kLength, kWidth, n);
  const double moment = 2 * std::numbers::pi * kThin.bending_stiffness() / kLength * kWidth;
  scene.loads = Loads{.moments = {{n, {0, -moment / 2, 0}}, {2 * n + 1, {0, -moment / 2, 0}}}};
  const Model model(scene);
  const State state = test::at_rest(model, 1e-6 * kLength);
  return {state.position.x[size_t(n)], state.position.z[size_t(n)]};
}

// Sze, Liu, Lo (2004), table 1 and Mattiasson (1981): W / L and U / L of the elastica, D theta'' = - P cos
// theta.
TEST(Cantilever, BendsUnderATipForceLikeTheElasticaAndConvergesToIt) {
  struct Published {
    double k, w, u;
  };
  for (const Published& p : {Published{1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {4, 0.66996, 0.32894}}) {
    const Tip coarse = under_end_shear(p.k, 8), fine = under_end_shear(p.k, 16);
    const std::string load = "tip force, P L^2/D = " + std::to_string(int(p.k));
    EXPECT_LE(test::figure(load + ", W/L", fine.z / kLength, p.w), 0.01);
    EXPECT_LE(test::figure(load + ", U/L", 1 - fine.x / kLength, p.u), 0.01);
    test::expect_second_order(coarse.z / kLength - p.w, fine.z / kLength - p.w);
  }
}

// M = 2 pi D / L closes the circle.
TEST(Cantilever, RollsUpToAFullCircleUnderATipMoment) {
  const auto miss = [](const Tip& tip) { return std::hypot(tip.x, tip.z) / kLength; };
  const double coarse = miss(rolled_up(16)), fine = miss(rolled_up(32));
  std::printf("  roll-up: tip misses the root by %.4f L (16 elements), %.4f L (32 elements)\n", coarse, fine);
  EXPECT_LE(fine, 0.01);
  test::expect_second_order(coarse, fine);
}

/// Bending stiffness of a strip with moduli `tension` and `compression`, seen at its tip, over the exact one.
double seen_stiffness(int points, double tension, double compression) {
  constexpr int kElements = 4;
  constexpr test::Sheet kThick{1e9, 2e-2, 1};
  Scene scene = test::cantilever(kThick, kLength, kWidth, kElements);
  scene.options.section_points = points;
  scene.fabric.tension = Curve{{0, 0.01}, {0, 0.01 * tension}};
  scene.fabric.compression = Curve{{0, 0.01}, {0, 0.01 * compression}};
  const double root = std::sqrt(tension) + std::sqrt(compression);
  const double exact = std::pow(kThick.thickness, 3) / 12 * 4 * tension * compression / (root * root);
  const double angle = 0.05;
  const double moment = angle * exact / kLength * kWidth;
  scene.loads =
      Loads{.moments = {{kElements, {0, -moment / 2, 0}}, {2 * kElements + 1, {0, -moment / 2, 0}}}};
  const Model model(scene);
  const State state = test::at_rest(model, 1e-8 * kLength);
  return angle / std::atan2(-state.director.x[kElements], state.director.z[kElements]);
}

// Two moduli, no resultant force: D = t^3/12 4 Et Ec / (sqrt Et + sqrt Ec)^2, neutral line where stresses
// balance. Ratios of Gauss sections: by hand, from the balance of forces over the points.
TEST(Section, BendsWithTheReducedModulusOfTensionAndCompression) {
  struct Seen {
    int points;
    double ratio, gauss;
  };
  for (const Seen& c : {Seen{5, 4, 0.9975}, {5, 10, 0.9906}, {3, 4, 1.0227}, {3, 10, 0.990}}) {
    const double seen = seen_stiffness(c.points, 1e9, 1e9 / c.ratio);
    char name[64];
    std::snprintf(name, sizeof name, "two moduli, Et/Ec = %g, %d points, D/exact", c.ratio, c.points);
    EXPECT_LE(test::figure(name, seen, c.gauss), 1e-3);
    EXPECT_LE(std::abs(seen - 1), c.points == 5 ? 0.01 : 0.025);
  }
}

}  // namespace
}  // namespace drapeplan
