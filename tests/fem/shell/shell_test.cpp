// The shell term: its force is the derivative of its energy, it is objective, it passes the patch test.
#include "fem/shell/shell.hpp"

#include <gtest/gtest.h>

#include "fem/run/simulate.hpp"
#include "fem/run/workspace.hpp"
#include "tests/fem/core/term_kit.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

using test::get;
using test::put;

struct ShellCase {
  int points;
  bool distorted;
};

class ShellTerms : public ::testing::TestWithParam<ShellCase> {
 protected:
  ShellTerms() {
    scene.mesh =
        GetParam().distorted ? test::distorted_mesh(0.1, 0.06, 0.02, 0.2) : rectangle_mesh(0.1, 0.06, 0.02);
    scene.fabric = test::woven_fabric();
    scene.options.section_points = GetParam().points;
    scene.options.bulk_viscosity = 0;  // a state that is put there is no motion
    model.emplace(scene);
    state = model->flat_state(0.02);
    forces = model->terms().front()->entries();
    nodes = size_t(model->node_count());
  }
  void compute() { model->terms().front()->forces(state, forces.data()); }

  Scene scene;
  std::optional<Model> model;
  State state;
  std::vector<Forces> forces;
  size_t nodes = 0;
};

INSTANTIATE_TEST_SUITE_P(PointsAndMeshes, ShellTerms,
                         ::testing::Values(ShellCase{1, false}, ShellCase{3, false}, ShellCase{5, false},
                                           ShellCase{3, true}),
                         [](const auto& instance) {
                           return std::to_string(instance.param.points) +
                                  (instance.param.distorted ? "PointsDistorted" : "Points");
                         });

TEST_P(ShellTerms, PassTheTermKit) {
  test::TermSubject subject{.model = &*model, .state = state};
  test::disturb(subject.state, int(nodes), 4e-5, 0.05);
  subject.energy = [this](const State& at) {
    const ShellEnergy e = model->shell().stored_energy(at);
    return e.fabric + e.hourglass;
  };
  subject.internal = subject.turns_with_scene = true;
  subject.rest = state;
  test::check_term(subject);
}

// Constant membrane strain and constant curvature fields must leave inner nodes free of force and moment.
TEST_P(ShellTerms, PassThePatchTest) {
  for (size_t n = 0; n < nodes; ++n) {
    const Eigen::Vector3d x = get(state.position, n);
    put(state.position, n,
        {x.x() + 1e-3 * (x.x() + 0.5 * x.y()), x.y() + 1e-3 * (x.y() + 0.5 * x.x()), x.z()});
  }
  compute();
  double inner = 0, edge = 0;
  for (size_t n = 0; n < nodes; ++n) {
    const Eigen::Vector2d X = scene.mesh.rest[n];
    const bool is_inner = std::abs(X.x()) < 0.0499 && std::abs(X.y()) < 0.0299;
    (is_inner ? inner : edge) = std::max(is_inner ? inner : edge, get(forces[0].force, n).norm());
  }
  EXPECT_GT(edge, 1.0);
  EXPECT_LE(inner, 1e-8);
}

// With a linear law: the fabric's estimate is for its stiffest strain.
TEST_P(ShellTerms, StayBoundedBelowTheStableStepAndGrowAboveTheTrueLimit) {
  Scene free = scene;
  free.fabric = test::linear_fabric(1e9, 1e6, 2e5);
  test::expect_stable_step(free, [](const Model& run) {
    State flat = run.flat_state(0);
    test::disturb(flat, run.node_count(), 1e-9, 0);
    return flat;
  });
}

TEST(Shell, StretchesAlongAFibreWithTheTablesStress) {
  Scene scene;
  scene.options.bulk_viscosity = 0;
  scene.mesh = rectangle_mesh(0.02, 0.02, 0.02);
  scene.fabric = test::woven_fabric();
  const Model model(scene);
  State state = model.flat_state(0);
  const double strain = 0.002;
  for (size_t n = 0; n < 4; ++n) state.position.x[n] *= 1 + strain;
  auto forces = model.terms().front()->entries();
  model.terms().front()->forces(state, forces.data());
  const double pull = std::abs(forces[0].force.x[1] + forces[0].force.x[3]);
  EXPECT_NEAR(pull, scene.fabric.tension.slowest()(strain) * 3e-4 * 0.02, 1e-9);
}

TEST(Shell, ShearsWithTheTablesStressConjugateToTheAngle) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.02, 0.02, 0.02);
  scene.fabric = test::woven_fabric();
  const Model model(scene);
  State state = model.flat_state(0);
  const double angle =
      0.3;  // pure shear of a frame: power of the four corner forces = tau * rate of the angle * volume
  const auto place = [](double X, double Y, double g) {
    return Eigen::Vector3d(X * std::cos(g / 2) + Y * std::sin(g / 2),
                           X * std::sin(g / 2) + Y * std::cos(g / 2), 0);
  };
  double power = 0;
  for (size_t n = 0; n < 4; ++n)
    put(state.position, n, place(scene.mesh.rest[n].x(), scene.mesh.rest[n].y(), angle));
  auto forces = model.terms().front()->entries();
  model.terms().front()->forces(state, forces.data());
  for (size_t n = 0; n < 4; ++n) {
    const Eigen::Vector2d X = scene.mesh.rest[n];
    const Eigen::Vector3d rate =
        (place(X.x(), X.y(), angle + 1e-6) - place(X.x(), X.y(), angle - 1e-6)) / 2e-6;
    power -= get(forces[0].force, n).dot(rate);
  }
  EXPECT_NEAR(power, scene.fabric.shear.slowest()(angle) * 3e-4 * 0.02 * 0.02,
              1e-3 * power);  // table resampled
}

}  // namespace
}  // namespace drapeplan
