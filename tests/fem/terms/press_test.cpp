// The press: forces that follow the ply, when it acts, what is kept of the ply before it.
#include "fem/terms/press.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "fem/run/simulate.hpp"
#include "fem/run/stable_step.hpp"
#include "fem/run/state_file.hpp"
#include "mapping/error.hpp"
#include "tests/fem/core/term_kit.hpp"
#include "tests/fem/run/drapes.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

using test::get;

constexpr double kPressure = 2e4;  // [Pa]

Scene sheet() {
  Scene scene;
  scene.mesh = test::distorted_mesh(0.1, 0.06, 0.02, 0.2);
  scene.fabric = test::linear_fabric(1e9, 1e6, 2e5);
  scene.press = Press{.pressure = kPressure};
  return scene;
}

/// Volume between the ply and the plane z = 0 [m^3]: two Gauss points each way are exact for bilinear
/// elements.
double volume_below(const Mesh& mesh, const State& state) {
  const double g = 1 / std::sqrt(3.0);
  double sum = 0;
  for (const auto& quad : mesh.quads) {
    for (const auto& [xi, eta] : {std::pair{-g, -g}, {g, -g}, {g, g}, {-g, g}}) {
      Eigen::Vector3d x(0, 0, 0), along(0, 0, 0), across(0, 0, 0);
      constexpr double kXi[]{-1, 1, 1, -1}, kEta[]{-1, -1, 1, 1};
      for (size_t c = 0; c < 4; ++c) {
        const Eigen::Vector3d corner = get(state.position, size_t(quad[c]));
        x += 0.25 * (1 + kXi[c] * xi) * (1 + kEta[c] * eta) * corner;
        along += 0.25 * kXi[c] * (1 + kEta[c] * eta) * corner;
        across += 0.25 * kEta[c] * (1 + kXi[c] * xi) * corner;
      }
      sum += x.z() * along.cross(across).z();
    }
  }
  return sum;
}

// Where the edge stays in the plane z = 0, the energy of the press is the pressure times the volume over it.
TEST(Press, PassesTheTermKitWithTheVolumeThatItPressesOut) {
  const Scene scene = sheet();
  const Model model(scene);
  EXPECT_EQ(model.term_names(), (std::vector<std::string>{"shell, 3 section points", "press"}));
  test::TermSubject subject{.model = &model, .term = 1, .state = model.flat_state(0)};
  test::disturb(subject.state, model.node_count(), 4e-3, 0.1);
  for (const int n : scene.mesh.outline) subject.state.position.z[size_t(n)] = 0;
  subject.state.pressure = kPressure;
  subject.energy = [&](const State& at) { return kPressure * volume_below(scene.mesh, at); };
  subject.length_step = 1e-5;
  subject.tolerance = 1e-8;
  subject.turns_with_scene = true;
  subject.rest = model.flat_state(0);
  test::check_term(subject);
}

TEST(Press, PushesAFlatPlyDownWithPressureTimesAreaAlsoWithTriangles) {
  Scene scene = sheet();
  const Polygon shape{{0, 0}, {0.1, 0}, {0.12, 0.05}, {0.04, 0.1}, {-0.02, 0.04}};
  scene.mesh = outline_mesh(shape, 0.02);
  const Model model(scene);
  test::TermSubject subject{.model = &model, .term = 1, .state = model.flat_state(0)};
  subject.state.pressure = kPressure;
  const test::TermForces f = test::term_forces(subject, subject.state);
  double area = 0;
  Eigen::Vector3d sum(0, 0, 0);
  for (const double part : nodal_areas(scene.mesh)) area += part;
  for (const Eigen::Vector3d& part : f.force) sum += part;
  EXPECT_LE((sum - Eigen::Vector3d(0, 0, -kPressure * area)).norm(), 1e-12 * kPressure * area);
}

TEST(Press, LowersTheStableStepByNoLessThanItsStiffnessDoes) {
  Scene scene = sheet();
  scene.fabric = test::linear_fabric(1e6, 1e4, 2e5);  // so soft that the press counts
  scene.press->pressure = 1e6;
  scene.options.bulk_viscosity = 0;
  const Model model(scene);
  State state = model.flat_state(0);
  test::disturb(state, model.node_count(), 1e-3, 0.02);
  for (const double pressure : {0.0, 1e6}) {
    state.pressure = pressure;
    state.dt = model.dt();
    StepScratch scratch(model);
    State copy = state;
    EXPECT_LE(stable_step(model, copy, scratch), 1.001 * true_stable_step(model, state)) << pressure;
  }
}

