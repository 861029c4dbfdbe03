// Rigs with a ply under them: rotation limits under contact, joints driven in x, y and z, release.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/run/simulate.hpp"
#include "fem/run/workspace.hpp"
#include "tests/fem/run/drapes.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;
using test::get;

constexpr double kDegree = std::numbers::pi / 180;

Scene corner_drape() {
  return test::corner_drape(0.0125);
}

Vector3d normal_of(const Snapshot& frame, size_t pad, const RigOptions& rig) {
  return (frame.joint[pad] - frame.pad[pad]) / rig.joint_offset;
}

TEST(RigDrape, KeepsPadsWithinTheirTiltLimitWhereActuatorsPressThemOntoAMoldSteeperThanIt) {
  Scene scene = corner_drape();
  scene.rig->interlinks.reset();
  scene.rig->tilt_limit = 12 * kDegree;
  const Schedule schedule = test::drop(scene, {.depth = 0.02});  // 20 mm into the mold: full force
  double largest = 0;
  const RunResult result = simulate(
      Model(scene), {.schedule = &schedule, .duration = 0, .frames = 400, .observe = [&](const auto& f) {
                       for (size_t g = 0; g < 4; ++g)
                         largest = std::max(largest, std::acos(normal_of(f, g, *scene.rig).z()));
                     }});
  EXPECT_EQ(result.summary.status, RunStatus::done) << result.summary.message;
  EXPECT_GE(largest, 12 * kDegree);
  EXPECT_LE(largest, 12.1 * kDegree);
  EXPECT_DOUBLE_EQ(result.state.record.actuator_force, 50);
  EXPECT_LE(result.summary.energy.balance_error, 1e-9);
  EXPECT_GE(result.summary.energy.constraint, -1e-12);
}

/// In the air a joint hangs below its command by the weight that it carries over its actuator's stiffness. On
/// the mold it stops short of a command that aims below: that is no lag, but the actuator may give all it
/// has.
TEST(RigDrape, TellsHowFarJointsAreBehindTheirCommandsUntilTheirPadsTouch) {
  Scene scene = corner_drape();
  scene.rig->actuator_stiffness = 100;
  Schedule still = test::drop(scene);
  for (auto& path : still.paths) path = {{0, path[0].z + 0.1}, {3, path[0].z + 0.1}};
  const RunResult hanging = simulate(Model(scene), {.schedule = &still});
  ASSERT_EQ(hanging.summary.status, RunStatus::done) << hanging.summary.message;
  const double weight = 9.81 * scene.fabric.areal_density * 0.16 * 0.16;
  const double lag = weight / 4 / scene.rig->actuator_stiffness;
  EXPECT_GE(hanging.state.record.lag, 0.99 * lag);
  EXPECT_LE(hanging.state.record.lag, 1.1 * lag);
  EXPECT_EQ(hanging.state.record.saturated, 0);

  scene.rig->actuator_stiffness = 1e4;
  scene.rig->actuator_force_limit = 15;
  const Schedule pressing = test::drop(scene, {.depth = 0.002});  // 20 N, if there were as much
  const RunResult pressed = simulate(Model(scene), {.schedule = &pressing});
  ASSERT_EQ(pressed.summary.status, RunStatus::done) << pressed.summary.message;
  EXPECT_LE(pressed.state.record.lag, 0.001);
  EXPECT_GE(pressed.state.record.saturated * scene.options.time_scaling, 1);
  EXPECT_LE(pressed.state.record.saturated * scene.options.time_scaling, 2.5);
}

