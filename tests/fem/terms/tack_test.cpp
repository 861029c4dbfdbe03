// Tack where everything is known: the law of one node, ceilings, slopes, what lets go and what stays.
#include <gtest/gtest.h>

#include "fem/run/simulate.hpp"
#include "fem/run/stable_step.hpp"
#include "fem/run/workspace.hpp"
#include "fem/terms/contact.hpp"
#include "mapping/error.hpp"
#include "tests/fem/run/drapes.hpp"
#include "tests/fem/run/scenes.hpp"
#include "tests/mapping/molds.hpp"

namespace drapeplan {
namespace {

constexpr double kGravity = 9.81;
constexpr double kHalf = 1.5e-4;  // half the thickness [m]
constexpr double kDegree = std::numbers::pi / 180;

/// A node on a level mold: spring of 1 N/m, held by 1e-5 N up to 1e-4 m.
struct Node {
  static constexpr double kHold = 1e-5, kReach = 1e-4;
  explicit Node(double friction = 0.5, double hold = kHold)
      : term(make_contact(inclined_plane(0), friction, {{1.0}, {0.0}}, kHalf, 0, {},
                          NodalTack{{hold}, kReach})),
        entries(term->entries()) {
    state.position = state.velocity = state.anchor = VectorField(1);
    state.stuck.assign(padded(1), 0.0);
  }
  /// Force along the normal at a gap, after a shift sideways.
  double at(double gap, double shift = 0) {
    test::put(state.position, 0, {shift, 0, kHalf + gap});
    term->forces(state, entries.data());
    return entries[0].force.z[0];
  }
  std::unique_ptr<Term> term;
  std::vector<Forces> entries;
  State state;
};

TEST(Tack, PullsANodeThatHasTouchedUpToItsLimitAndBreaksBeyondItsReach) {
  Node node;
  EXPECT_EQ(node.at(5e-6), 0);  // has not touched yet
  EXPECT_NEAR(node.at(-2e-6), 2e-6, 1e-18);
  EXPECT_NEAR(node.at(4e-6), -4e-6, 1e-18);
  EXPECT_EQ(node.at(5e-5), -Node::kHold);
  EXPECT_NEAR(node.at(4e-6), -4e-6, 1e-18);  // back the same way
  EXPECT_EQ(node.at(9.9e-5), -Node::kHold);
  EXPECT_EQ(node.at(1.01e-4), 0);
  EXPECT_EQ(node.at(4e-6), 0);  // broken
  EXPECT_NEAR(node.at(-1e-6), 1e-6, 1e-18);
  EXPECT_NEAR(node.at(1e-6), -1e-6, 1e-18);  // and bonded anew
}

TEST(Tack, BreaksAHoldThatItsSpringReachesLateOnlyThere) {
  Node node(0.5, 3e-4);  // the spring has this force at 3e-4 m only
  node.at(-1e-6);
  EXPECT_NEAR(node.at(2.9e-4), -2.9e-4, 1e-16);
  EXPECT_EQ(node.at(3.1e-4), 0);
}

TEST(Tack, TakesTheWorkOfAdhesionOnceAndNothingOnLoops) {
  const auto work = [](const std::vector<double>& gaps) {
    Node node;
    double sum = 0;
    constexpr int kParts = 20000;
    node.at(-1e-7);
    for (size_t k = 1; k < gaps.size(); ++k) {
      const double step = (gaps[k] - gaps[k - 1]) / kParts;
      for (int i = 0; i < kParts; ++i) sum -= node.at(gaps[k - 1] + (i + 0.5) * step) * step;
    }
    return sum;
  };
  const double whole = Node::kHold * (Node::kReach - 0.5 * Node::kHold);
  EXPECT_NEAR(work({0, 2e-4}), whole, 1e-4 * whole);
  EXPECT_NEAR(work({0, 9e-5, 0}), 0, 1e-8 * whole);
}

TEST(Tack, AddsToWhatFrictionHolds) {
  for (const double gap : {-2e-6, 0.5e-6}) {
    for (const double over : {0.99, 1.01}) {
      Node node(0.5);
      node.at(gap < 0 ? gap : -1e-7);
      if (gap > 0) node.at(gap);
      const double limit = 0.5 * std::max(-gap, 0.0) + Node::kHold;
      node.at(gap, over * limit);  // a spring of 1 N/m from the anchor
      const double pull = -node.entries[1].force.x[0];
      EXPECT_NEAR(pull, std::min(over, 1.0) * limit, 1e-9 * limit) << gap;
      EXPECT_NEAR(node.state.anchor.x[0], over > 1 ? (over - 1) * limit : 0, 1e-9 * limit);
    }
  }
}

/// A sheet that lies on a plane, bonded all over.
Scene bonded_sheet(double size, double angle, double stress, double friction) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.06, 0.04, size);
  scene.fabric = test::linear_fabric(1e8, 1e7, 1e6);
  scene.options.mass_scaling = 1;
  scene.gravity = kGravity;
  scene.damping = 50;
  scene.start = Start::on_mold;
  scene.mold = inclined_plane(angle);
  scene.friction = friction;
  scene.tack = Tack{.stress = stress};
  return scene;
}

