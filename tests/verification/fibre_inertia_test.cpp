// Mass on the stretch of fibres changes the step and not the motion: a sheet swings from two corners, a strip
// hangs at rest.
#include "fem/run/simulate.hpp"
#include "tests/verification/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kSide = 0.2, kSwingTime = 0.2;  // [m], [s]

/// A woven sheet without damping, pinned at the two corners of its left side.
Scene swinging_sheet() {
  Scene scene;
  scene.mesh = rectangle_mesh(kSide, kSide, 0.01);
  scene.fabric = test::woven_fabric();
  scene.options.mass_scaling = 1;
  scene.gravity = 9.81;
  for (size_t n = 0; n < scene.mesh.rest.size(); ++n) {
    const Eigen::Vector2d& at = scene.mesh.rest[n];
    if (at.x() < -0.499 * kSide && std::abs(at.y()) > 0.499 * kSide) scene.pinned.push_back(int(n));
  }
  return scene;
}

/// Places of all nodes at equal times of the swing.
struct Film {
  std::int64_t steps = 0;
  std::vector<std::vector<Eigen::Vector3d>> places;

  [[nodiscard]] double lowest() const {
    double z = 0;
    for (const auto& frame : places) {
      for (const Eigen::Vector3d& x : frame) z = std::min(z, x.z());
    }
    return z;
  }
};

Film film(const Scene& scene) {
  constexpr int kFrames = 11;
  Film out;
  const RunResult run = simulate(
      Model(scene), {.duration = kSwingTime, .frames = kFrames, .observe = [&out](const Snapshot& s) {
                       out.places.push_back(s.position);
                     }});
  EXPECT_EQ(run.summary.status, RunStatus::done) << run.summary.message;
  EXPECT_EQ(out.places.size(), size_t(kFrames));
  out.steps = run.summary.steps;
  return out;
}

/// Root of the mean square and largest distance of nodes over all frames [m].
std::pair<double, double> apart(const Film& a, const Film& b) {
  double sum = 0, largest = 0, count = 0;
  for (size_t f = 0; f < std::min(a.places.size(), b.places.size()); ++f) {
    for (size_t n = 0; n < a.places[f].size(); ++n) {
      const double d = (a.places[f][n] - b.places[f][n]).norm();
      sum += d * d;
      if (!(d <= largest)) largest = d;
      ++count;
    }
  }
  return {std::sqrt(sum / count), largest};
}

void tell(const std::string& what, const Film& now, const Film& plain, double fall) {
  const auto [mean, largest] = apart(now, plain);
  std::printf(
      "  %-24s %6lld steps, %.2f times fewer; lowest %.4f mm; apart %.3f %% (r.m.s.), %.3f %% of the fall\n",
      what.c_str(), static_cast<long long>(now.steps), double(plain.steps) / double(now.steps),
      1e3 * now.lowest(), 100 * mean / fall, 100 * largest / fall);
}

TEST(FibreInertia, LeavesTheSwingOfASheetAsItIs) {
  const Film plain = film(swinging_sheet());
  const double fall = -plain.lowest();
  tell("none", plain, plain, fall);
  EXPECT_GE(fall, 0.5 * kSide);
  for (const double scaling : {4.0, 8.0}) {
    Scene scene = swinging_sheet();
    scene.options.fibre_mass_scaling = scaling;
    const Film now = film(scene);
    tell("fibre mass x " + std::to_string(int(scaling)), now, plain, fall);
    // The step without added mass follows the state, up to 1.45 times that for the steepest slopes.
    EXPECT_GE(double(plain.steps) / double(now.steps), 0.65 * scaling);
    EXPECT_LE(apart(now, plain).first, 5e-4 * fall);
    EXPECT_LE(apart(now, plain).second, 3e-3 * fall);
    EXPECT_LE(std::abs(now.lowest() - plain.lowest()), 3e-4 * fall);
  }
  Scene scene = swinging_sheet();
  scene.options.mass_scaling = 16;
  const Film heavy = film(scene);
  tell("mass of all 16 times", heavy, plain, fall);  // it falls by 7 % of the way
  EXPECT_GE(apart(heavy, plain).first, 0.3 * fall);
}

/// A strip that is clamped at its left end and hangs, damped.
Scene hanging_strip() {
  constexpr double kLength = 0.1;
  Scene scene;
  scene.mesh = rectangle_mesh(kLength, 0.03, 0.01);
  scene.fabric = test::woven_fabric();
  scene.options.mass_scaling = 1;
  scene.gravity = 9.81;
  scene.damping = 22;
  for (size_t n = 0; n < scene.mesh.rest.size(); ++n) {
    if (scene.mesh.rest[n].x() < -0.499 * kLength) scene.clamped.push_back(int(n));
  }
  return scene;
}

TEST(FibreInertia, LeavesTheSagOfAStripAsItIs) {
  constexpr double kTime = 2;  // [s]
  std::vector<RunResult> runs;
  for (const double scaling : {1.0, 4.0, 8.0}) {
    Scene scene = hanging_strip();
    scene.options.fibre_mass_scaling = scaling;
    runs.push_back(simulate(Model(scene), {.duration = kTime}));
    ASSERT_EQ(runs.back().summary.status, RunStatus::done) << runs.back().summary.message;
  }
  double sag = 0;
  for (const Eigen::Vector3d& x : runs[0].final.position) sag = std::max(sag, -x.z());
  EXPECT_GE(sag, 0.01);
  for (const RunResult& run : runs) {
    double largest = 0;
    for (size_t n = 0; n < run.final.position.size(); ++n) {
      const double d = (run.final.position[n] - runs[0].final.position[n]).norm();
      if (!(d <= largest)) largest = d;
    }
    std::printf("  sag %.4f mm, %lld steps, apart %.2e of it\n", 1e3 * sag,
                static_cast<long long>(run.summary.steps), largest / sag);
    EXPECT_LE(largest, 1e-8 * sag);
  }
}

}  // namespace
}  // namespace drapeplan