/// Interlinks that close, have play and give way, all at once.
TEST(RigDrape, WithInterlinksOfEveryKindClosesItsBooksAndGoesOnWithTheSameBits) {
  Scene scene = test::middle_drape(0.24, 0.02);
  InterlinkOptions& links = *scene.rig->interlinks;
  for (size_t k = 0; k < interlinks(*scene.rig).size(); ++k)
    links.lengths.push_back(0.098 + 0.0002 * double(k));
  links.closing = {0.2, 1.8};
  links.play = {0.0005, 0.0002};
  for (const std::optional<double> stiffness : {std::optional<double>(), std::optional(1e5)}) {
    links.stiffness = stiffness;
    const Model model(scene);
    const Schedule schedule = test::drop(scene);
    const RunResult whole = simulate(model, {.schedule = &schedule});
    ASSERT_EQ(whole.summary.status, RunStatus::done) << whole.summary.message;
    EXPECT_LE(whole.summary.energy.balance_error, 1e-9);
    EXPECT_LE(whole.summary.largest_link_error, 1e-12);
    double over = -1;
    const auto pairs = interlinks(*scene.rig);
    for (size_t k = 0; k < pairs.size(); ++k) {
      const auto& joints = whole.final.joint;
      const double length =
          (joints[size_t(pairs[k][0])] - joints[size_t(pairs[k][1])]).norm() - links.lengths[k];
      over = std::max({over, length - links.play[1], -length - links.play[0]});
    }
    const double give = stiffness ? 50.0 / *stiffness : 0;  // of one actuator
    EXPECT_LE(over, 1e-12 + give);
    EXPECT_GE(over, -1e-12) << "some stop acts";
    for (const double pause : {1.0, 5.5}) {  // while it closes, and on the mold
      const State state = simulate(model, {.schedule = &schedule, .pause = pause}).state;
      const RunResult rest = simulate(model, {.schedule = &schedule, .from = &state});
      EXPECT_EQ(rest.summary.state_hash, whole.summary.state_hash) << pause;
    }
  }
}

TEST(RigDrape, KeepsRotationLimitsAgainstInterlinks) {
  Scene scene = corner_drape();
  scene.rig->rotation_limits = RotationLimits{{-6 * kDegree, 4 * kDegree}, {-5 * kDegree, 3 * kDegree}};
  const Schedule schedule = test::drop(scene);
  double excess = -1;
  const RunResult result = simulate(
      Model(scene), {.schedule = &schedule, .duration = 0, .frames = 400, .observe = [&](const auto& f) {
                       for (size_t g = 0; g < 4; ++g) {
                         const Vector3d n = normal_of(f, g, *scene.rig);
                         const double warp = std::atan2(-n.y(), n.z()) / kDegree;
                         const double weft = std::atan2(n.x(), n.z()) / kDegree;
                         excess = std::max({excess, warp - 4, -6 - warp, weft - 3, -5 - weft});
                       }
                     }});
  EXPECT_EQ(result.summary.status, RunStatus::done) << result.summary.message;
  EXPECT_GE(excess, 0);
  EXPECT_LE(excess, 0.1);
  EXPECT_LE(result.summary.energy.balance_error, 1e-9);
}

TEST(RigDrape, MovesJointsInPlaneWhereTheScheduleSaysSo) {
  Scene scene = corner_drape();
  scene.mold.reset();
  scene.friction.reset();
  scene.rig->interlinks.reset();
  scene.rig->driven = Driven::xyz;
  Schedule schedule;
  schedule.blend_time = 0.1;
  for (int g = 0; g < 4; ++g) {
    const Eigen::Vector2d from = scene.position + scene.rig->place(g);
    schedule.paths.push_back({{0, 0.1}});
    schedule.plane_paths.push_back({{0, from},
                                    {4, from + Eigen::Vector2d(g == 3 ? -0.01 : 0, -0.004)},
                                    {6, from + Eigen::Vector2d(g == 3 ? -0.01 : 0, -0.004)}});
  }
  const RunResult result = simulate(Model(scene), {.schedule = &schedule});
  EXPECT_EQ(result.summary.status, RunStatus::done) << result.summary.message;
  EXPECT_LE(result.summary.energy.balance_error, 1e-9);
  for (int g = 0; g < 4; ++g) {
    const Eigen::Vector2d to = schedule.plane_paths[size_t(g)].back().xy;
    EXPECT_LE((result.final.joint[size_t(g)].head<2>() - to).norm(), 5e-4)
        << g;  // springs give way to the ply
  }
  Schedule flat = schedule;
  flat.plane_paths.clear();
  EXPECT_THROW(simulate(Model(scene), {.schedule = &flat}), std::invalid_argument);
  schedule.plane_paths[2].front().xy.x() += 1e-4;
  EXPECT_THROW(simulate(Model(scene), {.schedule = &schedule}), std::invalid_argument);
  scene.rig->driven = Driven::z;
  EXPECT_THROW(simulate(Model(scene), {.schedule = &schedule}), std::invalid_argument);
}

