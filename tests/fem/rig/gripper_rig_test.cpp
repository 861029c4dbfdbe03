// The rig by itself: limits, actuators, interlinks, release.
#include "fem/rig/gripper_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fem/mesh/mesh.hpp"
#include "fem/run/simulate.hpp"
#include "fem/run/workspace.hpp"
#include "mapping/polygon.hpp"
#include "tests/fem/rig/bench.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;
using test::RigBench;

constexpr double kDegree = std::numbers::pi / 180;

/// One gripper, its actuator without stiffness unless it is set.
RigBench one_gripper() {
  RigBench bench;
  bench.options.columns = bench.options.rows = 1;
  bench.options.spacing = 0.1;
  bench.options.actuator_stiffness = 0;
  return bench;
}

double tilt(const PadState& pad) {
  return std::acos(std::min(1.0, (pad.rotation * Vector3d::UnitZ()).z()));
}

/// Angles about warp and weft by their definition, in the x-y frame.
Eigen::Vector2d rotations(const PadState& pad) {
  const Vector3d n = pad.rotation * Vector3d::UnitZ();
  return {std::atan2(-n.y(), n.z()), std::atan2(n.x(), n.z())};
}

// The article's Figure 7: connectors with a least and a largest rotation. Full actuator force at the pad's
// rim.
TEST(GripperRig, HoldsItsTiltLimitAgainstTheFullForceAtTheRimWithinATenthOfADegree) {
  for (const double azimuth : {0.0, 2.0, -1.0}) {
    RigBench bench = one_gripper();
    bench.options.tilt_limit = 30 * kDegree;
    bench.build();
    const double moment = bench.options.actuator_force_limit * bench.options.pad_radius;
    double largest = 0;
    for (int k = 0; k < 20000; ++k) {
      const Vector3d n = bench.state.pads[0].rotation * Vector3d::UnitZ();
      test::put(bench.moment, 0,
                moment * Vector3d(std::cos(azimuth), std::sin(azimuth), 0).cross(Vector3d(0, 0, 1)).cross(n));
      bench.step();
      if (k > 10000) largest = std::max(largest, tilt(bench.state.pads[0]));
    }
    EXPECT_GE(largest, 29.9 * kDegree);
    EXPECT_LE(largest, 30.1 * kDegree);
  }
}

TEST(GripperRig, HoldsAllFourRotationLimitsWithTheStatedSigns) {
  struct Side {
    Vector3d turn;  // axis of the moment
    int axis;
    double limit;
  };
  for (const Side& side :
       {Side{{1, 0, 0}, 0, 20}, Side{{-1, 0, 0}, 0, -10}, Side{{0, 1, 0}, 1, 15}, Side{{0, -1, 0}, 1, -5}}) {
    RigBench bench = one_gripper();
    bench.options.rotation_limits =
        RotationLimits{{-10 * kDegree, 20 * kDegree}, {-5 * kDegree, 15 * kDegree}};
    bench.build();
    const double moment = bench.options.actuator_force_limit * bench.options.pad_radius;
    for (int k = 0; k < 20000; ++k) {
      const Vector3d n = bench.state.pads[0].rotation * Vector3d::UnitZ();
      // normal x this = the moment normal to n
      test::put(bench.moment, 0, moment * side.turn.cross(n));
      bench.step();
    }
    const Eigen::Vector2d angles = rotations(bench.state.pads[0]);
    EXPECT_LE(std::abs(angles[side.axis] - side.limit * kDegree), 0.1 * kDegree) << side.limit;
    EXPECT_LE(std::abs(angles[1 - side.axis]), 0.1 * kDegree);
  }
}

// A stop that never pulls back takes all of a hit, and gives none back.
TEST(GripperRig, StopsAHitWithoutReboundAndBooksWhatItTook) {
  RigBench bench = one_gripper();
  bench.options.tilt_limit = 20 * kDegree;
  bench.build();
  bench.state.pads[0].angular_velocity = {5, 0, 0};
  const double before = bench.rig->kinetic_energy(bench.state);
  double largest = 0;
  for (int k = 0; k < 20000; ++k) {
    bench.step();
    largest = std::max(largest, tilt(bench.state.pads[0]));
    EXPECT_GE(bench.scratch.stop[0].dot(-Vector3d::UnitX()), -1e-12);
  }
  EXPECT_LE(largest, 20.1 * kDegree);
  EXPECT_LE(std::abs(bench.state.pads[0].angular_velocity.x()), 0.2 * 5);
  const double taken = -bench.state.work[size_t(Book::stop)];
  EXPECT_LE(std::abs(before - taken - bench.rig->kinetic_energy(bench.state)), 1e-12 * before);
}