/// How far the middle of the sheet gets within 0.1 s.
double way_of(const Scene& scene) {
  const Model model(scene);
  State state = model.flat_state(0);
  for (size_t n = 0; n < size_t(model.node_count()); ++n) state.stuck[n] = 1;
  state.anchor = state.position;
  const Eigen::Vector3d start = test::get(state.position, 0);
  const RunResult run = simulate(model, {.duration = 0.1, .from = &state});
  EXPECT_EQ(run.summary.status, RunStatus::done) << run.summary.message;
  EXPECT_LE(run.summary.energy.balance_error, 1e-10);
  EXPECT_GE(run.summary.energy.contact, -1e-12);
  return (run.final.position[0] - start).norm();
}

// Weight per area is 3.08 Pa.
TEST(Tack, HoldsAPlyUnderACeilingThatIsLighterThanIt) {
  for (const double size : {0.02, 0.005}) {
    for (const double share : {1.05, 0.95}) {
      Scene scene = bonded_sheet(size, 0, share * 0.314 * kGravity, 0.5);
      scene.gravity = -kGravity;
      const double way = way_of(scene);
      std::printf("  ceiling, tack %.2f of the weight, cells of %.0f mm: %.3g mm\n", share, 1e3 * size,
                  1e3 * way);
      if (share > 1)
        EXPECT_LE(way, 1e-6);
      else
        EXPECT_GE(way, 0.01);
    }
  }
}

TEST(Tack, HoldsAPlyOnASlopeWithFriction) {
  constexpr double kAngle = 40 * kDegree, kCoefficient = 0.2;
  const double weight = 0.314 * kGravity;
  const double exact = weight * (std::sin(kAngle) - kCoefficient * std::cos(kAngle));
  for (const double size : {0.02, 0.005}) {
    EXPECT_LE(way_of(bonded_sheet(size, kAngle, 1.03 * exact, kCoefficient)), 5e-6);  // what anchors give
    EXPECT_GE(way_of(bonded_sheet(size, kAngle, 0.9 * exact, kCoefficient)), 5e-4);
  }
}

TEST(Tack, NeedsFriction) {
  Scene scene = bonded_sheet(0.02, 0, 1e3, 0.5);
  scene.friction.reset();
  EXPECT_THROW(Model{scene}, WrongInput);
  scene.friction = 0.5;
  for (const double wrong : {-1.0, std::nan(""), HUGE_VAL}) {
    scene.tack = Tack{.stress = wrong};
    EXPECT_THROW(Model{scene}, WrongInput) << wrong;
  }
}

// Springs of lifted nodes that still hold are as stiff as those of nodes that are pressed.
TEST(Tack, CountsLiftedNodesInTheStableStep) {
  Scene scene = bonded_sheet(0.01, 0, 1e9, 0.5);
  scene.options.contact_stiffness = 2;
  scene.options.bulk_viscosity = 0;
  const Model model(scene);
  State state = model.flat_state(0);
  state.dt = model.dt();
  StepScratch scratch(model);
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    state.stuck[n] = 1;
    state.position.z[n] += 5e-5;
  }
  state.anchor = state.position;
  State copy = state;
  const double estimate = stable_step(model, copy, scratch), truth = true_stable_step(model, state);
  EXPECT_LE(estimate, 1.001 * truth);
  std::fill(state.stuck.begin(), state.stuck.end(), 0.0);
  EXPECT_GT(true_stable_step(model, state), 1.2 * truth);  // the springs do count
}

/// R.m.s. way of the nodes of a drape between letting go of it and its end.
double springback(std::optional<double> stress) {
  Scene scene = test::corner_drape(0.02);
  scene.press = Press{.pressure = 3e4, .delay = 1, .duration = 1, .ramp = 0.5};
  if (stress) scene.tack = Tack{.stress = *stress};
  Schedule schedule = test::drop(scene);
  const Model held(scene);
  const RunResult before = simulate(held, {.schedule = &schedule});
  scene.press->pressure = 0;  // and without the press, which would hold it
  scene.press->duration = 4;
  const Model model(scene);
  schedule.release.assign(schedule.paths.size(), before.final.time);
  const State from = [&] {
    State state = before.state;
    state.pressure = 0;
    return state;
  }();
  const RunResult after = simulate(model, {.schedule = &schedule, .from = &from});
  EXPECT_EQ(after.summary.status, RunStatus::done) << after.summary.message;
  double sum = 0;
  for (size_t n = 0; n < after.final.position.size(); ++n)
    sum += (after.final.position[n] - before.final.position[n]).squaredNorm();
  return std::sqrt(sum / double(after.final.position.size()));
}

TEST(Tack, KeepsADrapeThatIsLetGo) {
  const double without = springback(std::nullopt), with = springback(3e4);
  std::printf("  let go: r.m.s. way %.3f mm without tack, %.3f mm with 30 kPa\n", 1e3 * without, 1e3 * with);
  EXPECT_LE(with, 0.1 * without);
}

}  // namespace
}  // namespace drapeplan
