// Drapes with fibre inertia: their bits, books, steps, and where it is refused or blamed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "fem/run/simulate.hpp"
#include "fem/run/stable_step.hpp"
#include "fem/run/state_file.hpp"
#include "tests/fem/run/drapes.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

/// 3x3 grippers with interlinks over the middle of the article's mold, the middle one fixed, with friction.
/// Masses and time are scaled as in the shipped cases.
Scene drape(double fibre_mass) {
  Scene scene = test::middle_drape(0.205, 0.017);
  scene.options.mass_scaling = 20;
  scene.options.time_scaling = 4;
  scene.options.fibre_mass_scaling = fibre_mass;
  return scene;
}
Schedule drop(const Scene& scene) {
  return test::drop(scene, {.above = 2, .touch = 4, .end = 5});
}
constexpr double kRelease = 4.2;  // [s]
/// A pad in the corner lets go when all lie on the mold.
Schedule drop_and_release(const Scene& scene) {
  Schedule schedule = drop(scene);
  schedule.release.assign(schedule.paths.size(), std::nullopt);
  schedule.release.back() = kRelease;
  return schedule;
}

TEST(FibreInertiaDrape, GoesOnWithTheSameBitsThroughAFile) {
  const Scene scene = drape(4);
  const Schedule schedule = drop_and_release(scene);
  const RunResult whole = simulate(Model(scene), {.schedule = &schedule});
  ASSERT_EQ(whole.summary.status, RunStatus::done) << whole.summary.message;
  const fs::path file =
      fs::path(testing::TempDir()) / ("fibre_inertia_test_" + std::to_string(::getpid()) + ".state");
  std::optional<State> from;
  for (const double pause : {0.51, 3.3, 4.6}) {
    const Model model(scene);
    const RunResult part =
        simulate(model, {.schedule = &schedule, .from = from ? &*from : nullptr, .pause = pause});
    ASSERT_EQ(part.summary.status, RunStatus::paused) << part.summary.message;
    EXPECT_NE(part.state.step % scene.options.step_interval, 0);  // directions are not taken anew at once
    save_state(file, model, part.state, &schedule);
    StateReading reading = load_state(file, Model(scene), &schedule);
    ASSERT_TRUE(reading.value) << reading.error;
    EXPECT_FALSE(load_state(file, Model(drape(3)), &schedule).value);
    from = std::move(reading.value);
  }
  fs::remove(file);
  const RunResult parts = simulate(Model(scene), {.schedule = &schedule, .from = &*from});
  EXPECT_EQ(whole.summary.state_hash, parts.summary.state_hash);
  EXPECT_EQ(whole.summary.steps, parts.summary.steps);
  EXPECT_EQ(whole.summary.energy.balance_error, parts.summary.energy.balance_error);
  EXPECT_EQ(whole.state.work, parts.state.work);
}

TEST(FibreInertiaDrape, KeepsItsBooksAndAddsNextToNoWork) {
  const Scene scene = drape(4);
  const Schedule schedule = drop(scene);
  const Model model(scene);
  const double first = 0.1, between = 0.1;
  double largest = 0;
  RunResult run = simulate(model, {.schedule = &schedule, .pause = first});
  for (double pause = first + between; run.summary.status == RunStatus::paused; pause += between) {
    largest = std::max(largest, std::abs(run.state.work[size_t(Book::fibre_inertia)]));
    const State from = run.state;
    run = simulate(model, {.schedule = &schedule, .from = &from, .pause = pause});
  }
  ASSERT_EQ(run.summary.status, RunStatus::done) << run.summary.message;
  std::printf("balance %.1e; work of added mass %.1e of the largest energy, at the end %.1e\n",
              run.summary.energy.balance_error, largest / run.state.record.energy,
              run.state.work[size_t(Book::fibre_inertia)] / run.state.record.energy);
  EXPECT_LE(run.summary.energy.balance_error, 1e-8);
  EXPECT_GT(largest, 0);
  EXPECT_LE(largest, 0.01 * run.state.record.energy);
}

