// Motion: waves along a bar, order in time, a hanging chain.
#include <unistd.h>

#include <filesystem>

#include "fem/state_file.hpp"
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

using test::get;
using test::put;

constexpr double kLength = 1, kWidth = 0.02;

/// A bar of n elements along x, fixed at its nodes 0 and n + 1, undamped.
Scene bar(const test::Sheet& sheet, int n, double width = kWidth) {
  Scene scene = test::cantilever(sheet, kLength, width, n);
  scene.damping.reset();
  return scene;
}

constexpr test::Sheet kBar{1e9, 1e-3, 0.5};
const double kSpeed = std::sqrt(kBar.modulus * kBar.thickness / kBar.density);  // of axial waves [m/s]

// Clamped-free bar, u = sin(pi x / 2 L): frequency c / (4 L). Ten periods, counted at zero crossings of the
// tip.
TEST(Bar, SwingsAxiallyWithTheSpeedOfWaves) {
  constexpr int kElements = 40, kCrossings = 20;
  const Model model(bar(kBar, kElements));
  State state = model.flat_state(0);
  for (size_t n = 0; n < size_t(model.node_count()); ++n)
    state.x.x[n] += 1e-5 * std::sin(0.5 * std::numbers::pi * model.scene().mesh.rest[n].x() / kLength);
  Workspace work(model);
  const auto tip = size_t(kElements);
  double first = 0, last = 0, before = state.x.x[tip] - kLength;
  for (int crossings = 0; crossings <= kCrossings && state.step < 1000000;) {
    test::advance(model, state, work);
    const double now = state.x.x[tip] - kLength;
    if ((now > 0) != (before > 0)) {
      last = state.time - model.dt() * now / (now - before);
      if (crossings == 0) first = last;
      ++crossings;
    }
    before = now;
  }
  const double speed = 4 * kLength * kCrossings / 2 / (last - first);
  EXPECT_LE(test::figure("axial wave speed of a standing wave [m/s]", speed, kSpeed), 0.001);
}

// A node of a clamped line keeps the velocity that the state gives it: the end is pulled with V. Behind the
// front at c t the bar moves with V and carries rho c V.
TEST(Bar, CarriesAFrontWithTheStressOfItsEndVelocity) {
  constexpr int kElements = 400;
  const double velocity = 0.01;
  const Model model(bar(kBar, kElements));
  State state = model.flat_state(0);
  for (const size_t n : {size_t(0), size_t(kElements + 1)}) state.v.x[n] = -velocity;
  Workspace work(model);
  while (state.time < 0.7 * kLength / kSpeed) test::advance(model, state, work);
  int front = kElements;
  while (front > 0 && !(state.v.x[size_t(front)] < -0.5 * velocity)) --front;
  EXPECT_LE(test::figure("front of a wave [m]", front * kLength / kElements, kSpeed * state.time), 0.01);
  // Mean over the stretch behind the front, where the grid rings.
  const int behind = kElements / 2;
  const double strain = (state.x.x[size_t(behind)] - state.x.x[0]) / (behind * kLength / kElements) - 1;
  const double density = kBar.density / kBar.thickness;
  EXPECT_LE(test::figure("stress behind it [Pa]", kBar.modulus * strain, density * kSpeed * velocity), 0.01);
}

constexpr int kSwingElements = 8;
constexpr int kSwingSteps = 2000;     // of the coarsest run
constexpr double kSwingSafety = 0.2;  // of the coarsest run
constexpr int kExact = 32;            // times finer than the coarsest run

/// A strip to be set swinging; its step is `safety` of the stable one.
Model swing_model(double safety) {
  Scene scene = bar({1e9, 2e-2, 1}, kSwingElements, kLength / kSwingElements);
  scene.options.step_safety = safety;
  scene.options.bulk_viscosity = 0;  // grows with the step: of first order
  return Model(scene);
}

/// Smooth and with no force at the start, so the half-step velocities are those of the start up to second
/// order.
State swing_start(const Model& model) {
  State state = model.flat_state(0);
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    const double x = model.scene().mesh.rest[n].x() / kLength;
    if (x == 0) continue;
    state.v.z[n] = 40 * x * x;
    state.w.x[n] = -80 * x / kLength;
  }
  return state;
}

void play(const Model& model, State& state, int steps) {
  Workspace work(model);
  for (int k = 0; k < steps; ++k) test::advance(model, state, work);
}

/// The strip after kSwingSteps of the coarsest run, with steps `parts` times smaller.
State swung(int parts) {
  const Model model = swing_model(kSwingSafety / parts);
  State state = swing_start(model);
  play(model, state, kSwingSteps * parts);
  return state;
}

