// Numerical settings: mass scaling, the step, contact and hourglass stiffness.
#include <fmt/format.h>

#include <cmath>

#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

using Scenes = std::vector<StressScene>;

/// A strip of shares of the fibre in compression: central differences feed its vibrations.
StripSetup woven_strip(double step_safety) {
  StripSetup strip;
  strip.compression_share = 0.1;
  strip.options.step_safety = step_safety;
  return strip;
}

void add_mass(Scenes& scenes) {
  for (const double scaling : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5}) {
    StripSetup strip;
    strip.options.mass_scaling = scaling;
    scenes.push_back(strip_scene("mass scaling", fmt::format("x {:.3g}: sag", scaling), strip));
    scenes.back().fast = scaling == 1e5;
  }
  for (const double scaling : {2.0, 4.0, 8.0}) {
    StripSetup strip;
    strip.options.fibre_mass_scaling = scaling;
    scenes.push_back(strip_scene("mass scaling", fmt::format("fibre mass x {:.3g}: sag", scaling), strip));
  }
  for (const double scaling : {1.0, 1e3, 1e5}) {
    scenes.push_back(drape_scene("mass scaling", fmt::format("x {:.3g}: drape", scaling),
                                 [scaling](StressSetup& s) { s.scene.options.mass_scaling = scaling; }));
    if (scaling < 1e3) continue;
    // Too heavy to come to rest in time: it must lie where the light one lies, or the ratio of energies that
    // every run reports says that inertia decides.
    scenes.back().rests = false;
    scenes.back().judge = [](const StressRun& run) {
      FemOptions light = run.setup.scene.options;
      light.mass_scaling = 4;
      const double ratio = run.result.summary.largest_kinetic_ratio;
      const std::string words = ratio > 1 ? fmt::format("told by a kinetic ratio of {:.3g}; ", ratio) : "";
      return std::vector{
          at_most(words + "apart from mass x 4 [m]", apart_from(run, light), ratio > 1 ? 0.01 : 1e-3)};
    };
    if (scaling < 1e5) continue;
    scenes.back().otherwise = Verdict::stopped;
    scenes.back().says = "inside the mold";  // pads that heavy nodes follow too late push them in
  }
  for (const double scaling : {2.0, 4.0, 8.0}) {
    scenes.push_back(
        drape_scene("mass scaling", fmt::format("fibre mass x {:.3g}: drape held by interlinks", scaling),
                    [scaling](StressSetup& s) { s.scene.options.fibre_mass_scaling = scaling; }));
    scenes.back().otherwise = Verdict::stopped;
    scenes.back().says = "lower fibre_mass_scaling";
  }
  StripSetup target;
  target.options.target_step = 1e-3;
  scenes.push_back(strip_scene("mass scaling", "mass for a step of 1 ms: sag", target));
  scenes.back().build = [target] {
    StressSetup setup = hinged_strip(target);
    setup.duration *= 10;  // some thousand times its mass
    return setup;
  };
}

void add_steps(Scenes& scenes) {
  for (const double share : {0.5, 0.9, 0.95, 0.99, 1.0}) {
    scenes.push_back(
        strip_scene("step", fmt::format("{:.3g} of the estimate: woven strip", share), woven_strip(share)));
    scenes.back().bisect = share == 0.9;
    scenes.back().fast = share == 0.95;
    // Bulk viscosity leaves no window of growth up to 0.95 (tests/bench/fem.md).
    if (share > 0.95) scenes.back().otherwise = Verdict::stopped, scenes.back().says = "unstable";
    scenes.push_back(drape_scene("step", fmt::format("{:.3g} of the estimate: drape", share),
                                 [share](StressSetup& s) { s.scene.options.step_safety = share; }));
    scenes.back().bisect = share == 0.9;
    scenes.back().rests = true;
  }
  for (const double share : {1.2, 1.5, 3.0}) {
    scenes.push_back(
        strip_scene("step", fmt::format("{:.3g} of the estimate: woven strip", share), woven_strip(share)));
    scenes.back().otherwise = Verdict::stopped;
    scenes.push_back(drape_scene("step", fmt::format("{:.3g} of the estimate: drape", share),
                                 [share](StressSetup& s) { s.scene.options.step_safety = share; }));
    scenes.back().otherwise = Verdict::stopped;
  }
  StripSetup fixed = woven_strip(0.9);
  fixed.options.step_interval = 0;
  scenes.push_back(strip_scene("step", "one step for all strains", fixed));
  scenes.back().bisect = true;
}

