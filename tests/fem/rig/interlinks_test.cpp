// Interlinks that close, have play or give way, against closed forms: two pads and what joins them.
#include "fem/rig/interlinks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mapping/error.hpp"
#include "tests/fem/rig/bench.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;
using test::RigBench;

constexpr double kMass = 0.1, kSpacing = 0.1;  // [kg], [m]
constexpr double kKept = 1e-12 * kSpacing;     // lengths are kept so closely [m]
constexpr double kStopped = kKept / 1e-5;      // and joints left with so little speed, in a step [m/s]

/// Two free pads side by side along x, joints in their middles: nothing turns.
RigBench two_pads(const InterlinkOptions& interlinks) {
  RigBench bench;
  bench.options.columns = 2;
  bench.options.rows = 1;
  bench.options.spacing = kSpacing;
  bench.options.pad_mass = kMass;
  bench.options.joint_offset = 0;
  bench.options.actuator_stiffness = 0;
  bench.options.interlinks = interlinks;
  bench.build();
  return bench;
}

double length_of(const RigBench& bench) {
  return (bench.rig->joint(bench.state.pads[1]) - bench.rig->joint(bench.state.pads[0])).norm();
}

double speed_apart(const RigBench& bench) {
  return bench.state.pads[1].velocity.x() - bench.state.pads[0].velocity.x();
}

void fly_apart(RigBench& bench, double speed) {
  bench.state.pads[0].velocity.x() = -0.5 * speed;
  bench.state.pads[1].velocity.x() = 0.5 * speed;
}

void pull_apart(RigBench& bench, double force) {
  test::put(bench.force, 0, Vector3d(-force, 0, 0));
  test::put(bench.force, 1, Vector3d(force, 0, 0));
}

void run(RigBench& bench, double seconds) {
  for (int k = 0, steps = int(std::lround(seconds / bench.dt)); k < steps; ++k) {
    bench.step();
    ASSERT_TRUE(bench.scratch.converged);
  }
}

/// What interlinks did is what the pads have.
void expect_books_closed(const RigBench& bench, double start, double loads = 0) {
  const double kinetic = bench.rig->kinetic_energy(bench.state);
  const double work = bench.state.work[size_t(Book::interlink)];
  EXPECT_NEAR(kinetic, start + loads + work, 1e-12 * (std::abs(start) + std::abs(work) + kinetic));
}

InterlinkOptions closing_to(double length) {
  InterlinkOptions interlinks;
  interlinks.lengths = {length};
  interlinks.closing = {0.05, 0.25};
  return interlinks;
}

TEST(Interlinks, CloseSmoothlyToTheirLengthAndBookTheWork) {
  RigBench bench = two_pads(closing_to(0.097));
  run(bench, 0.05);
  EXPECT_NEAR(length_of(bench), kSpacing, 1e-13);
  run(bench, 0.1);
  EXPECT_NEAR(length_of(bench), 0.0985, 1e-13) << "half way at half time";
  EXPECT_NEAR(speed_apart(bench), -0.003 / 0.2 * 1.875, 1e-6) << "the steepest slope of the quintic";
  expect_books_closed(bench, 0);
  EXPECT_NEAR(bench.state.work[size_t(Book::interlink)], 0.25 * kMass * std::pow(speed_apart(bench), 2),
              1e-15);
  run(bench, 0.15);
  EXPECT_NEAR(length_of(bench), 0.097, 1e-13);
  EXPECT_NEAR(speed_apart(bench), 0, kStopped);
  EXPECT_NEAR(bench.state.pads[0].centre.x() + bench.state.pads[1].centre.x(), 0, 1e-15);
}

TEST(Interlinks, RunFreelyBetweenStopsThatTakeTheHitAndOnlyPush) {
  for (const double way : {1.0, -1.0}) {
    InterlinkOptions interlinks;
    interlinks.play = {0.002, 0.003};
    RigBench bench = two_pads(interlinks);
    fly_apart(bench, way * 0.5);
    const double stop = way > 0 ? 0.003 : -0.002, start = bench.rig->kinetic_energy(bench.state);
    run(bench, 0.002);
    EXPECT_NEAR(length_of(bench), kSpacing + way * 0.001, 1e-12) << "not yet there";
    EXPECT_EQ(bench.state.work[size_t(Book::interlink)], 0);
    run(bench, 0.01);
    EXPECT_NEAR(length_of(bench), kSpacing + stop, 0.01 * kStopped);
    EXPECT_NEAR(speed_apart(bench), 0, kStopped);
    EXPECT_NEAR(bench.state.work[size_t(Book::interlink)], -start, 1e-12 * start)
        << "half a reduced mass v^2";
    fly_apart(bench, -way * 0.1);
    run(bench, 0.01);
    EXPECT_NEAR(length_of(bench), kSpacing + stop - way * 0.001, 0.02 * kStopped) << "a stop does not hold back";
    expect_books_closed(bench, 0, start + 0.25 * kMass * 0.01);
  }
}