// Critically damped: x = 1 - (1 + w t) exp(-w t) for a step of 1.
TEST(GripperRig, FollowsAStepOfItsCommandInEachDrivenDirectionAsTheClosedFormSays) {
  RigBench bench = one_gripper();
  bench.options.driven = Driven::xyz;
  bench.options.interlinks.reset();
  bench.options.actuator_stiffness = 1000;
  bench.options.joint_offset = 0;
  const double frequency = std::sqrt(bench.options.actuator_stiffness / bench.options.pad_mass);
  const Vector3d step(0.001, -0.002, 0.003);
  std::vector<double> error;
  for (const double dt : {4e-5, 2e-5}) {
    bench.dt = dt;
    bench.schedule = {.paths = {{{0, step.z()}}}, .blend_time = 0, .plane_paths = {{{0, step.head<2>()}}}};
    bench.build();
    double largest = 0;
    while (bench.state.time < 0.1) {
      bench.step();
      const double a = frequency * bench.state.time;
      const Vector3d exact = (1 - (1 + a) * std::exp(-a)) * step;
      largest = std::max(largest, (bench.state.pads[0].centre - exact).norm() / step.norm());
    }
    error.push_back(largest);
  }
  EXPECT_LE(error[0], 4e-3);
  const double slope = std::log2(error[0] / error[1]);  // damping with the velocity of t - dt/2: first order
  EXPECT_GE(slope, 0.9);
  EXPECT_LE(slope, 1.1);
}

TEST(GripperRig, LimitsTheForceOfEachDirection) {
  RigBench bench = one_gripper();
  bench.options.driven = Driven::xyz;
  bench.options.interlinks.reset();
  bench.options.actuator_stiffness = 1e4;
  bench.schedule = {.paths = {{{0, 1.0}}}, .blend_time = 0, .plane_paths = {{{0, {-1, 1e-3}}}}};
  bench.build();
  const Vector3d force = bench.rig->actuator_force(bench.state, {&bench.schedule, 1}, 0);
  EXPECT_EQ(force, Vector3d(-50, 10, 50));
}

/// Two grippers at one height, the first one fixed; the second swings on its interlink under a field along x.
struct Pendulum : RigBench {
  static constexpr double kField = 9.81;  // [m/s^2]
  explicit Pendulum(double angle) {
    options.columns = 2;
    options.rows = 1;
    options.spacing = 0.1;
    options.joint_offset = 0;
    options.actuator_stiffness = 0;
    options.fixed = {1, 1};
    build();
    state.pads[1].centre =
        state.pads[0].centre + options.spacing * Vector3d(std::cos(angle), std::sin(angle), 0);
    state.dt = 0;
    rig->drift(state);
  }
  void swing() {
    test::put(force, 1, {options.pad_mass * kField, 0, 0});
    step();
  }
};

TEST(GripperRig, SwingsAPadOnItsInterlinkWithThePeriodOfAPendulum) {
  const double angle = 0.3, length = 0.1;
  Pendulum pendulum(angle);
  pendulum.dt = 2e-5;
  std::vector<double> crossings;
  double before = angle * length;
  while (crossings.size() < 5) {
    pendulum.swing();
    const double y = pendulum.state.pads[1].centre.y();
    if (before * y < 0) crossings.push_back(pendulum.state.time - pendulum.dt * y / (y - before));
    before = y;
    ASSERT_LE(pendulum.state.time, 3.0);
  }
  const double period = (crossings[4] - crossings[0]) / 2;
  const double exact = 2 * std::numbers::pi * std::sqrt(length / Pendulum::kField) * (1 + angle * angle / 16);
  EXPECT_LE(std::abs(period - exact), 1e-3 * exact);
  EXPECT_TRUE(pendulum.scratch.converged);
  EXPECT_LE(pendulum.state.record.link_error, 1e-12 * length);
}

