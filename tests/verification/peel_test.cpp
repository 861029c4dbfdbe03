// A strip that is peeled off a plane: in a steady peel the grip's power is the work of separation.
#include "fem/run/simulate.hpp"
#include "tests/mapping/molds.hpp"
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kLength = 0.24, kWidth = 0.012;  // [m]
constexpr test::Sheet kStrip{3.2e9, 3e-4, 0.314};
constexpr double kSpeed = 0.01;   // [m/s]
constexpr double kPeeled = 0.14;  // way of the grip [m]
constexpr Tack kTack{2e3, 2e-3};  // process zone (D reach / stress)^(1/4) = 9 mm: three elements

/// Mean force of the grip along its way over the second half of it, times root two: what the peel of a unit
/// length takes [N].
double peel_force(int along) {
  Scene scene;
  scene.mesh = grid_mesh(
      along, 2, [](double u, double v) { return Eigen::Vector2d((u - 0.5) * kLength, (v - 0.5) * kWidth); });
  scene.fabric = kStrip.fabric();
  scene.options.mass_scaling = 20;
  scene.damping = 20;
  scene.start = Start::on_mold;
  scene.mold = inclined_plane(0);
  scene.friction = 0.5;
  scene.tack = kTack;
  Grip grip{"peel", {}, {kSpeed, 0, kSpeed}, 0.5};
  for (int j = 0; j < 3; ++j) grip.nodes.push_back(j * (along + 1));
  scene.grips = {grip};
  const Model model(scene);
  State state = model.flat_state(0);
  for (size_t n = 0; n < size_t(model.node_count()); ++n) state.stuck[n] = 1;
  state.anchor = state.position;
  constexpr int kFrames = 401;
  int seen = 0, count = 0;
  double sum = 0;
  RunRequest request{.duration = kPeeled / kSpeed, .from = &state};
  request.frames = kFrames;
  request.observe = [&](const Snapshot& frame) {
    if (++seen <= kFrames / 2) return;
    sum += frame.grip_force[0].x() + frame.grip_force[0].z(), ++count;
  };
  const RunResult run = simulate(model, request);
  EXPECT_EQ(run.summary.status, RunStatus::done) << run.summary.message;
  EXPECT_LE(run.summary.energy.balance_error, 1e-10);
  return sum / count;
}

TEST(Peel, TakesTheWorkOfSeparationPerAreaOnAnyFineMesh) {
  const double exact = kTack.stress * kTack.reach * kWidth;  // less the spring's part, 1e-4 of it
  for (const int along : {60, 120}) {
    const double error = test::figure("peel, " + std::to_string(along) + " elements, force along the way",
                                      peel_force(along), exact);
    EXPECT_LE(error, 0.05);
  }
}

}  // namespace
}  // namespace drapeplan