TEST(Press, RisesSmoothlyFromItsBeginAndStays) {
  const Press press{.pressure = 5, .delay = 0.5, .duration = 3, .ramp = 2};
  Schedule schedule{.paths = {{{0, 1}, {2, 0}, {7, 0}}}, .blend_time = 0.25};
  const PressTimes times = press_times(press, &schedule, 9);
  EXPECT_EQ(times.start, 2.75);
  EXPECT_EQ(times.full, 4.75);
  EXPECT_EQ(times.end, 5.75);
  EXPECT_EQ(press_times({.pressure = 5}, &schedule, 9).start, 9);
  EXPECT_EQ(press_times(press, nullptr, 9).start, 9.5);
  EXPECT_EQ(pressure_at(times, 5, 2.75), 0);
  EXPECT_EQ(pressure_at(times, 5, 3.75), 2.5);
  EXPECT_EQ(pressure_at(times, 5, 4.75), 5);
  EXPECT_EQ(pressure_at(times, 5, 100), 5);
  EXPECT_LE(pressure_at(times, 5, 2.7501), 1e-6);
}

TEST(Press, IsRefusedWhereItMakesNoSense) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const Press& wrong :
       {Press{.pressure = -1}, Press{.pressure = kNaN}, Press{.pressure = 1, .delay = -1},
        Press{.pressure = 1, .duration = 1, .ramp = 2}, Press{.pressure = 1, .ramp = 0}}) {
    Scene scene = sheet();
    scene.press = wrong;
    EXPECT_THROW(Model{scene}, WrongInput);
  }
}

/// A drape of two by two grippers, pressed when it lies.
Scene pressed_corner() {
  Scene scene = test::corner_drape(0.02);
  scene.press = Press{.pressure = kPressure, .duration = 1.5, .ramp = 0.5};
  return scene;
}

TEST(Press, KeepsThePlyAsItIsWithoutAndPressesItDown) {
  Scene scene = pressed_corner();
  const Schedule schedule = test::drop(scene);
  const RunResult pressed = simulate(Model(scene), {.schedule = &schedule});
  scene.press.reset();
  const RunResult plain = simulate(Model(scene), {.schedule = &schedule});
  ASSERT_EQ(pressed.summary.status, RunStatus::done) << pressed.summary.message;
  ASSERT_TRUE(pressed.unpressed);
  EXPECT_FALSE(plain.unpressed);
  EXPECT_EQ(pressed.unpressed->position, plain.final.position);
  EXPECT_EQ(pressed.unpressed->shear, plain.final.shear);
  EXPECT_EQ(pressed.unpressed->warp_strain, plain.final.warp_strain);
  EXPECT_EQ(pressed.state.unpressed_record.actuator_force, plain.state.record.actuator_force);
  EXPECT_NEAR(pressed.final.time, plain.final.time + 1.5, 1e-9);
  scene.press = pressed_corner().press;
  const RunResult before = simulate(Model(scene), {.schedule = &schedule, .press = false});
  EXPECT_EQ(before.summary.status, RunStatus::done);
  EXPECT_FALSE(before.unpressed);
  EXPECT_EQ(before.final.position, plain.final.position);
  const auto largest_gap = [&](const Snapshot& ply) {
    double gap = 0;
    for (const Eigen::Vector3d& x : ply.position)
      gap = std::max(gap, scene.mold->closest(x).signed_distance - 0.5 * scene.fabric.thickness);
    return gap;
  };
  std::printf("  largest gap %.3f mm, pressed %.3f mm\n", 1e3 * largest_gap(plain.final),
              1e3 * largest_gap(pressed.final));
  EXPECT_LE(largest_gap(pressed.final), 0.8 * largest_gap(plain.final));
  EXPECT_LE(pressed.summary.energy.balance_error, 1e-11);
  EXPECT_GT(pressed.state.work[size_t(Book::load)], 0);
}

TEST(Press, GoesOnFromASavedStateWithTheSameBits) {
  const Model model(pressed_corner());
  const Schedule schedule = test::drop(model.scene());
  const RunResult whole = simulate(model, {.schedule = &schedule});
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "press_test.state";
  const double start = schedule.duration();
  for (const double pause : {start - 0.3, start, start + 0.2, start + 1}) {
    const RunResult part = simulate(model, {.schedule = &schedule, .pause = pause});
    ASSERT_EQ(part.summary.status, RunStatus::paused) << pause;
    save_state(file, model, part.state, &schedule);
    const StateReading reading = load_state(file, model, &schedule);
    ASSERT_TRUE(reading.value) << reading.error;
    const RunResult rest = simulate(model, {.schedule = &schedule, .from = &*reading.value});
    EXPECT_EQ(rest.summary.state_hash, whole.summary.state_hash) << pause;
    EXPECT_EQ(rest.state.pressure, kPressure);
    ASSERT_TRUE(rest.unpressed);
    EXPECT_EQ(rest.unpressed->position, whole.unpressed->position) << pause;
    EXPECT_EQ(rest.state.unpressed_record.actuator_force, whole.state.unpressed_record.actuator_force);
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace drapeplan
