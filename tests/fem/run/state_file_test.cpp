// Pause, save, load, go on: the same bits; files that are not such a state are refused.
#include "fem/run/state_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "fem/run/simulate.hpp"
#include "tests/fem/run/drapes.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

/// A folder of this process that goes away.
struct ScratchFolder {
  fs::path path = fs::path(testing::TempDir()) / ("state_file_test_" + std::to_string(::getpid()));
  ScratchFolder() { fs::create_directories(path); }
  ~ScratchFolder() { fs::remove_all(path); }
};

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

Fabric rated_fabric() {
  Fabric fabric = test::woven_fabric();
  Curve fast = fabric.compression.slowest();
  for (double& stress : fast.stress) stress *= 2;
  fabric.compression.curves.push_back(fast);
  fabric.compression.rates = {1e-15, 1e-3};
  return fabric;
}

/// A strip that falls, clamped at one end, with rates.
Scene strip() {
  Scene scene;
  scene.mesh = rectangle_mesh(0.1, 0.02, 0.01);
  scene.fabric = rated_fabric();
  scene.gravity = 9.81;
  scene.damping = 22;
  scene.rest = RestCriterion{};
  for (size_t n = 0; n < scene.mesh.rest.size(); ++n) {
    if (scene.mesh.rest[n].x() < -0.0499) scene.clamped.push_back(int(n));
  }
  return scene;
}

/// A 2x2 rig with interlinks over the corner of the article's mold, with friction and rates; one pad lets go.
Scene drape() {
  Scene scene = test::corner_drape(0.02);
  scene.fabric = rated_fabric();
  return scene;
}

Schedule drop(const Scene& scene) {
  Schedule schedule = test::drop(scene, {.above = 2, .touch = 4, .end = 5});
  schedule.release = {std::nullopt, std::nullopt, std::nullopt, 4.2};
  return schedule;
}

std::vector<double> figures_of(const RunRecord& record) {
  std::vector<double> figures;
  visit_fields(record, [&figures](double figure) { figures.push_back(figure); });
  return figures;
}

void expect_same(const RunResult& whole, const RunResult& parts) {
  EXPECT_EQ(whole.summary.status, RunStatus::done) << whole.summary.message;
  EXPECT_EQ(whole.summary.message, parts.summary.message);
  EXPECT_EQ(whole.summary.state_hash, parts.summary.state_hash);
  EXPECT_EQ(whole.summary.steps, parts.summary.steps);
  EXPECT_EQ(whole.summary.energy.balance_error, parts.summary.energy.balance_error);
  EXPECT_EQ(whole.summary.energy.largest, parts.summary.energy.largest);
  EXPECT_EQ(whole.summary.largest_kinetic_ratio, parts.summary.largest_kinetic_ratio);
  EXPECT_EQ(whole.summary.largest_hourglass_share, parts.summary.largest_hourglass_share);
  EXPECT_EQ(figures_of(whole.state.record), figures_of(parts.state.record));
}

/// Runs in parts, each through a file and a model of its own.
RunResult in_parts(const Scene& scene, RunRequest request, const std::vector<double>& pauses) {
  const ScratchFolder folder;
  const fs::path file = folder.path / "state";
  std::optional<State> from;
  for (const double pause : pauses) {
    const Model model(scene);
    request.from = from ? &*from : nullptr;
    request.pause = pause;
    const RunResult part = simulate(model, request);
    EXPECT_EQ(part.summary.status, RunStatus::paused) << part.summary.message;
    EXPECT_EQ(part.summary.message, "paused, to be continued");
    save_state(file, model, part.state, request.schedule);
    StateReading reading = load_state(file, Model(scene), request.schedule);
    EXPECT_TRUE(reading.value) << reading.error;
    from = std::move(reading.value);
    EXPECT_EQ(hash_state(*from, model.node_count()), part.summary.state_hash);
  }
  request.from = &*from;
  request.pause = 0;
  return simulate(Model(scene), request);
}

TEST(Restart, GoesOnWithTheSameBitsForAFreeStripWithRates) {
  const RunRequest request{.duration = 0.3};
  expect_same(simulate(Model(strip()), request), in_parts(strip(), request, {0.0371, 0.1, 0.22}));
}

TEST(Restart, GoesOnWithTheSameBitsForADrapeWithRigMoldFrictionAndRelease) {
  const Scene scene = drape();
  const Schedule schedule = drop(scene);
  const RunRequest request{.schedule = &schedule};
  expect_same(simulate(Model(scene), request), in_parts(scene, request, {0.51, 3.3, 4.6}));
}

TEST(Restart, AfterACountOfStepsGoesOnWithTheSameBits) {
  const Model model(strip());
  const RunResult whole = simulate(model, {.duration = 0.05});
  const RunResult first = simulate(model, {.duration = 0.05, .steps = 37});
  EXPECT_EQ(first.summary.status, RunStatus::paused);
  EXPECT_EQ(first.state.step, 37);
  const RunResult second = simulate(model, {.duration = 0.05, .from = &first.state, .steps = 5});
  EXPECT_EQ(second.state.step, 42);
  expect_same(whole, simulate(model, {.duration = 0.05, .from = &second.state}));
}

