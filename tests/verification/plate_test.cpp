// Square plates with small deflection.
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

// Side 1 m; the transverse shear adds about 4 (t / a)^2 = 1e-4 to the deflection.
constexpr test::Sheet kPlate{1e9, 5e-3, 1};
constexpr double kSmall = 1e-3;  ///< deflection over thickness: membrane forces add its square

enum class Edge { supported, clamped };
enum class Push { uniform, central };

/// Deflection at the middle, in units of q a^4 / D or P a^2 / D.
double coefficient(Edge edge, Push push, int n, double expected) {
  Scene scene;
  scene.mesh = grid_mesh(n, n, [](double u, double v) { return Eigen::Vector2d(u, v); });
  scene.fabric = kPlate.fabric();
  scene.options.mass_scaling = 1;
  (edge == Edge::supported ? scene.pinned : scene.clamped) = scene.mesh.outline;
  // Lowest frequencies of the supported and of the clamped square plate: Leissa (1969).
  scene.damping = 2 * kPlate.frequency(edge == Edge::supported ? 19.74 : 35.99, 1);
  const double unit = kSmall * kPlate.thickness / expected;
  const double load = unit * kPlate.bending_stiffness();
  const int middle = (n / 2) * (n + 1) + n / 2;
  if (push == Push::uniform) {
    scene.loads = Loads{.pressure = {0, 0, load}};
  } else {
    scene.loads = Loads{.forces = {{middle, {0, 0, load}}}};
  }
  const Model model(scene);
  const State state = test::at_rest(model, 1e-5 * kSmall * kPlate.thickness);
  return state.position.z[size_t(middle)] / unit;
}

struct PlateCase {
  std::string name;
  Edge edge;
  Push push;
  double published;
};

class Plates : public ::testing::TestWithParam<PlateCase> {};

// Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells: tables 8, 23, 35, 37; they do not depend on
// nu.
INSTANTIATE_TEST_SUITE_P(
    Square, Plates,
    ::testing::Values(PlateCase{"SupportedUniform", Edge::supported, Push::uniform, 0.00406235},
                      PlateCase{"SupportedCentral", Edge::supported, Push::central, 0.01160},
                      PlateCase{"ClampedUniform", Edge::clamped, Push::uniform, 0.00126532},
                      PlateCase{"ClampedCentral", Edge::clamped, Push::central, 0.00560}),
    [](const auto& instance) { return instance.param.name; });

TEST_P(Plates, DeflectLikeKirchhoffsPlate) {
  const PlateCase& p = GetParam();
  for (const int n : {8, 16}) {
    const double computed = coefficient(p.edge, p.push, n, p.published);
    const double error = test::figure(p.name + " plate, " + std::to_string(n) + " x " + std::to_string(n),
                                      computed, p.published);
    EXPECT_LE(error, n == 8 ? 0.03 : 0.01);
  }
}

}  // namespace
}  // namespace drapeplan
