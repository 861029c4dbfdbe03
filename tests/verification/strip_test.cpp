// Strips with large rotations against the elastica: tip force, tip moment, pure bending with two moduli.
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

// Sze, Liu, Lo (2004), table 1 and Mattiasson (1981): W / L and U / L of the elastica, D theta'' = - P cos
// theta.
TEST(Cantilever, BendsUnderATipForceLikeTheElasticaAndConvergesToIt) {
  struct Published {
    double k, w, u;
  };
  for (const Published& p : {Published{1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {4, 0.66996, 0.32894}}) {
    const TipPlace coarse = under_tip_force(p.k, 8), fine = under_tip_force(p.k, 16);
    const std::string load = "tip force, P L^2/D = " + std::to_string(int(p.k));
    EXPECT_LE(test::figure(load + ", W/L", fine.up, p.w), 0.01);
    EXPECT_LE(test::figure(load + ", U/L", 1 - fine.along, p.u), 0.01);
    test::expect_second_order(coarse.up - p.w, fine.up - p.w);
  }
}

// M = 2 pi D / L closes the circle.
TEST(Cantilever, RollsUpToAFullCircleUnderATipMoment) {
  const auto miss = [](const TipPlace& tip) { return std::hypot(tip.along, tip.up); };
  const double coarse = miss(under_tip_moment(16)), fine = miss(under_tip_moment(32));
  std::printf("  roll-up: tip misses the root by %.4f L (16 elements), %.4f L (32 elements)\n", coarse, fine);
  EXPECT_LE(fine, 0.01);
  test::expect_second_order(coarse, fine);
}

// Two moduli, no resultant force: D = t^3/12 4 Et Ec / (sqrt Et + sqrt Ec)^2, neutral line where stresses
// balance. Ratios of Gauss sections: by hand, from the balance of forces over the points.
TEST(Section, BendsWithTheReducedModulusOfTensionAndCompression) {
  struct Seen {
    int points;
    double ratio, gauss;
  };
  for (const Seen& c : {Seen{5, 4, 0.9975}, {5, 10, 0.9906}, {3, 4, 1.0227}, {3, 10, 0.990}}) {
    const double seen = stiffness_of_two_moduli(c.ratio, c.points);
    char name[64];
    std::snprintf(name, sizeof name, "two moduli, Et/Ec = %g, %d points, D/exact", c.ratio, c.points);
    EXPECT_LE(test::figure(name, seen, c.gauss), 1e-3);
    EXPECT_LE(std::abs(seen - 1), c.points == 5 ? 0.01 : 0.025);
  }
}

}  // namespace
}  // namespace drapeplan
