// Motion: waves along a bar, order in time, a hanging chain.
#include <unistd.h>

#include <filesystem>

#include "fem/run/state_file.hpp"
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

using test::get;
using test::put;

constexpr double kLength = 1, kWidth = 0.02;

/// A bar of n elements along x, fixed at its nodes 0 and n + 1, undamped.
Scene bar(const Sheet& sheet, int n, double width = kWidth) {
  Scene scene = cantilever(sheet, kLength, width, n);
  scene.damping.reset();
  return scene;
}

constexpr Sheet kBar{1e9, 1e-3, 0.5};
const double kSpeed = std::sqrt(kBar.modulus * kBar.thickness / kBar.density);  // of axial waves [m/s]

// Clamped-free bar, u = sin(pi x / 2 L): frequency c / (4 L). Ten periods, counted at zero crossings of the
// tip.
TEST(Bar, SwingsAxiallyWithTheSpeedOfWaves) {
  constexpr int kElements = 40, kCrossings = 20;
  const Model model(bar(kBar, kElements));
  State state = model.flat_state(0);
  for (size_t n = 0; n < size_t(model.node_count()); ++n)
    state.position.x[n] += 1e-5 * std::sin(0.5 * std::numbers::pi * model.scene().mesh.rest[n].x() / kLength);
  Workspace work(model);
  const auto tip = size_t(kElements);
  double first = 0, last = 0, before = state.position.x[tip] - kLength;
  for (int crossings = 0; crossings <= kCrossings && state.step < 1000000;) {
    advance(model, state, work);
    const double now = state.position.x[tip] - kLength;
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
  for (const size_t n : {size_t(0), size_t(kElements + 1)}) state.velocity.x[n] = -velocity;
  Workspace work(model);
  while (state.time < 0.7 * kLength / kSpeed) advance(model, state, work);
  int front = kElements;
  while (front > 0 && !(state.velocity.x[size_t(front)] < -0.5 * velocity)) --front;
  EXPECT_LE(test::figure("front of a wave [m]", front * kLength / kElements, kSpeed * state.time), 0.01);
  // Mean over the stretch behind the front, where the grid rings.
  const int behind = kElements / 2;
  const double strain =
      (state.position.x[size_t(behind)] - state.position.x[0]) / (behind * kLength / kElements) - 1;
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
    state.velocity.z[n] = 40 * x * x;
    state.director_rate.x[n] = -80 * x / kLength;
  }
  return state;
}

/// How the strip is played, over the time of kSwingSteps steps of the coarsest run.
struct Swing {
  int parts = 1;           ///< of the coarsest run's step
  bool swelling = false;   ///< the step swells and shrinks smoothly by half of it, ten times in the run
  bool restarted = false;  ///< model, workspace and state are destroyed half-way and built anew from a file

  [[nodiscard]] Model model() const { return swing_model(kSwingSafety / parts); }
  [[nodiscard]] int steps() const { return kSwingSteps * parts; }
  /// Step k of a swelling run, as a share of the mean one: sums to `steps`.
  [[nodiscard]] double size(int k) const {
    constexpr double kSwell = 0.5, kTurns = 10 * 2 * std::numbers::pi;
    const auto time = [&](int at) {
      return at - kSwell * steps() / kTurns * std::sin(kTurns * at / steps());
    };
    return time(k + 1) - time(k);
  }
};

void play(const Swing& swing, const Model& model, State& state, int last) {
  Workspace work(model);
  while (state.step < last) {
    if (swing.swelling) state.dt = model.dt() * swing.size(int(state.step));
    advance(model, state, work);
  }
}

/// The state read back from a file, which is removed.
State through_file(const Swing& swing, const State& state) {
  const auto file =
      std::filesystem::path(testing::TempDir()) / ("drapeplan_swing_" + std::to_string(getpid()) + ".state");
  save_state(file, swing.model(), state);
  const StateReading reading = load_state(file, swing.model());
  std::filesystem::remove(file);
  if (!reading.value) throw std::runtime_error(reading.error);
  return *reading.value;
}

State swung(const Swing& swing) {
  const Model model = swing.model();
  State state = swing_start(model);
  if (swing.swelling) state.dt_before = model.dt() * swing.size(-1);
  if (swing.restarted) {
    play(swing, model, state, swing.steps() / 2 + 3);  // where a swelling step grows
    state = through_file(swing, state);
    const Model anew = swing.model();
    play(swing, anew, state, swing.steps());
  } else {
    play(swing, model, state, swing.steps());
  }
  EXPECT_EQ(state.step, swing.steps());
  EXPECT_LE(std::abs(state.time / (model.dt() * swing.steps()) - 1), 1e-10);
  return state;
}

/// Halves the step twice: the tip's place converges with second order to that of constant, much finer steps.
void expect_second_order_in_time(Swing swing) {
  const Eigen::Vector3d exact = get(swung({.parts = kExact}).position, kSwingElements);
  EXPECT_GT(std::abs(exact.z()), 0.02);
  std::vector<double> error;
  for (const int parts : {1, 2, 4}) {
    swing.parts = parts;
    error.push_back((get(swung(swing).position, kSwingElements) - exact).norm());
  }
  for (size_t k = 1; k < error.size(); ++k) {
    const double slope = std::log2(error[k - 1] / error[k]);
    std::printf("  errors %.3g %.3g m, order in time %.3f\n", error[k - 1], error[k], slope);
    EXPECT_GE(slope, 1.8);
    EXPECT_LE(slope, 2.2);
  }
}

TEST(Motion, IsOfSecondOrderInTime) {
  expect_second_order_in_time({});
}

TEST(Motion, IsOfSecondOrderInTimeWithAStepThatChangesSmoothly) {
  expect_second_order_in_time({.swelling = true});
}

TEST(Motion, HasTheSameBitsAndOrderAcrossARestart) {
  const int nodes = swing_model(1).node_count();
  for (const bool swelling : {false, true}) {
    for (const int parts : {1, 2, 4}) {
      const State through = swung({parts, swelling, false}), restarted = swung({parts, swelling, true});
      EXPECT_EQ(hash_state(through, nodes), hash_state(restarted, nodes)) << parts << " " << swelling;
    }
    expect_second_order_in_time({.swelling = swelling, .restarted = true});
  }
}

// A chain of length 1.2 spans: z = a cosh(x / a) with a = span / (2 q), sinh(q) / q = 1.2, q = 1.0653;
// sag a (cosh q - 1) = 0.2924 spans. One section point has no bending stiffness.
TEST(Chain, HangsInACatenary) {
  constexpr int kElements = 40;
  const double span = 1, length = 1.2;
  Sheet sheet{1e9, 1e-3, 1};
  Scene scene = cantilever(sheet, length, kWidth, kElements);
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
    put(state.position, n,
        {s * std::cos(slope), scene.mesh.rest[n].y(), -std::min(s, length - s) * std::sin(slope)});
    put(state.director, n, {-side * std::sin(slope), 0, std::cos(slope)});
  }
  put(state.director, kElements / 2, {0, 0, 1});
  put(state.director, kElements / 2 + kElements + 1, {0, 0, 1});
  settle(model, state, 1e-5 * span);
  EXPECT_LE(test::figure("catenary, sag / span", -state.position.z[kElements / 2] / span, 0.2924), 0.01);
}

}  // namespace
}  // namespace drapeplan
