// The time loop allocates nothing: a program of its own, since it replaces the global operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "fem/run/monitor.hpp"
#include "fem/run/simulate.hpp"
#include "fem/run/stable_step.hpp"
#include "tests/fem/run/drapes.hpp"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, whole > 0 ? whole : alignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size, alignof(std::max_align_t));
}
void* operator new[](std::size_t size) {
  return counted(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, std::size_t(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, std::size_t(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // std::stable_sort asks for this one
  try {
    return counted(size, alignof(std::max_align_t));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace drapeplan {
namespace {

/// Everything at once: rig with interlinks and rotation limits, contact, friction, rates, loads, releases.
Scene full_scene() {
  Scene scene = test::corner_drape(0.02);
  scene.rig->rotation_limits = RotationLimits{{-0.1, 0.1}, {-0.1, 0.1}};
  scene.rig->fixed = {1, 1};
  Curve fast = scene.fabric.compression.slowest();
  for (double& stress : fast.stress) stress *= 2;
  scene.fabric.compression.curves.push_back(fast);
  scene.fabric.compression.rates = {1e-15, 1e-3};
  scene.loads = Loads{.pressure = {0, 0, -0.1}};
  scene.rest = RestCriterion{.speed = 1e-12};
  return scene;
}

/// Down onto the mold within 4 s, then held; one pad lets go at 4.2 s.
Schedule drop(const Scene& scene) {
  Schedule schedule = test::drop(scene, {.above = 2, .touch = 4, .end = 5});
  schedule.release = {std::nullopt, std::nullopt, std::nullopt, 4.2};
  return schedule;
}

struct Count {
  long allocations = 0;
  std::int64_t steps = 0;
};

Count count_of(const Model& model, const Schedule& schedule, double duration) {
  const long before = allocations;
  const RunResult run = simulate(model, {.schedule = &schedule, .duration = duration});
  const long after = allocations;
  EXPECT_EQ(run.summary.message, "the time is over");
  return {after - before, run.summary.steps};
}

TEST(Allocations, AreCounted) {
  const long before = allocations;
  std::vector<double> list(10);
  EXPECT_EQ(allocations - before, 1);
  EXPECT_EQ(list.size(), 10U);
}

TEST(Allocations, OfARunDoNotDependOnTheNumberOfSteps) {
  const Scene scene = full_scene();
  const Model model(scene);
  const Schedule schedule = drop(scene);
  const Count once = count_of(model, schedule, 5), twice = count_of(model, schedule, 10);
  std::printf("%ld allocations in %ld steps, %ld in %ld\n", once.allocations, long(once.steps),
              twice.allocations, long(twice.steps));
  EXPECT_GE(twice.steps, once.steps * 3 / 2);
  EXPECT_EQ(once.allocations, twice.allocations);
  EXPECT_LE(once.allocations, 200);  // 200 looks at the ply are not one each, either
}

TEST(Allocations, AreNoneInAStepOrALook) {
  const Scene scene = full_scene();
  const Model model(scene);
  const Schedule schedule = drop(scene);
  const RigDrive drive{&schedule, scene.options.time_scaling};
  for (const double pause : {0.01, 3.9, 4.19, 4.5}) {
    State state = simulate(model, {.schedule = &schedule, .pause = pause}).state;
    Workspace work(model);
    Monitor monitor(model);
    RunSummary summary;
    monitor.look(state, summary);  // takes its room once
    const long before = allocations;
    for (int k = 0; k < 1000; ++k) {
      if (k % 32 == 0) {
        state.stable_dt = stable_step(model, state, work.step);
        state.dt = scene.options.step_safety * state.stable_dt;
      }
      model.rig()->let_go(state, drive);
      compute_forces(model, state, work);
      kick_nodes(model, state, work);
      kick_pads(model, state, drive, work);
      book_work(model, state, work);
      drift_nodes(model, state);
      model.rig()->drift(state);
      advance_clock(state);
      if (k % 100 == 0) monitor.look(state, summary);
      if (k % 500 == 0) monitor.compare_energies(state);
    }
    const long after = allocations;
    EXPECT_EQ(after - before, 0) << "from " << pause << " s on";
    EXPECT_EQ(summary.status, RunStatus::done) << summary.message;
  }
}

TEST(Allocations, AreNoneInAStepOfAPlyHeldByGrips) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.1, 0.04, 0.01);
  scene.fabric = test::woven_fabric();
  std::vector<int> right;
  for (size_t n = 0; n < scene.mesh.rest.size(); ++n) {
    if (scene.mesh.rest[n].x() < -0.0499) scene.clamped.push_back(int(n));
    if (scene.mesh.rest[n].x() > 0.0499) right.push_back(int(n));
  }
  scene.grips.push_back({.name = "right", .nodes = right, .velocity = {1e-3, 0, 0}, .ramp = 0.01});
  const Model model(scene);
  const auto count = [&model](double duration) {
    const long before = allocations;
    simulate(model, {.duration = duration});
    return allocations - before;
  };
  EXPECT_EQ(count(0.05), count(0.1));
}

}  // namespace
}  // namespace drapeplan
