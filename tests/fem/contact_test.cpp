// Contact and friction on an inclined plane, where everything is known.
#include "fem/contact.hpp"

#include <gtest/gtest.h>

#include "fem/simulate.hpp"
#include "fem/workspace.hpp"
#include "tests/fem/scenes.hpp"

namespace drapeplan {
namespace {

constexpr double kGravity = 9.81;

/// A small stiff sheet that lies on a plane falling by `angle` towards +x, moving with gravity along the
/// slope.
struct Incline {
  Incline(double angle, double friction) {
    scene.mesh = rectangle_mesh(0.04, 0.04, 0.02);
    scene.fabric = test::linear_fabric(1e9, 1e8, 1e7);
    scene.options.mass_scaling = 1;
    scene.gravity = kGravity;
    scene.mold.emplace(PlaneShape{angle}, Extent{{-1, -1}, {1, 1}});
    scene.friction = friction;
    model.emplace(scene);
    state = model->flat_state(0);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    test::rotate(state, model->node_count(), turn);
    const Eigen::Vector3d normal = turn.col(2);
    // Lifted by half the thickness less the static penetration, so that nothing bounces. A bouncing node
    // loses the friction of the step at which it touches anew.
    NodalStiffness stiffness(9);
    model->terms().front()->add_stiffness(stiffness);
    const std::vector<double> area = nodal_areas(scene.mesh);
    for (size_t n = 0; n < size_t(model->node_count()); ++n) {
      const double weight = 0.314 * area[n] * kGravity * std::cos(angle);
      const double sunk = weight / (scene.options.contact_stiffness * stiffness.translation[n]);
      test::put(state.x, n, test::get(state.x, n) + (1.5e-4 - sunk) * normal);
    }
  }
  /// Distance moved by the sheet's middle down the slope in `time`.
  double slide(double time) {
    Workspace work(*model);
    const auto middle = size_t(model->node_count() / 2);
    const Eigen::Vector3d start = test::get(state.x, middle);
    for (double t = 0; t < time; t += model->dt()) {
      compute_forces(*model, state, work);
      kick_nodes(*model, state, work);
      drift_nodes(*model, state);
    }
    return (test::get(state.x, middle) - start).norm();
  }
  Scene scene;
  std::optional<Model> model;
  State state;
};

TEST(Friction, HoldsASheetBelowItsAngleWithoutCreep) {
  Incline incline(std::atan(0.5) - 0.02, 0.5);
  incline.slide(0.02);
  // No creep: what is left is the elastic oscillation of the anchored springs.
  EXPECT_LE(incline.slide(0.05), 2e-8);
  EXPECT_LE(incline.slide(0.5), 2e-8);
}

TEST(Friction, LetsASheetSlideAboveItsAngleWithTheClosedFormAcceleration) {
  const double angle = std::atan(0.5) + 0.2;
  const double acceleration = kGravity * (std::sin(angle) - 0.5 * std::cos(angle));
  Incline incline(angle, 0.5);
  const double time = 0.1;  // some 5000 steps; the measured path is up to two steps too long
  EXPECT_NEAR(incline.slide(time), 0.5 * acceleration * time * time,
              0.002 * 0.5 * acceleration * time * time);
}

TEST(Contact, CarriesTheWeightOfAPlyAtRest) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.04, 0.04, 0.02);
  scene.fabric = test::linear_fabric(1e9, 1e8, 1e7);
  scene.options.mass_scaling = 1;
  scene.gravity = kGravity;
  scene.damping = 500;
  scene.mold.emplace(PlaneShape{0}, Extent{{-1, -1}, {1, 1}});
  const Model model(scene);
  State state = model.flat_state(1.5e-4);
  Workspace work(model);
  for (double t = 0; t < 0.05; t += model.dt()) {
    compute_forces(model, state, work);
    kick_nodes(model, state, work);
    drift_nodes(model, state);
  }
  double press = 0;
  for (size_t n = 0; n < size_t(model.node_count()); ++n) press += work.entries[2].force.z[n];
  EXPECT_NEAR(press, 0.314 * 0.04 * 0.04 * kGravity, 1e-4 * press);
}

}  // namespace
}  // namespace drapeplan