TEST(Restart, ShowsTheSameFramesOnce) {
  std::vector<double> whole, parts;
  RunRequest request{.duration = 0.1, .frames = 7};
  request.observe = [&whole](const Snapshot& frame) { whole.push_back(frame.time); };
  simulate(Model(strip()), request);
  request.observe = [&parts](const Snapshot& frame) { parts.push_back(frame.time); };
  in_parts(strip(), request, {0.02, 0.051});
  EXPECT_EQ(whole.size(), 7U);
  EXPECT_EQ(whole, parts);
}

class StateFile : public testing::Test {
 protected:
  StateFile() { save_state(file, model, simulate(model, {.duration = 0.1, .pause = 0.01}).state); }

  void refuse(const fs::path& path, const Model& by, const std::string& reason,
              const Schedule* schedule = nullptr) const {
    const StateReading reading = load_state(path, by, schedule);
    EXPECT_FALSE(reading.value) << reason;
    EXPECT_NE(reading.error.find(path.string()), std::string::npos) << reading.error;
    EXPECT_NE(reading.error.find(reason), std::string::npos) << reading.error << " has no " << reason;
  }

  ScratchFolder folder;
  fs::path file = folder.path / "state", bad = folder.path / "bad";
  Model model{strip()};
};

TEST_F(StateFile, IsTakenByItsModelAndLeavesNothingBesideIt) {
  EXPECT_TRUE(load_state(file, model).value);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()), 1);
}

TEST_F(StateFile, IsRefusedWhenCutAnywhere) {
  const std::string bytes = bytes_of(file);
  for (size_t length = 1; length < bytes.size(); length += 1 + length / 3) {
    write(bad, bytes.substr(0, length));
    refuse(bad, model,
           length < 18                        ? "is not a saved state"
           : length < 34 || (length - 18) % 8 ? "is cut"
                                              : "is damaged");
  }
  write(bad, bytes.substr(0, bytes.size() - 8));
  refuse(bad, model, "is damaged: its checksum does not fit");
  write(bad, bytes + "x");
  refuse(bad, model, "is cut");
  write(bad, bytes + "12345678");
  refuse(bad, model, "is damaged");
}

TEST_F(StateFile, IsRefusedWithAnyBitFlipped) {
  const std::string bytes = bytes_of(file);
  for (size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 97) {
    std::string flipped = bytes;
    flipped[at] = char(flipped[at] ^ (1 << (at % 8)));
    write(bad, flipped);
    refuse(bad, model, at < 18 ? "is not a saved state" : "is damaged");
  }
}

TEST_F(StateFile, IsRefusedWhenEmptyMissingOrAFolder) {
  write(bad, "");
  refuse(bad, model, "is not a saved state");
  refuse(folder.path / "none", model, "cannot be read");
  refuse(folder.path, model, "cannot be read");
  write(bad, std::string(100, '\0'));
  refuse(bad, model, "is not a saved state");
}

TEST_F(StateFile, IsRefusedByEveryOtherModel) {
  const std::string reason = "was saved for another case, mesh or fidelity";
  const auto other = [&](const auto& change) {
    Scene scene = strip();
    change(scene);
    refuse(file, Model(scene), reason);
  };
  other([](Scene& s) { s.mesh = rectangle_mesh(0.1, 0.02, 0.009); });
  other([](Scene& s) { s.clamped.pop_back(); });
  other([](Scene& s) { s.gravity = 9.8; });
  other([](Scene& s) { s.gravity.reset(); });
  other([](Scene& s) { s.damping = 21; });
  other([](Scene& s) { s.options.rates = false; });
  other([](Scene& s) { s.options.section_points = 5; });
  other([](Scene& s) { s.fabric.compression.curves.back().stress.back() *= 1.01; });
  other([](Scene& s) { s.fabric.compression.rates.back() *= 2; });
  other([](Scene& s) { s.fabric.rate_floor *= 2; });
  other([](Scene& s) { s.fabric.rate_filter *= 2; });
  other([](Scene& s) { s.fabric.transverse_shear_modulus *= 1.01; });
  other([](Scene& s) { s.fabric.shear_measure = ShearMeasure::force; });
  other([](Scene& s) { s.rest->speed *= 2; });
  other([](Scene& s) { s.mold = inclined_plane(0.1), s.start_height = 1; });
}

TEST_F(StateFile, OfADrapeIsRefusedOnAnotherMoldOrByAnotherRig) {
  const Scene scene = drape();
  const Schedule schedule = drop(scene);
  const Model first(scene);
  save_state(file, first, simulate(first, {.schedule = &schedule, .pause = 0.1}).state, &schedule);
  ASSERT_TRUE(load_state(file, first, &schedule).value);
  const auto other = [&](const auto& change) {
    Scene changed = scene;
    change(changed);
    refuse(file, Model(changed), "was saved for another case", &schedule);
  };
  other([](Scene& s) { s.mold = inclined_plane(0.3); });
  other([](Scene& s) { s.friction = 1.4; });
  other([](Scene& s) { s.rig->fixed = {2, 2}; });
  other([](Scene& s) { s.rig->actuator_force_limit = 40; });
  other([](Scene& s) { s.position.x() += 0.001; });
}

