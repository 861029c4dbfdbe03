// Sheets that shear: fibres that are far stiffer than the shear between them, and locking.
#include <fmt/format.h>

#include <cmath>

#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

using Scenes = std::vector<StressScene>;

/// A square sheet held at one edge and pulled along the opposite one: a trellis. @param force  over edge and
/// thickness [Pa].
struct Trellis {
  Fabric fabric;
  double force = 0;
  double overdamping = 1;  ///< the load acts at once: a lock that is run into tears fibres
  int cells = 6;
};

constexpr double kTrellisSide = 0.06;  // [m]

double angle_of(const Trellis& trellis) {
  const Curve& shear = trellis.fabric.shear.slowest();
  if (trellis.fabric.shear_measure == ShearMeasure::conjugate) return trellis_angle(shear, trellis.force);
  // Stress times cosine is conjugate: the cosines cancel.
  double low = 0, high = 0.5 * std::acos(-1.0);
  for (int n = 0; n < 100; ++n) (shear(0.5 * (low + high)) > trellis.force ? high : low) = 0.5 * (low + high);
  return low;
}

StressSetup trellis_setup(const Trellis& trellis) {
  StressSetup setup;
  Scene& scene = setup.scene;
  const int n = trellis.cells;
  scene.mesh =
      grid_mesh(n, n, [](double u, double v) { return Eigen::Vector2d(kTrellisSide * u, kTrellisSide * v); });
  scene.fabric = trellis.fabric;
  scene.options.mass_scaling = 1;
  Loads loads;
  const double share = trellis.force * kTrellisSide * trellis.fabric.thickness / n;
  for (int j = 0; j <= n; ++j) {
    scene.pinned.push_back(j * (n + 1));
    loads.forces.push_back({j * (n + 1) + n, {0, j % n == 0 ? 0.5 * share : share, 0}});
  }
  scene.loads = loads;
  // Turning about the held edge with the secant stiffness at the end: inertia m L^2 / 3 per area.
  constexpr double kConstants = 12;
  const double angle = angle_of(trellis);
  const double secant = trellis.force * std::cos(angle) / angle * trellis.fabric.thickness;
  const double rate = std::sqrt(3 * secant / (trellis.fabric.areal_density * kTrellisSide * kTrellisSide));
  scene.damping = 2 * trellis.overdamping * rate;
  setup.duration = 2 * kConstants * trellis.overdamping / rate;
  return setup;
}

/// Mean shear angle of the four elements in the middle [deg]: along free edges the stress across the fibres
/// fades over some sqrt(shear / fibre stiffness) of the side.
double middle_shear(const StressRun& run, int cells) {
  const auto& shear = run.result.final.shear;
  double sum = 0;
  for (const int j : {cells / 2 - 1, cells / 2}) {
    for (const int i : {cells / 2 - 1, cells / 2}) sum += std::abs(shear[size_t(j * cells + i)]);
  }
  return sum / 4 / kDegree;
}

StressScene trellis_scene(std::string group, std::string name, const Trellis& trellis, double share = 0.01) {
  return {std::move(group), std::move(name), [trellis] { return trellis_setup(trellis); },
          [trellis, share](const StressRun& run) {
            return std::vector{
                near("shear [deg]", middle_shear(run, trellis.cells), angle_of(trellis) / kDegree, share)};
          }};
}

void add_stiffness(Scenes& scenes) {
  for (const double ratio : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
    StripSetup strip;
    strip.shear = strip.transverse = strip.modulus / ratio;
    scenes.push_back(strip_scene("stiffness", fmt::format("fibre / shear {:.3g}: sag", ratio), strip));
    scenes.back().fast = ratio == 1e7;
    if (ratio < 1e4) continue;  // the middle still feels the edges
    const double shear = 1e9 / ratio;
    const Trellis trellis{linear_fabric(1e9, shear, 1e7), shear * 45 * kDegree / std::cos(45 * kDegree)};
    scenes.push_back(
        trellis_scene("stiffness", fmt::format("fibre / shear {:.3g}: trellis to 45 deg", ratio), trellis));
  }
}

void add_locking(Scenes& scenes) {
  // Fibres are stiff both ways: the stress across them ends at the free edges in one fibre under tension and
  // one under compression.
  Fabric locking = linear_fabric(2e10, 1, 1e7);
  locking.shear = Curve{{0, 10 * kDegree, 35 * kDegree, 50 * kDegree, 58 * kDegree, 62 * kDegree},
                        {0, 0.09e6, 0.11e6, 0.4e6, 1e6, 20e6}};
  const auto force_at = [](const Fabric& fabric, double degrees) {
    return fabric.shear.slowest()(degrees * kDegree) / std::cos(degrees * kDegree);
  };
  constexpr double kCreep = 5;
  scenes.push_back(
      trellis_scene("locking", "steep lock at 60 deg", {locking, force_at(locking, 60), kCreep}));
  scenes.back().fast = true;
  Fabric by_force = locking;
  by_force.shear_measure = ShearMeasure::force;
  scenes.push_back(trellis_scene("locking", "the same, curve by force",
                                 {by_force, by_force.shear.slowest()(60 * kDegree), kCreep}));
  Fabric ending = locking;
  ending.shear = woven_fabric().shear;
  scenes.push_back(trellis_scene("locking", "shear to 70 deg, the table ends at 50",
                                 {ending, force_at(ending, 70), kCreep}));
  const Fabric soft = linear_fabric(1e10, 1e5, 1e7);
  scenes.push_back(trellis_scene("locking", "no lock, 75 deg", {soft, force_at(soft, 75), kCreep}));
  for (const double degrees : {82.0, 88.0}) {
    scenes.push_back(trellis_scene("locking",
                                   fmt::format("no lock, {:.3g} deg: beyond what is tabulated", degrees),
                                   {soft, force_at(soft, degrees)}));
    scenes.back().otherwise = Verdict::stopped;
    scenes.back().says = "sheared by more than";
  }
}

}  // namespace

void add_shear_scenes(Scenes& scenes) {
  add_stiffness(scenes);
  add_locking(scenes);
}

}  // namespace drapeplan