/// The shell's forces in single precision, where rounding would show: small strains of stiff fibres, thin
/// plies, heavy nodes, long steps.
void add_precision(Scenes& scenes) {
  const auto single = [](StripSetup strip) {
    strip.options.precision = Precision::single_lanes;
    return strip;
  };
  for (const double ratio : {1e2, 1e4, 1e7}) {
    StripSetup strip;
    strip.shear = strip.transverse = strip.modulus / ratio;
    scenes.push_back(
        strip_scene("single precision", fmt::format("fibre / shear {:.3g}: sag", ratio), single(strip)));
    scenes.back().fast = ratio == 1e7;
  }
  StripSetup thin, heavy;
  thin.thickness = 1e-5 * thin.length;
  scenes.push_back(strip_scene("single precision", "thickness / length 1e-05: sag", single(thin)));
  heavy.options.mass_scaling = 1e5;
  scenes.push_back(strip_scene("single precision", "mass scaling 1e+05: sag", single(heavy)));
  scenes.push_back(
      strip_scene("single precision", "0.95 of the estimate: woven strip", single(woven_strip(0.95))));
  scenes.push_back(drape_scene("single precision", "drape",
                               [](StressSetup& s) { s.scene.options.precision = Precision::single_lanes; }));
  scenes.push_back(scenes.back());
  scenes.back().name = "drape, beside double precision";
  scenes.back().judge = [](const StressRun& run) {
    FemOptions twice = run.setup.scene.options;
    twice.precision = Precision::double_lanes;
    return std::vector{at_most("apart from double precision [m]", apart_from(run, twice), 1e-3)};
  };
}

void add_settings(Scenes& scenes) {
  for (const double stiffness : {1e-3, 1.0}) {
    scenes.push_back(
        drape_scene("settings", fmt::format("contact stiffness {:.3g}", stiffness),
                    [stiffness](StressSetup& s) { s.scene.options.contact_stiffness = stiffness; }));
  }
  scenes.push_back(drape_scene("settings", "no contact damping",
                               [](StressSetup& s) { s.scene.options.contact_damping = 0; }));
  scenes.back().rests = false;  // it bounces on, as was asked for
  scenes.back().judge = nullptr;
  scenes.back().most_given = 0.01;
  scenes.push_back(drape_scene("settings", "critical contact damping",
                               [](StressSetup& s) { s.scene.options.contact_damping = 1; }));
  for (const double hourglass : {0.0, 100.0}) {
    scenes.push_back(drape_scene("settings", fmt::format("hourglass {:.3g}", hourglass),
                                 [hourglass](StressSetup& s) { s.scene.options.hourglass = hourglass; }));
  }
  for (const double viscosity : {0.0, 1.0}) {
    scenes.push_back(
        drape_scene("settings", fmt::format("bulk viscosity {:.3g}", viscosity),
                    [viscosity](StressSetup& s) { s.scene.options.bulk_viscosity = viscosity; }));
    // Without it fibres of two stiffnesses are fed by central differences; as much as is critical is no
    // better.
    scenes.back().otherwise = Verdict::stopped;
    scenes.back().says = "unstable";
  }
  for (const double alpha : {0.0, 1e6}) {
    scenes.push_back(drape_scene("settings", fmt::format("damping {:.3g} / s", alpha),
                                 [alpha](StressSetup& s) { s.scene.damping = alpha; }));
    scenes.back().rests = false;
    scenes.back().judge = nullptr;  // it swings on, or has not arrived, as was asked for
  }
}

}  // namespace

void add_numeric_scenes(Scenes& scenes) {
  add_mass(scenes);
  add_steps(scenes);
  add_precision(scenes);
  add_settings(scenes);
}

}  // namespace drapeplan