TEST(Interlinks, HoldALoadAtTheStopAndAreFreeWithoutIt) {
  InterlinkOptions interlinks;
  interlinks.play = {0.001, 0.001};
  RigBench bench = two_pads(interlinks);
  pull_apart(bench, 20);
  run(bench, 0.05);
  EXPECT_NEAR(length_of(bench), kSpacing + 0.001, 1e-13);
  EXPECT_NEAR(bench.scratch.links.impulse[0] / bench.dt, bench.scratch.links.direction[0].x() * 20, 1e-6);
}

InterlinkOptions spring_of(double stiffness, double ratio = 1) {
  InterlinkOptions interlinks;
  interlinks.stiffness = stiffness;
  interlinks.damping_ratio = ratio;
  return interlinks;
}

TEST(Interlinks, SwingOnASpringWithItsFrequencyAndItsDamping) {
  const double stiffness = 2000, ratio = 0.1;
  const double omega = std::sqrt(stiffness / (0.5 * kMass));
  RigBench bench = two_pads(spring_of(stiffness, ratio));
  bench.dt = 1e-6;
  fly_apart(bench, 0.1);
  const double damped = omega * std::sqrt(1 - ratio * ratio), quarter = 0.5 * std::numbers::pi / damped;
  run(bench, quarter);
  EXPECT_NEAR(length_of(bench) - kSpacing, 0.1 / damped * std::exp(-ratio * omega * quarter), 2e-7);
  run(bench, quarter);
  EXPECT_NEAR(length_of(bench) - kSpacing, 0, 2e-7) << "half a period";
  EXPECT_NEAR(speed_apart(bench), -0.1 * std::exp(-2 * ratio * omega * quarter), 1e-4);
  expect_books_closed(bench, 0.25 * kMass * 0.01);
}

TEST(Interlinks, StretchUnderALoadByForceOverStiffnessWhateverTheStep) {
  for (const double stiffness : {1e3, 1e5, 1e8, 1e14}) {
    for (const double longer : {0.0, 0.002}) {
      InterlinkOptions interlinks = spring_of(stiffness);
      if (longer > 0) interlinks.play = {longer, longer};
      RigBench bench = two_pads(interlinks);
      bench.dt = 1e-4;  // at 1e8 N/m five times the limit of an explicit spring
      pull_apart(bench, 20);
      run(bench, 1);
      EXPECT_NEAR(length_of(bench), kSpacing + longer + 20 / stiffness, 1e-9 + 1e-6 * 20 / stiffness)
          << stiffness;
      EXPECT_NEAR(speed_apart(bench), 0, 1e-6);
    }
  }
}

TEST(Interlinks, OfNoStiffnessAreNone) {
  RigBench bench = two_pads(spring_of(0));
  fly_apart(bench, 0.1);
  run(bench, 0.1);
  EXPECT_NEAR(length_of(bench), kSpacing + 0.01, 1e-12);
}

TEST(Interlinks, RefuseLengthsThatDoNotFit) {
  InterlinkOptions interlinks = closing_to(0.097);
  interlinks.closing = {0.1, 0.1};
  EXPECT_THROW(two_pads(interlinks), WrongInput);
  interlinks = closing_to(0.097);
  interlinks.lengths.push_back(0.1);
  EXPECT_THROW(two_pads(interlinks), WrongInput);
}

// A 3 x 3 grid thrown about: stops are hit and let go many at a time.
TEST(Interlinks, OfAGridWithPlayKeepAllStopsAndTheBooks) {
  RigBench bench;
  bench.options.columns = bench.options.rows = 3;
  bench.options.spacing = kSpacing;
  bench.options.actuator_stiffness = 0;
  bench.options.interlinks->play = {0.001, 0.002};
  bench.build();
  for (size_t g = 0; g < 9; ++g)
    bench.state.pads[g].velocity =
        0.3 * Vector3d(std::sin(7.0 * double(g)), std::cos(3.0 * double(g * g)), 0);
  const double start = bench.rig->kinetic_energy(bench.state);
  for (int k = 0; k < 5000; ++k) {
    bench.step();
    ASSERT_TRUE(bench.scratch.converged) << k;
    for (const auto& [i, j] : interlinks(bench.options)) {
      const double length =
          (bench.rig->joint(bench.state.pads[size_t(i)]) - bench.rig->joint(bench.state.pads[size_t(j)]))
              .norm();
      ASSERT_LE(length, kSpacing + 0.002 + 1e-12) << k;
      ASSERT_GE(length, kSpacing - 0.001 - 1e-12) << k;
    }
  }
  EXPECT_LT(bench.state.work[size_t(Book::interlink)], 0) << "hits take energy";
  expect_books_closed(bench, start);
}

}  // namespace
}  // namespace drapeplan
