// Loads and gravity: terms of constant direction; pinned nodes.
#include "fem/terms/loads.hpp"

#include <gtest/gtest.h>

#include "fem/run/simulate.hpp"
#include "tests/fem/core/term_kit.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

using test::get;

Scene sheet() {
  Scene scene;
  scene.mesh = rectangle_mesh(0.1, 0.06, 0.02);
  scene.fabric = test::linear_fabric(1e9, 1e6, 2e5);
  return scene;
}

TEST(Gravity, PassesTheTermKit) {
  Scene scene = sheet();
  scene.gravity = 9.81;
  const Model model(scene);
  test::TermSubject subject{.model = &model, .term = 1, .state = model.flat_state(0)};
  test::disturb(subject.state, model.node_count(), 1e-3, 0.1);
  const std::vector<double> area = nodal_areas(scene.mesh);
  subject.energy = [&](const State& at) {
    double sum = 0;
    for (size_t n = 0; n < area.size(); ++n)
      sum += scene.fabric.areal_density * area[n] * 9.81 * at.position.z[n];
    return sum;
  };
  subject.length_step = 1e-3;  // the energy is linear
  subject.tolerance = 1e-9;
  test::check_term(subject);
}

TEST(Loads, PassTheTermKit) {
  Scene scene = sheet();
  const Eigen::Vector3d push(1, 2, 3), pressure(10, -20, 5);
  const double moment = 0.02;  // about y; with directors in the x-z plane it has an energy
  scene.loads =
      Loads{.forces = {{2, push}, {2, push}}, .moments = {{5, {0, moment, 0}}}, .pressure = pressure};
  const Model model(scene);
  EXPECT_EQ(model.term_names(), (std::vector<std::string>{"shell, 3 section points", "loads"}));
  test::TermSubject subject{.model = &model, .term = 1, .state = model.flat_state(0)};
  test::disturb(subject.state, model.node_count(), 1e-3, 0);
  test::put(subject.state.director, 5, {std::sin(0.8), 0, std::cos(0.8)});
  const std::vector<double> area = nodal_areas(scene.mesh);
  subject.energy = [&](const State& at) {
    double sum = -2 * push.dot(get(at.position, 2)) - moment * std::atan2(at.director.x[5], at.director.z[5]);
    for (size_t n = 0; n < area.size(); ++n) sum -= area[n] * pressure.dot(get(at.position, n));
    return sum;
  };
  subject.tolerance = 1e-6;
  test::check_term(subject);
}

TEST(Loads, TurnADirectorAboutTheirAxisWithTheirFullMoment) {
  Scene scene = sheet();
  const Eigen::Vector3d moment(0.3, -0.2, 0.1);
  scene.loads = Loads{.moments = {{4, moment}}};
  const Model model(scene);
  test::TermSubject subject{.model = &model, .term = 1, .state = model.flat_state(0)};
  test::disturb(subject.state, model.node_count(), 0, 1);
  const Eigen::Vector3d d = get(subject.state.director, 4),
                        m = test::term_forces(subject, subject.state).moment[4];
  EXPECT_LE((d.cross(m) - (moment - moment.dot(d) * d)).norm(),
            1e-15);  // all of M but its part about d itself
}

TEST(Loads, AreBookedAsExternalWork) {
  Scene scene = sheet();
  for (int n = 0; n < scene.mesh.node_count(); ++n) {
    if (scene.mesh.rest[size_t(n)].x() < -0.0499) scene.clamped.push_back(n);
  }
  const int tip = scene.mesh.node_count() - 1;
  scene.loads =
      Loads{.forces = {{tip, {0, 0, 1e-3}}}, .moments = {{tip, {0, -1e-5, 0}}}, .pressure = {0, 0, 0.1}};
  const RunResult run = simulate(Model(scene), {.schedule = nullptr, .duration = 0.05});
  EXPECT_EQ(run.summary.status, RunStatus::done);
  EXPECT_GT(run.summary.energy.external, 0);
  EXPECT_LE(run.summary.energy.balance_error, 1e-9);
}

// A moment stiffens or softens a director by no more than |M|: the bound of the step grows with it.
TEST(Loads, LowerTheStableStepByLargeMomentsOnly) {
  Scene scene = sheet();
  const double plain = Model(scene).stable_dt();
  scene.loads = Loads{.forces = {{4, {1e6, 0, 0}}}};
  EXPECT_EQ(Model(scene).stable_dt(), plain);
  scene.loads = Loads{.moments = {{4, {0, 1e6, 0}}}};
  EXPECT_LE(Model(scene).stable_dt(), plain);
}

TEST(Loads, RefuseNodesThatDoNotExistAndValuesThatAreNotFinite) {
  Scene scene = sheet();
  scene.loads = Loads{.forces = {{scene.mesh.node_count(), {1, 0, 0}}}};
  EXPECT_THROW(Model{scene}, std::invalid_argument);
  scene.loads = Loads{.moments = {{-1, {1, 0, 0}}}};
  EXPECT_THROW(Model{scene}, std::invalid_argument);
  scene.loads = Loads{.pressure = {0, std::nan(""), 0}};
  EXPECT_THROW(Model{scene}, std::invalid_argument);
}

TEST(Pinned, NodesKeepTheirPlaceWhileTheirDirectorsTurn) {
  Scene scene = sheet();
  scene.pinned = scene.mesh.outline;
  scene.loads = Loads{.pressure = {0, 0, 1}};
  const Model model(scene);
  const RunResult run = simulate(model, {.schedule = nullptr, .duration = 0.005});
  double turned = 0;
  for (const int n : scene.pinned) {
    EXPECT_EQ((run.final.position[size_t(n)].head<2>() - scene.mesh.rest[size_t(n)]).norm(), 0);
    EXPECT_EQ(run.final.position[size_t(n)].z(), 0);
    turned = std::max(turned, run.final.director[size_t(n)].head<2>().norm());
  }
  EXPECT_GT(turned, 1e-5);
  EXPECT_LE(run.summary.energy.balance_error, 1e-9);
}

}  // namespace
}  // namespace drapeplan