// Light nodes that a pad has let go must not feel edges as the pad did: with the filter of the pad for one
// step, that step alone gave a tenth of all energy.
TEST(FibreInertiaDrape, GivesNoEnergyWhenAPadLetsGo) {
  const Scene scene = drape(4);
  const Schedule schedule = drop_and_release(scene);
  const RunResult run = simulate(Model(scene), {.schedule = &schedule, .pause = kRelease + 0.1});
  ASSERT_EQ(run.summary.status, RunStatus::paused) << run.summary.message;
  ASSERT_TRUE(run.state.pads.back().released);
  const double added = run.state.work[size_t(Book::fibre_inertia)] / run.state.record.energy;
  std::printf("work of added mass after the release: %.1e of the largest energy\n", added);
  EXPECT_LE(added, 0.01);
  EXPECT_GE(added, -0.03);  // the nodes spring off: mass on their edges takes its share
  EXPECT_LE(run.summary.energy.balance_error, 1e-8);
}

TEST(FibreInertiaDrape, MakesFewerStepsAndTheSameDrape) {
  RunResult runs[2];
  for (const int k : {0, 1}) {
    const Scene scene = drape(k == 0 ? 1 : 4);
    const Schedule schedule = drop(scene);
    runs[k] = simulate(Model(scene), {.schedule = &schedule});
    ASSERT_EQ(runs[k].summary.status, RunStatus::done) << runs[k].summary.message;
  }
  double apart = 0;
  for (size_t n = 0; n < runs[0].final.position.size(); ++n)
    apart = std::max(apart, (runs[0].final.position[n] - runs[1].final.position[n]).norm());
  const double fewer = double(runs[0].summary.steps) / double(runs[1].summary.steps);
  std::printf("%.2f times fewer steps, %.3f mm apart\n", fewer, 1e3 * apart);
  EXPECT_GE(fewer, 2.2);    // 4 over what the estimate for the state gains on the steepest slopes
  EXPECT_LE(apart, 0.002);  // a move of the start by 1e-12 m does up to 0.5 mm: tests/bench/fem.md
}

// Two by two light grippers hold nothing but each other: what is not symmetric about the mass of edges at
// pads feeds the motion there once they touch. That must not pass for a result.
TEST(FibreInertiaDrape, IsBlamedWhereItGivesEnergy) {
  Scene scene = test::corner_drape(0.02);
  scene.options.fibre_mass_scaling = 4;
  const Schedule schedule = test::drop(scene, {.above = 2, .touch = 4, .end = 5});
  const RunResult run = simulate(Model(scene), {.schedule = &schedule});
  EXPECT_EQ(run.summary.status, RunStatus::diverged);
  EXPECT_NE(run.summary.message.find("lower fibre_mass_scaling"), std::string::npos) << run.summary.message;
}

TEST(FibreInertiaDrape, PlaysAStepThatIsNotAboveTheTrueOne) {
  const Scene scene = drape(4);
  const Schedule schedule = drop(scene);
  const Model model(scene);
  for (const double pause : {1e-3, 1.0, 3.0, 3.9, 4.5, 0.0}) {
    const RunResult run = simulate(model, {.schedule = &schedule, .pause = pause});
    ASSERT_NE(run.summary.status, RunStatus::diverged) << run.summary.message;
    StepScratch scratch(model);
    State state = run.state;
    model.fibre_inertia()->take_directions(state);  // as choose_step does
    const double estimate = stable_step(model, state, scratch), truth = true_stable_step(model, state);
    std::printf("at %.2f s: estimate %.3f us, true %.3f us, ratio %.3f\n", run.final.time, 1e6 * estimate,
                1e6 * truth, estimate / truth);
    EXPECT_LE(estimate, 1.001 * truth);
    EXPECT_GE(estimate, 0.4 * truth);
  }
}

std::string refusal(const Scene& scene) {
  try {
    const Model model(scene);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "none";
}

TEST(FibreInertiaDrape, IsRefusedWithoutAStepThatFollowsTheStateOrWithoutRectangles) {
  Scene scene = drape(4);
  EXPECT_EQ(refusal(scene), "none");
  scene.options.step_interval = 0;
  EXPECT_NE(refusal(scene).find("step_interval above 0"), std::string::npos) << refusal(scene);
  scene = Scene();
  scene.mesh = test::distorted_mesh(0.02, 0.02, 0.01, 0.2);  // of its four elements all share the moved node
  scene.fabric = test::woven_fabric();
  scene.options.fibre_mass_scaling = 4;
  EXPECT_NE(refusal(scene).find("rectangles along the fibres"), std::string::npos) << refusal(scene);
  scene.options.fibre_mass_scaling = 1;
  EXPECT_EQ(refusal(scene), "none");
}

}  // namespace
}  // namespace drapeplan