// The ply falls from moving grippers: two of them let go, the others follow later or never.
TEST(RigDrape, ClosesItsBooksThroughReleasesInMotion) {
  Scene scene = corner_drape();
  Schedule schedule = test::drop(scene);
  schedule.release = {1.0, std::nullopt, 1.5, 5.5};
  const Model model(scene);
  const RunResult result = simulate(model, {.schedule = &schedule});
  EXPECT_EQ(result.summary.status, RunStatus::done) << result.summary.message;
  EXPECT_LE(result.summary.energy.balance_error, 1e-9);
  EXPECT_LE(result.state.record.link_error, 1e-7);
  schedule.release.clear();
  EXPECT_NE(result.summary.state_hash, simulate(model, {.schedule = &schedule}).summary.state_hash);
}

TEST(RigDrape, ReleasesNodesWithTheVelocitiesThatTheyHadAndLetsThemFall) {
  Scene scene = corner_drape();
  scene.mold.reset();
  scene.friction.reset();
  scene.damping.reset();
  scene.options.mass_scaling = scene.options.time_scaling = 1;
  const Model model(scene);
  Schedule schedule;
  for (int g = 0; g < 4; ++g) schedule.paths.push_back({{0, 0.105}, {1, 0.155}});
  const double at = 0.02;
  schedule.release.assign(4, at);
  const RigDrive drive{&schedule, 1};
  State state = model.flat_state(0.1);
  Workspace work(model);
  const auto& tied = model.rig()->tied();
  std::vector<Vector3d> before;
  double mean = 0;
  while (state.time < at + 0.02) {
    const bool released = state.pads[0].released;
    before.clear();
    for (const int n : tied) before.push_back(get(state.velocity, size_t(n)));
    state.dt = state.dt_before = model.dt();
    model.rig()->let_go(state, drive);
    compute_forces(model, state, work);
    kick_nodes(model, state, work);
    kick_pads(model, state, drive, work);
    book_work(model, state, work);
    drift_nodes(model, state);
    model.rig()->drift(state);
    advance_clock(state);
    if (released || !state.pads[0].released) continue;
    for (size_t k = 0; k < tied.size(); ++k)
      EXPECT_LE((get(state.velocity, size_t(tied[k])) - before[k]).norm(), 0.02);  // one step's forces
    mean = before[0].z();
  }
  EXPECT_TRUE(state.pads[0].released);
  // The pads go on as commanded; the ply as a whole falls: its centre of mass from `mean` at 9.81 m/s^2.
  double lift = 0, mass = 0;
  const std::vector<double> area = nodal_areas(scene.mesh);
  for (size_t n = 0; n < area.size(); ++n) {
    lift += area[n] * state.velocity.z[n];
    mass += area[n];
  }
  EXPECT_LE(lift / mass, mean - 0.1);
  EXPECT_GE(state.pads[0].velocity.z(), 0.04);
}

// A spinning pad: what its isotropic inertia and that of its nodes differ by is booked, to round-off.
TEST(RigDrape, BooksTheKineticEnergyThatARigidPadAndItsNodesDifferBy) {
  Scene scene = corner_drape();
  scene.mold.reset();
  scene.friction.reset();
  const Model model(scene);
  Schedule schedule;
  for (int g = 0; g < 4; ++g) schedule.paths.push_back({{0, 0.105}});
  schedule.release.assign(4, 0.0);
  State state = model.flat_state(0.1);
  for (PadState& pad : state.pads) pad.angular_velocity = {1, 2, 3};
  model.rig()->drift(state);  // with a step of 0, nodes take over the pads' velocities
  const double before = kinetic_energy(model, state);
  Workspace work(model);
  state.dt = state.dt_before = model.dt();
  model.rig()->let_go(state, {&schedule, 1});
  compute_forces(model, state, work);
  kick_nodes(model, state, work);
  kick_pads(model, state, {&schedule, 1}, work);
  book_work(model, state, work);
  double booked = 0;
  for (const double entry : state.work) booked += entry;
  EXPECT_LE(std::abs(kinetic_energy(model, state) - before - booked), 1e-12 * before);
  EXPECT_GT(std::abs(state.work[size_t(Book::release)]), 1e-3 * before);
  EXPECT_LT(std::abs(state.work[size_t(Book::release)]), 0.3 * before);
}

}  // namespace
}  // namespace drapeplan