// Why interlinks are constraints. As springs that give way by 1e-6 of their length at 50 N they would need
// steps of 2 / sqrt(4 k / m) in a long row of pads, whatever the ply; the constraint takes any step, and is
// closer by six orders.
TEST(GripperRig, KeepsLengthsAtAStepAtWhichASpringOfTheNeededStiffnessIsLongUnstable) {
  const double length = 0.1, force = 50, mass = 0.1;
  const double stiffness = force / (1e-6 * length);
  const double limit = 2 / std::sqrt(stiffness / mass);  // of one pad on a fixed one
  EXPECT_LE(limit, 3e-5);
  const auto spring_error = [&](double dt) {  // pulled by the force along the spring
    double stretch = 0, v = 0, largest = 0;
    for (int k = 0; k < 2000; ++k) {
      v += dt / mass * (force - stiffness * stretch);
      stretch += dt * v;
      largest = std::max(largest, std::abs(stretch));
    }
    return largest / length;
  };
  EXPECT_LE(spring_error(0.9 * limit), 5e-6);  // twice the static stretch, and the step's error
  EXPECT_GE(spring_error(1.02 * limit), 1);
  Pendulum pendulum(0.3);
  pendulum.dt = 10 * limit;
  for (int k = 0; k < 2000; ++k) {
    test::put(pendulum.force, 1, {force, 0, 0});
    pendulum.step();
  }
  EXPECT_TRUE(pendulum.scratch.converged);
  EXPECT_LE(pendulum.state.record.link_error, 1e-12 * length);
}

/// Area that the nodes of the middle pad span, over its disc's.
double share_of_disc(const RigOptions& rig, const Mesh& mesh) {
  const auto nodes = size_t(mesh.node_count());
  const GripperRig built(rig, mesh.rest, std::vector<double>(nodes, 1.0), std::vector<double>(nodes, 0.0),
                         {{0, 0}}, 0);
  Polygon held;
  const std::vector<std::vector<int>> nodes_of = built.tied_by_pad();
  for (const int node : nodes_of.front()) held.push_back(mesh.rest[size_t(node)]);
  return signed_area(convex_hull(held)) / (std::numbers::pi * rig.pad_radius * rig.pad_radius);
}

TEST(GripperRig, APadHoldsTheAreaOfItsDiscWhateverTheMesh) {
  RigOptions rig = one_gripper().options;
  for (const double mesh_size : {0.003, 0.004, 0.005, 0.007, 0.01, 0.015, 0.02, 0.03}) {
    const Mesh mesh =
        rectangle_mesh(0.2, 0.2, mesh_size, column_places(rig, mesh_size), row_places(rig, mesh_size));
    EXPECT_NEAR(share_of_disc(rig, mesh), 1, 1e-9) << mesh_size;
  }
  for (const double mesh_size : {0.004, 0.007, 0.01}) {  // meshes that know nothing of the pad
    EXPECT_NEAR(share_of_disc(rig, rectangle_mesh(0.2, 0.2, mesh_size)), 1, 0.3) << mesh_size;
  }
}

TEST(GripperRig, PadsThatAllButTouchMakeNoSliver) {
  RigOptions rig = one_gripper().options;
  rig.columns = 3;
  rig.pad_radius = 0.05;
  for (const double spacing : {0.1, 0.1001, 0.103, 0.11}) {
    rig.spacing = spacing;
    const std::vector<double> lines = column_places(rig, 0.007);
    double narrowest = 1;
    for (size_t k = 1; k < lines.size(); ++k) narrowest = std::min(narrowest, lines[k] - lines[k - 1]);
    EXPECT_GE(narrowest, 0.002) << spacing;
  }
}

TEST(GripperRig, PadsThatTouchShareNoNode) {
  RigOptions rig = one_gripper().options;
  rig.columns = 2;
  rig.spacing = 2 * rig.pad_radius;
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.02, column_places(rig, 0.02), row_places(rig, 0.02));
  const auto nodes = size_t(mesh.node_count());
  const GripperRig built(rig, mesh.rest, std::vector<double>(nodes, 1.0), std::vector<double>(nodes, 0.0),
                         {{-0.02, 0}, {0.02, 0}}, 0);
  const auto held = built.tied_by_pad();
  // The line between them is common to both, and the first one's.
  EXPECT_GE(held[1].size(), 6U);
  EXPECT_LE(held[1].size(), held[0].size());
  for (const int node : held[0]) EXPECT_EQ(std::count(held[1].begin(), held[1].end(), node), 0);
}

}  // namespace
}  // namespace drapeplan
