// The shell term: its force is the derivative of its energy, it is objective, it passes the patch test.
#include "fem/shell.hpp"

#include <gtest/gtest.h>

#include "fem/simulate.hpp"
#include "fem/workspace.hpp"
#include "tests/fem/scenes.hpp"

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
    model.emplace(scene);
    state = model->flat_state(0.02);
    forces = model->terms().front()->entries();
    nodes = size_t(model->node_count());
  }
  double energy() {
    const ShellEnergy e = model->shell().stored_energy(state);
    return e.fabric + e.hourglass;
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

TEST_P(ShellTerms, HaveNoForceInTheFlatRestShape) {
  compute();
  for (size_t n = 0; n < nodes; ++n) {
    // Round-off of positions of 0.1 m against a fibre stiffness of 1e10 Pa * 3e-4 m.
    EXPECT_LE(get(forces[0].force, n).norm(), 1e-8);
    EXPECT_LE(get(forces[0].moment, n).norm(), 1e-12);
  }
}

TEST_P(ShellTerms, AreMinusTheDerivativeOfTheirEnergy) {
  test::disturb(state, int(nodes), 4e-5, 0.05);
  compute();
  const double h = 1e-8;
  double largest = 0, error = 0;
  for (size_t n = 0; n < nodes; ++n) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d x = get(state.x, n), d = get(state.d, n), step = h * Eigen::Vector3d::Unit(k);
      put(state.x, n, x + step);
      const double up = energy();
      put(state.x, n, x - step);
      const double down = energy();
      put(state.x, n, x);
      error = std::max(error, std::abs(get(forces[0].force, n)[k] + (up - down) / (2 * h)));
      largest = std::max(largest, std::abs(get(forces[0].force, n)[k]));
      put(state.d, n, d + 1e3 * step);
      const double up_d = energy();
      put(state.d, n, d - 1e3 * step);
      const double down_d = energy();
      put(state.d, n, d);
      EXPECT_NEAR(get(forces[0].moment, n)[k], -(up_d - down_d) / (2e3 * h),
                  3e-5 * get(forces[0].moment, n).norm() + 1e-9);
    }
  }
  EXPECT_GT(largest, 1.0);
  EXPECT_LE(error, 1e-4 * largest);  // kinks of the tables within the difference step
}

TEST_P(ShellTerms, HaveNoResultingForceAndMoment) {
  test::disturb(state, int(nodes), 4e-5, 0.05);
  compute();
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  double size = 0;
  for (size_t n = 0; n < nodes; ++n) {
    const Eigen::Vector3d f = get(forces[0].force, n);
    force += f;
    moment += get(state.x, n).cross(f) + get(state.d, n).cross(get(forces[0].moment, n));
    size += f.norm();
  }
  EXPECT_GT(size, 1.0);
  EXPECT_LE(force.norm(), 1e-12 * size);
  EXPECT_LE(moment.norm(), 1e-12 * size);
}

TEST_P(ShellTerms, TurnWithTheScene) {
  test::disturb(state, int(nodes), 4e-5, 0.05);
  compute();
  std::vector<Eigen::Vector3d> before;
  for (size_t n = 0; n < nodes; ++n) before.push_back(get(forces[0].force, n));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  test::rotate(state, int(nodes), turn);
  compute();
  for (size_t n = 0; n < nodes; ++n) EXPECT_LE((get(forces[0].force, n) - turn * before[n]).norm(), 1e-7);
}

// Constant membrane strain and constant curvature fields must leave inner nodes free of force and moment.
TEST_P(ShellTerms, PassThePatchTest) {
  for (size_t n = 0; n < nodes; ++n) {
    const Eigen::Vector3d x = get(state.x, n);
    put(state.x, n, {x.x() + 1e-3 * (x.x() + 0.5 * x.y()), x.y() + 1e-3 * (x.y() + 0.5 * x.x()), x.z()});
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

// With a linear law the estimate must be close to the truth from below. (The fabric's estimate is for its
// stiffest strain.)
TEST_P(ShellTerms, StayBoundedBelowTheStableStepAndGrowAboveIt) {
  for (const double factor : {0.98, 1.3}) {
    Scene free = scene;
    free.fabric = test::linear_fabric(1e9, 1e6, 2e5);
    free.options.step_safety = factor;
    const Model run(free);
    State s = run.flat_state(0);
    test::disturb(s, int(nodes), 1e-9, 0);
    Workspace work(run);
    for (int k = 0; k < 20000; ++k) {
      compute_forces(run, s, work);
      kick_nodes(run, s, work);
      drift_nodes(run, s);
    }
    double speed = 0;
    for (size_t n = 0; n < nodes; ++n) speed += std::abs(s.v.x[n]);  // a sum, since max() would lose NaN
    const double bounded = 1e-9 / run.dt() * 100 * double(nodes);
    if (factor < 1) {
      EXPECT_LE(speed, bounded);
    } else {
      EXPECT_FALSE(speed <= bounded);
    }
  }
}

TEST(Shell, StretchesAlongAFibreWithTheTablesStress) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.02, 0.02, 0.02);
  scene.fabric = test::woven_fabric();
  const Model model(scene);
  State state = model.flat_state(0);
  const double strain = 0.002;
  for (size_t n = 0; n < 4; ++n) state.x.x[n] *= 1 + strain;
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
    put(state.x, n, place(scene.mesh.rest[n].x(), scene.mesh.rest[n].y(), angle));
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