/// A state of the drape with a rig, paused at 0.3 s, and its schedule.
class StateOfADrape : public StateFile {
 protected:
  StateOfADrape() {
    state = simulate(drape_model, {.schedule = &schedule, .pause = kPause}).state;
    save_state(file, drape_model, state, &schedule);
  }
  void expect_taken(const Schedule& by) const {
    const StateReading reading = load_state(file, drape_model, &by);
    EXPECT_TRUE(reading.value) << reading.error;
  }
  void refuse_schedule(const Schedule& by, const std::string& reason) const {
    refuse(file, drape_model, "was saved under another schedule: in the one given, " + reason, &by);
  }
  /// The path with a knot at `time`, which changes nothing.
  static void add_knot(std::vector<Knot>& path, double time) {
    for (size_t k = 1; k < path.size(); ++k) {
      if (!(path[k].time > time)) continue;
      const Knot &a = path[k - 1], &b = path[k];
      const double z = a.z + (b.z - a.z) * (time - a.time) / (b.time - a.time);
      path.insert(path.begin() + std::ptrdiff_t(k), {time, z});
      return;
    }
  }
  /// What comes after the pause is played half a second later.
  static void delay(std::vector<Knot>& path) {
    for (Knot& knot : path) knot.time += knot.time > kPause ? 0.5 : 0;
  }

  static constexpr double kPause = 0.3;
  Scene scene = drape();
  Schedule schedule = drop(scene);
  Model drape_model{scene};
  State state;
};

TEST_F(StateOfADrape, IsTakenUnderAScheduleThatDiffersOnlyLater) {
  expect_taken(schedule);
  Schedule later = schedule;
  add_knot(later.paths[0], kPause);
  expect_taken(later);
  delay(later.paths[0]);
  later.release[1] = 1.0;
  later.release[3].reset();
  expect_taken(later);
}

TEST_F(StateOfADrape, GoesOnAsIfTheLaterPartHadAlwaysBeenSo) {
  add_knot(schedule.paths[0], kPause);
  Schedule later = schedule;
  delay(later.paths[0]);
  save_state(file, drape_model, simulate(drape_model, {.schedule = &schedule, .pause = kPause}).state,
             &schedule);
  const StateReading reading = load_state(file, drape_model, &later);
  ASSERT_TRUE(reading.value) << reading.error;
  const RunResult parts = simulate(drape_model, {.schedule = &later, .from = &*reading.value, .pause = 1});
  const RunResult whole = simulate(drape_model, {.schedule = &later, .pause = 1});
  const RunResult other = simulate(drape_model, {.schedule = &schedule, .pause = 1});
  EXPECT_EQ(whole.summary.state_hash, parts.summary.state_hash);
  EXPECT_NE(whole.summary.state_hash, other.summary.state_hash);
}

TEST_F(StateOfADrape, IsTakenUnderTheSameCommandsSaidWithMoreKnots) {
  Schedule same = schedule;
  add_knot(same.paths[0], 0.1);
  add_knot(same.paths[3], 0.2345);
  expect_taken(same);
}

TEST_F(StateOfADrape, IsRefusedUnderAScheduleThatDiffersBefore) {
  Schedule other = schedule;
  other.blend_time *= 2;
  refuse_schedule(other, "changes of velocity take ");
  other = schedule;
  for (auto& path : other.paths) path.front().z += 0.001;
  refuse_schedule(other, "gripper [1, 1] is 1 mm off at 0 s");
  other = schedule;
  add_knot(other.paths[1], 0.2);
  other.paths[1][1].z += 1e-6;
  refuse_schedule(other, "gripper [2, 1] is 0.001 mm off at 0.2 s");
  other = schedule;
  other.release[0] = 0.25;
  refuse_schedule(other, "gripper [1, 1] lets go at another time");
  other = schedule;
  other.paths.pop_back();
  refuse_schedule(other, "3 paths instead of 4");
}

TEST_F(StateOfADrape, IsRefusedWithoutASchedule) {
  refuse(file, drape_model, "was saved under a schedule");
  save_state(file, drape_model, state);
  refuse(file, drape_model, "was saved without a schedule", &schedule);
}

TEST_F(StateFile, ThatCannotBeWrittenIsNamed) {
  const fs::path place = folder.path / "none" / "state";
  try {
    save_state(place, model, model.flat_state(0));
    ADD_FAILURE() << "written";
  } catch (const std::runtime_error& fault) {
    EXPECT_NE(std::string(fault.what()).find(place.string()), std::string::npos) << fault.what();
  }
}

}  // namespace
}  // namespace drapeplan
