// Whole runs of small scenes: books, conservation, determinism, divergence as a result.
#include "fem/run/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fem/run/workspace.hpp"
#include "tests/fem/run/drapes.hpp"

namespace drapeplan {
namespace {

using test::get;

Scene small_drape() {
  return test::middle_drape(0.22, 0.0125);
}

TEST(Simulate, ClosesItsBooksToRoundOffInADrape) {
  const Scene scene = small_drape();
  const Schedule schedule = test::drop(scene);
  const RunResult result = simulate(Model(scene), {.schedule = &schedule});
  EXPECT_EQ(result.summary.status, RunStatus::done) << result.summary.message;
  EXPECT_LE(result.summary.energy.balance_error, 1e-9);
  EXPECT_GT(result.summary.energy.friction, 0);
  EXPECT_GT(result.summary.energy.damping, 0);
  EXPECT_GT(result.summary.energy.internal, 0);
  EXPECT_LE(result.state.record.fibre_strain, 0.02);
  EXPECT_LE(result.summary.largest_link_error, 1e-7);
}

TEST(Simulate, GivesTheSameBitsTwice) {
  const Scene scene = small_drape();
  const Schedule schedule = test::drop(scene);
  const Model model(scene);
  const auto first = simulate(model, {.schedule = &schedule}).summary.state_hash;
  EXPECT_EQ(first, simulate(model, {.schedule = &schedule}).summary.state_hash);
  EXPECT_EQ(first, simulate(Model(scene), {.schedule = &schedule}).summary.state_hash);
}

TEST(Simulate, ReportsDivergenceAsAResultWithItsPlace) {
  Scene scene = small_drape();
  scene.options.step_safety = 4;
  const Schedule schedule = test::drop(scene);
  const RunResult result = simulate(Model(scene), {.schedule = &schedule});
  EXPECT_EQ(result.summary.status, RunStatus::diverged);
  EXPECT_NE(result.summary.message.find("not finite"), std::string::npos) << result.summary.message;
}

TEST(Simulate, ListsOnlyTheTermsThatTheSceneNeeds) {
  Scene strip;
  strip.mesh = rectangle_mesh(0.1, 0.02, 0.01);
  strip.fabric = test::woven_fabric();
  EXPECT_EQ(Model(strip).term_names(), std::vector<std::string>{"shell, 3 section points"});
  EXPECT_TRUE(Model(strip).flat_state(0).anchor.x.empty());
  strip.gravity = 9.81;
  EXPECT_EQ(Model(strip).term_names(), (std::vector<std::string>{"shell, 3 section points", "gravity"}));
  strip.options.section_points = 1;
  strip.damping = 10;
  strip.clamped = {0};
  EXPECT_EQ(Model(strip).term_names(),
            (std::vector<std::string>{"shell, 1 section point", "gravity", "mass damping", "clamp"}));
  const Scene drape = small_drape();
  const std::vector<std::string> names = Model(drape).term_names();
  for (const char* name : {"contact with friction", "gripper rig with interlinks", "fixed joint"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

TEST(Simulate, KeepsNoMemoryForWhatTheSceneDoesNotHave) {
  Scene strip;
  strip.mesh = rectangle_mesh(0.1, 0.02, 0.01);
  strip.fabric = test::woven_fabric();
  const Model model(strip);
  const State state = model.flat_state(0);
  for (const auto* field : {&state.anchor, &state.edges[0], &state.edges[1]}) EXPECT_TRUE(field->x.empty());
  EXPECT_TRUE(state.stuck.empty());
  EXPECT_TRUE(state.pads.empty());
  const Workspace work(model);
  EXPECT_EQ(work.entries.size(), 1u);
  for (const auto* field : {&work.mean_v, &work.mean_w, &work.force, &work.moment})
    EXPECT_TRUE(field->x.empty());
  EXPECT_TRUE(work.has_tied.empty());
  EXPECT_TRUE(work.rig.free_v.empty());
  EXPECT_TRUE(work.inertia.mobility.empty());
  strip.options.step_interval = 0;  // one step for good: nothing to choose it with
  const Model steady(strip);
  EXPECT_TRUE(steady.flat_state(0).lightness.empty());
  EXPECT_TRUE(Workspace(steady).step.sections.empty());
}

TEST(Simulate, ReportsWhichFiguresTheSceneHas) {
  Scene strip;
  strip.mesh = rectangle_mesh(0.1, 0.02, 0.01);
  strip.fabric = test::woven_fabric();
  const SummaryParts none = simulate(Model(strip), {.duration = 1e-3}).summary.parts;
  for (const bool part :
       {none.external, none.contact, none.friction, none.damping, none.constraint, none.links})
    EXPECT_FALSE(part);
  const Scene drape = small_drape();
  const SummaryParts all = Model(drape).summary_parts();
  for (const bool part : {all.external, all.contact, all.friction, all.constraint, all.links})
    EXPECT_TRUE(part);
}

TEST(Simulate, LeavesAFreeSheetAtRest) {
  Scene sheet;
  sheet.mesh = rectangle_mesh(0.1, 0.1, 0.0033);
  sheet.fabric = test::woven_fabric();
  const RunResult result = simulate(Model(sheet), {.duration = 0.02});
  EXPECT_EQ(result.summary.status, RunStatus::done) << result.summary.message;
  EXPECT_LE(result.summary.energy.balance_error, 1e-3);
  EXPECT_LE(std::abs(result.final.position.front().z()), 1e-15);
}

TEST(Simulate, WithoutDampingIsTheSameAsWithNone) {
  Scene strip;
  strip.mesh = rectangle_mesh(0.1, 0.02, 0.01);
  strip.fabric = test::woven_fabric();
  strip.gravity = 9.81;
  strip.clamped = {0, 1, 2};
  const auto hash = [&strip] { return simulate(Model(strip), {.duration = 0.01}).summary.state_hash; };
  const std::uint64_t absent = hash();
  strip.damping = 0;
  EXPECT_EQ(absent, hash());
  strip.damping = 1;
  EXPECT_NE(absent, hash());
}

TEST(Simulate, RefusesAPadWithoutNodesAndAScheduleOfAnotherRig) {
  Scene scene = small_drape();
  const Schedule schedule = test::drop(scene);
  scene.rig->columns = scene.rig->rows = 2;
  scene.rig->fixed.reset();
  const Model model(scene);
  EXPECT_THROW(simulate(model, {.schedule = &schedule}), std::invalid_argument);
  scene.rig->pad_radius = 1e-4;
  scene.mesh = rectangle_mesh(0.22, 0.22, 0.0137);  // no line through the pads
  EXPECT_THROW(Model{scene}, std::invalid_argument);
}

TEST(Simulate, ConservesMomentumInFreeFlight) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.1, 0.1, 0.02);
  scene.fabric = test::woven_fabric();
  const Model model(scene);
  State state = model.flat_state(0);
  const auto nodes = size_t(model.node_count());
  for (size_t n = 0; n < nodes; ++n) {  // a spin about a slanted axis, and a stretch
    const Eigen::Vector3d x = get(state.position, n), spin(1, 2, 5);
    test::put(state.velocity, n,
              spin.cross(x) + Eigen::Vector3d(0.3, 0.2, 0.1) + 0.5 * Eigen::Vector3d(x.x(), 0, 0));
    test::put(state.director_rate, n, spin.cross(Eigen::Vector3d::UnitZ()));
  }
  const auto momenta = [&] {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
    for (size_t n = 0; n < nodes; ++n) {
      linear += model.mass()[n] * get(state.velocity, n);
      // Velocities belong to t - dt/2; drifting with them back by half a step changes no x cross v.
      angular += model.mass()[n] * get(state.position, n).cross(get(state.velocity, n)) +
                 model.inertia()[n] * get(state.director, n).cross(get(state.director_rate, n));
    }
    return std::pair{linear, angular};
  };
  const auto [linear, angular] = momenta();
  Workspace work(model);
  for (int k = 0; k < 20000; ++k) {
    compute_forces(model, state, work);
    kick_nodes(model, state, work);
    drift_nodes(model, state);
  }
  const auto [linear_end, angular_end] = momenta();
  EXPECT_LE((linear_end - linear).norm(), 1e-13 * linear.norm());
  EXPECT_LE((angular_end - angular).norm(), 1e-13 * angular.norm());
}

double stored_energy(const Model& model, const State& state) {
  const ShellEnergy e = model.shell().stored_energy(state);
  return e.fabric + e.hourglass;
}

/// A strip of a linear law, clamped at one end. Nothing takes energy from it.
Scene elastic_strip() {
  Scene scene;
  scene.mesh = rectangle_mesh(0.1, 0.02, 0.01);
  scene.fabric = test::linear_fabric(1e9, 1e8, 1e8);
  scene.options.mass_scaling = 1;
  scene.options.bulk_viscosity = 0;
  for (int n = 0; n < scene.mesh.node_count(); ++n) {
    if (scene.mesh.rest[size_t(n)].x() < -0.0499) scene.clamped.push_back(n);
  }
  return scene;
}

/// One step with its books. Returns the stored energy at the instant of the books and of the velocities:
/// half a step behind the positions of before, so the mean of those before and after.
double step_with_books(const Model& model, State& state, Workspace& work) {
  compute_forces(model, state, work);
  kick_nodes(model, state, work);
  book_work(model, state, work);
  const double before = stored_energy(model, state);
  drift_nodes(model, state);
  advance_clock(state);
  return 0.5 * (before + stored_energy(model, state));
}

// Booked elastic work against stored energy: a second check of the books, of second order in the step.
TEST(Simulate, BooksElasticWorkThatApproachesTheStoredEnergyWithSecondOrder) {
  std::vector<double> error;
  for (const double safety : {0.8, 0.4, 0.2}) {
    Scene scene = elastic_strip();
    scene.options.step_safety = safety;
    scene.gravity = 9.81;
    const Model model(scene);
    State state = model.flat_state(0);
    Workspace work(model);
    double largest = 0, most = 0;
    while (state.time < 0.05) {
      const double stored = step_with_books(model, state, work);
      most = std::max(most, stored);
      const double difference = std::abs(-state.work[size_t(Book::internal)] - stored);
      if (!(difference <= largest)) largest = difference;  // NaN stays
    }
    error.push_back(largest / most);
  }
  EXPECT_LE(error[0], 0.05);
  for (size_t k = 1; k < error.size(); ++k) {
    const double slope = std::log2(error[k - 1] / error[k]);
    std::printf("  errors %.3g %.3g, order of the books %.3f\n", error[k - 1], error[k], slope);
    EXPECT_GE(slope, 1.8);
    EXPECT_LE(slope, 2.2);
  }
}

// Central differences keep an energy near the true one for as long as one likes: what swings smoothly keeps
// its energy in narrow bounds, without drift.
TEST(Simulate, KeepsTheEnergyOfAnElasticStripThatSwings) {
  constexpr int kSteps = 200000, kParts = 10;
  Scene scene = elastic_strip();
  scene.options.step_safety = 0.9;
  const Model model(scene);
  State state = model.flat_state(0);
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    const double x = (scene.mesh.rest[n].x() + 0.05) / 0.1;
    if (model.mass()[n] == 0) continue;
    state.velocity.z[n] = x * x;
    state.director_rate.x[n] = -2 * x / 0.1;
  }
  const double start = kinetic_energy(model, state);
  Workspace work(model);
  double balance = 0, least = 0, most = 0, most_stored = 0;
  std::vector<double> mean(kParts, 0.0);
  for (int k = 0; k < kSteps; ++k) {
    const double stored = step_with_books(model, state, work), kinetic = kinetic_energy(model, state);
    const double total = (kinetic + stored) / start;
    balance = std::max(balance, std::abs(kinetic - state.work[size_t(Book::internal)] - start) / start);
    least = k == 0 ? total : std::min(least, total);
    most = std::max(most, total);
    most_stored = std::max(most_stored, stored / start);
    mean[size_t(k / (kSteps / kParts))] += total * kParts / kSteps;
  }
  std::printf(
      "  stored and kinetic energy within %.3g of the start's, last tenth less first %.2g, books %.2g\n",
      most - least, mean.back() - mean.front(), balance);
  EXPECT_GE(most_stored, 0.9);
  EXPECT_LE(most - least, 1e-6);
  EXPECT_LE(std::abs(mean.back() - mean.front()), 1e-7);
  EXPECT_LE(balance, 1e-11);
}

}  // namespace
}  // namespace drapeplan