/// The same, through a file half-way: model, workspace and state are destroyed and built anew.
State swung_with_restart(int parts) {
  const int half = kSwingSteps * parts / 2;
  const auto file = std::filesystem::path(testing::TempDir()) /
                    ("drapeplan_swing_" + std::to_string(parts) + "_" + std::to_string(getpid()) + ".state");
  {
    const Model model = swing_model(kSwingSafety / parts);
    State state = swing_start(model);
    play(model, state, half);
    save_state(file, model, state);
  }
  const Model model = swing_model(kSwingSafety / parts);
  StateReading reading = load_state(file, model);
  std::filesystem::remove(file);
  if (!reading.value) throw std::runtime_error(reading.error);
  play(model, *reading.value, half);
  return *reading.value;
}

/// The same with a step that swells and shrinks smoothly by half of it, ten times in the run.
State swung_with_changing_step(int parts) {
  const Model model = swing_model(kSwingSafety / parts);
  const int steps = kSwingSteps * parts;
  const double end = model.dt() * steps;
  const auto time = [&](int k) {
    constexpr double kSwell = 0.5, kTurns = 10 * 2 * std::numbers::pi;
    const double share = double(k) / steps;
    return end * (share - kSwell * std::sin(kTurns * share) / kTurns);
  };
  State state = swing_start(model);
  state.dt_before = time(0) - time(-1);
  Workspace work(model);
  double least = end, most = 0;
  for (int k = 0; k < steps; ++k) {
    state.dt = time(k + 1) - time(k);
    least = std::min(least, state.dt);
    most = std::max(most, state.dt);
    test::advance(model, state, work);
  }
  EXPECT_GE(most / least, 2.9);
  EXPECT_LE(std::abs(state.time / end - 1), 1e-10);
  return state;
}

/// Halves the step twice: the tip's place converges with second order to that of constant, much finer steps.
void expect_second_order_in_time(State (*swing)(int)) {
  const Eigen::Vector3d exact = get(swung(kExact).x, kSwingElements);
  EXPECT_GT(std::abs(exact.z()), 0.02);
  std::vector<double> error;
  for (const int parts : {1, 2, 4}) error.push_back((get(swing(parts).x, kSwingElements) - exact).norm());
  for (size_t k = 1; k < error.size(); ++k) {
    const double slope = std::log2(error[k - 1] / error[k]);
    std::printf("  errors %.3g %.3g m, order in time %.3f\n", error[k - 1], error[k], slope);
    EXPECT_GE(slope, 1.8);
    EXPECT_LE(slope, 2.2);
  }
}

TEST(Motion, IsOfSecondOrderInTime) {
  expect_second_order_in_time(swung);
}

TEST(Motion, HasTheSameBitsAndOrderAcrossARestart) {
  for (const int parts : {1, 2, 4}) {
    const State through = swung(parts), restarted = swung_with_restart(parts);
    EXPECT_EQ(restarted.step, kSwingSteps * parts);
    const int nodes = 2 * (kSwingElements + 1);
    EXPECT_EQ(hash_state(through, nodes), hash_state(restarted, nodes)) << parts;
  }
  expect_second_order_in_time(swung_with_restart);
}

TEST(Motion, IsOfSecondOrderInTimeWithAStepThatChangesSmoothly) {
  expect_second_order_in_time(swung_with_changing_step);
}

// A chain of length 1.2 spans: z = a cosh(x / a) with a = span / (2 q), sinh(q) / q = 1.2, q = 1.0653;
// sag a (cosh q - 1) = 0.2924 spans. One section point has no bending stiffness.
TEST(Chain, HangsInACatenary) {
  constexpr int kElements = 40;
  const double span = 1, length = 1.2;
  test::Sheet sheet{1e9, 1e-3, 1};
  Scene scene = test::cantilever(sheet, length, kWidth, kElements);
  scene.options.section_points = 1;
  scene.clamped.clear();
  scene.pinned = {0, kElements, kElements + 1, 2 * kElements + 1};
  const double stretch = 1e-5;  // weight over membrane stiffness
  scene.gravity = stretch * sheet.modulus * sheet.thickness / (sheet.density * length);
  scene.damping = 2 * std::sqrt(*scene.gravity / length);  // near critical for the lowest swing
  const Model model(scene);
  State state = model.flat_state(0);
  const double slope = std::acos(span / length);  // starts as a V, its fibres at rest
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    const double s = scene.mesh.rest[n].x(), side = s < length / 2 ? -1 : 1;
    put(state.x, n,
        {s * std::cos(slope), scene.mesh.rest[n].y(), -std::min(s, length - s) * std::sin(slope)});
    put(state.d, n, {-side * std::sin(slope), 0, std::cos(slope)});
  }
  put(state.d, kElements / 2, {0, 0, 1});
  put(state.d, kElements / 2 + kElements + 1, {0, 0, 1});
  test::settle(model, state, 1e-5 * span);
  EXPECT_LE(test::figure("catenary, sag / span", -state.x.z[kElements / 2] / span, 0.2924), 0.01);
}

}  // namespace
}  // namespace drapeplan
