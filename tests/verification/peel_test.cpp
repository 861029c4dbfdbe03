// A bonded beam whose clamped end is lifted: it peels as the work of adhesion says.
#include "fem/run/simulate.hpp"
#include "tests/mapping/molds.hpp"
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kLength = 0.24, kWidth = 0.024;  // [m]
constexpr Sheet kBeam{1e9, 3e-3, 3};
constexpr Tack kTack{1.3e3, 5e-5};
constexpr double kLift = 4e-4;  // [m]: so far below the thickness that no tension matters
constexpr double kTime = 0.4;   // of the lift [s]: slow against all bending modes

/// Beam on a rigid bed whose bonds pull with the stress up to their reach. From where it lifts off, without
/// moment, up to the last bond, at x = l: w = c x^3 / 6 - T x^4 / (24 D) and w(l) = reach. From there on it
/// is free, up to the clamp that is lifted: slope 0.
struct Peeled {
  double front = 0, free = 0;  ///< lengths of both parts [m]
  double lift = 0;             ///< of the clamp [m]
  double force = 0;            ///< on it, per width [N/m]
};

Peeled peeled(double front) {
  const double D = kBeam.bending_stiffness(), load = kTack.stress / D, l = front;
  const double c = 6 * (kTack.reach + load * std::pow(l, 4) / 24) / std::pow(l, 3);
  const double slope = c * l * l / 2 - load * std::pow(l, 3) / 6, bend = c * l - load * l * l / 2,
               shear = c - load * l;
  // Slope 0 at the clamp: slope + bend s + shear s^2 / 2 = 0.
  const double s = (-bend - std::sqrt(bend * bend - 2 * shear * slope)) / shear;
  return {l, s, kTack.reach + slope * s + bend * s * s / 2 + shear * std::pow(s, 3) / 6, -D * shear};
}

/// The one whose clamp is lifted that far.
Peeled peeled_by(double lift) {
  double low = std::pow(24 * kTack.reach * kBeam.bending_stiffness() / kTack.stress / 3, 0.25);
  double high = 2 * low;  // a front that is longer bends more: the clamp is nearer
  while (!(peeled(low).lift > lift)) low *= 0.99;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (peeled(middle).lift > lift ? low : high) = middle;
  }
  return peeled(low);
}

/// Force on the clamp, mean over the last tenth of the lift, per width [N/m].
double peel_force(int along) {
  Scene scene;
  scene.mesh = grid_mesh(
      along, 2, [](double u, double v) { return Eigen::Vector2d((u - 0.5) * kLength, (v - 0.5) * kWidth); });
  scene.fabric = kBeam.fabric();
  scene.options.mass_scaling = 1;
  scene.damping = 300;
  scene.start = Start::on_mold;
  scene.mold = inclined_plane(0);
  scene.friction = 0.5;
  scene.tack = kTack;
  Grip grip{"clamp", {}, {0, 0, kLift / kTime}, 0.05};
  for (int j = 0; j < 3; ++j) grip.nodes.push_back(j * (along + 1));
  scene.grips = {grip};
  const Model model(scene);
  State state = model.flat_state(0);
  for (size_t n = 0; n < size_t(model.node_count()); ++n) state.stuck[n] = 1;
  state.anchor = state.position;
  RunRequest request{.duration = kTime + 0.025, .from = &state};  // half the ramp is lost
  request.frames = 101;
  int seen = 0, count = 0;
  double sum = 0;
  request.observe = [&](const Snapshot& frame) {
    if (++seen > 90) sum += frame.grip_force[0].z(), ++count;
  };
  const RunResult run = simulate(model, request);
  EXPECT_EQ(run.summary.status, RunStatus::done) << run.summary.message;
  EXPECT_LE(run.summary.energy.balance_error, 1e-10);
  return sum / count / kWidth;
}

TEST(Peel, OfALiftedBeamConvergesToTheForceThatTheWorkOfAdhesionAsksFor) {
  const Peeled exact = peeled_by(0.95 * kLift);
  const double sharp =
      std::pow(18 * kBeam.bending_stiffness() * std::pow(exact.lift, 2) / (kTack.stress * kTack.reach), 0.25);
  std::printf("  lift %.3f mm: front %.1f mm, free %.1f mm; a sharp front: free %.1f mm\n", 1e3 * exact.lift,
              1e3 * exact.front, 1e3 * exact.free, 1e3 * sharp);
  EXPECT_NEAR(exact.free + exact.front / 2, sharp, 0.1 * sharp);
  // Bonds break node by node: the front runs behind by a share of an element, so the error is of first order.
  const double coarse = peel_force(48), fine = peel_force(96);
  const double at_48 = test::figure("peel, 48 elements, force per width", coarse, exact.force);
  const double at_96 = test::figure("peel, 96 elements, force per width", fine, exact.force);
  EXPECT_LE(at_48, 0.08);
  EXPECT_LE(at_96, 0.65 * at_48);
  EXPECT_LE(test::figure("peel, from both for infinitely many", 2 * fine - coarse, exact.force), 0.015);
}

}  // namespace
}  // namespace drapeplan
