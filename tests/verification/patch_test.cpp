// The patch of MacNeal and Harder (1985): distorted quadrilaterals, linear and quadratic fields on its edge.
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

using test::get;
using test::put;

constexpr double kWidth = 0.24, kHeight = 0.12;

/// Five elements, inner nodes 4 to 7.
Mesh patch() {
  Mesh mesh;
  mesh.rest = {{0, 0},       {kWidth, 0},  {kWidth, kHeight}, {0, kHeight},
               {0.04, 0.02}, {0.18, 0.03}, {0.16, 0.08},      {0.08, 0.08}};
  mesh.quads = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};
  mesh.outline = {0, 1, 2, 3};
  return mesh;
}

Scene patch_scene(double thickness) {
  const Sheet sheet{1e6, thickness, 1};
  Scene scene;
  scene.mesh = patch();
  scene.fabric = sheet.fabric();
  scene.options.mass_scaling = 1;
  scene.damping = 2 * sheet.frequency(35.99, kWidth);
  scene.clamped = scene.mesh.outline;
  return scene;
}

// u = 1e-3 (x + y/2), v = 1e-3 (y + x/2) on the edge. With nu = 0 the exact stress is E times the nominal
// strain of each fibre.
TEST(Patch, StretchesEvenlyOnDistortedElements) {
  const double thickness = 0.02;  // a membrane problem: only the number of steps depends on it
  Scene scene = patch_scene(thickness);
  const Model model(scene);
  State state = model.flat_state(0);
  const auto field = [](const Eigen::Vector2d& X) {
    return Eigen::Vector3d(X.x() + 1e-3 * (X.x() + 0.5 * X.y()), X.y() + 1e-3 * (X.y() + 0.5 * X.x()), 0);
  };
  for (const int n : scene.clamped) put(state.position, size_t(n), field(scene.mesh.rest[size_t(n)]));
  settle(model, state, 1e-13);
  for (size_t n = 4; n < 8; ++n)
    EXPECT_LE((get(state.position, n) - field(scene.mesh.rest[n])).norm(), 1e-12 * kWidth);
  Snapshot strains;
  model.shell().strains(state, strains);
  const double strain = std::hypot(1.001, 5e-4) - 1, angle = 2 * std::atan(5e-4 / 1.001);
  for (size_t e = 0; e < scene.mesh.quads.size(); ++e) {
    EXPECT_LE(std::abs(strains.warp_strain[e] / strain - 1), 1e-9);
    EXPECT_LE(std::abs(strains.weft_strain[e] / strain - 1), 1e-9);
    EXPECT_LE(std::abs(strains.shear[e] / angle - 1), 1e-9);
  }
  // The edges' resultant: what the sheet pulls through its side is E e t times the side.
  auto forces = model.terms().front()->entries();
  model.terms().front()->forces(state, forces.data());
  const double pull = -(forces[0].force.x[1] + forces[0].force.x[2]);
  EXPECT_LE(std::abs(pull / (1e6 * strain * thickness * kHeight) - 1), 1e-3);  // turned by the strain, 5e-4
}

/// Largest error of inner deflections over the largest deflection, for w = k (a x^2 + b x y + c y^2) / 2 on
/// the edge.
double bending_patch_error(double thickness, double a, double b, double c) {
  Scene scene = patch_scene(thickness);
  const Model model(scene);
  State state = model.flat_state(0);
  const double k = 1e-5;  // 1/m: the membrane sees the square of deflection over thickness
  const auto deflection = [&](const Eigen::Vector2d& X) {
    return k / 2 * (a * X.x() * X.x() + b * X.x() * X.y() + c * X.y() * X.y());
  };
  for (const int n : scene.clamped) {
    const Eigen::Vector2d X = scene.mesh.rest[size_t(n)];
    state.position.z[size_t(n)] = deflection(X);
    put(state.director, size_t(n),
        Eigen::Vector3d(-k * (a * X.x() + b / 2 * X.y()), -k * (c * X.y() + b / 2 * X.x()), 1).normalized());
  }
  settle(model, state, 1e-8 * k);
  double error = 0, largest = 0;
  for (size_t n = 4; n < 8; ++n) {
    const double exact = deflection(scene.mesh.rest[n]);
    error = std::max(error, std::abs(state.position.z[n] - exact));
    largest = std::max(largest, std::abs(exact));
  }
  return error / largest;
}

// With transverse shear taken at the middle of the element along the fibres, as in the first version, inner
// nodes missed by 34 % (along warp) and 43 % (with twist).
TEST(Patch, BendsOnDistortedElements) {
  for (const double thickness : {1e-2, 1e-3}) {
    EXPECT_LE(bending_patch_error(thickness, 1, 0, 0), 1e-5)
        << thickness;  // constant curvature along the warp
    EXPECT_LE(bending_patch_error(thickness, 1, 1, 1), 1e-5) << thickness;  // MacNeal and Harder's field
  }
}

}  // namespace
}  // namespace drapeplan
