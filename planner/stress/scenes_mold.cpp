// Sheets on molds: friction, curvature, steep walls, edges, starts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

using Scenes = std::vector<StressScene>;

/// The incline case of the user, with overrides.
StressSetup incline(const std::vector<std::string>& overrides) {
  return from_case(R"({
    "format": "drapeplan-case 1",
    "ply": {"width": "40 mm", "height": "40 mm", "start": "on_mold"},
    "material": {"law": "linear", "thickness": "0.3 mm", "areal_density": "314 g/m^2",
      "transverse_shear_modulus": "10 MPa", "modulus": "1 GPa", "shear_modulus": "100 MPa"},
    "mold": {"shape": "plane", "extent": [["-500 mm", "500 mm"], ["-500 mm", "500 mm"]], "angle": "30 deg"},
    "friction": {"coefficient": 0.7},
    "gravity": "9.81 m/s^2",
    "duration": "0.2 s",
    "fem": {"mesh_size": "10 mm", "mass_scaling": 1}
  })",
                   overrides);
}

std::vector<std::string> tilted(double degrees, double coefficient) {
  return {fmt::format("mold.angle=\"{:f} deg\"", degrees),
          fmt::format("friction.coefficient={:f}", coefficient)};
}

/// Path of a block on an incline in the time [m], down the slope.
double block_path(double degrees, double coefficient, double gravity, double time) {
  const double pull = std::sin(degrees * kDegree) - coefficient * std::cos(degrees * kDegree);
  return 0.5 * gravity * std::max(0.0, pull) * time * time;
}

StressScene incline_scene(std::string group, std::string name, double degrees, double coefficient,
                          double gravity = kGravity, double duration = 0.2) {
  const bool slides = block_path(degrees, coefficient, gravity, 1) > 0;
  StressScene scene{std::move(group), std::move(name),
                    [=] {
                      StressSetup setup = incline(tilted(degrees, std::min(coefficient, 100.0)));
                      setup.scene.friction = coefficient;  // the reader takes up to 100
                      setup.scene.gravity = gravity;
                      setup.duration = duration;
                      return setup;
                    },
                    [=](const StressRun& run) {
                      const double path = mean_displacement(run).norm();
                      if (!slides) return std::vector{at_most("path [m]", path, 1e-5)};
                      const double right = block_path(degrees, coefficient, gravity, run.setup.duration);
                      return std::vector{near("path [m]", path, right, 0.005)};
                    }};
  scene.rests = !slides;
  scene.most_drift = 1e-9;
  return scene;
}

void add_friction(Scenes& scenes) {
  for (const double coefficient : {0.0, 0.3, 0.5, 0.7, 1.5, 100.0, 1000.0})
    scenes.push_back(
        incline_scene("friction", fmt::format("30 deg, coefficient {:.3g}", coefficient), 30, coefficient));
  scenes[scenes.size() - 2].fast = true;
  scenes.push_back(
      incline_scene("friction", "34.9 deg, coefficient 0.7: below the limit of 34.99", 34.9, 0.7));
  scenes.push_back(incline_scene("friction", "35.1 deg, coefficient 0.7: above it", 35.1, 0.7));
  scenes.push_back({"friction", "coefficient 1000 in a case",
                    [] { return incline({"friction.coefficient=1000"}); }, nullptr, Verdict::refused,
                    "/friction/coefficient"});
  scenes.push_back({"friction", "coefficient -1 in a case",
                    [] { return incline({"friction.coefficient=-1"}); }, nullptr, Verdict::refused,
                    "/friction/coefficient"});
  scenes.push_back(incline_scene("friction", "80 deg, coefficient 1000", 80, 1000));
  scenes.push_back(incline_scene("friction", "80 deg, coefficient 0", 80, 0));
}

/// A woven strip that falls onto a mold from `above` its highest point.
struct Fall {
  Mold mold;
  double length = 0.2, width = 0.04, mesh_size = 0.01;  ///< [m]
  double above = 1e-3;                                  ///< [m]
  double friction = 0.5;
  double duration = 3;  ///< [s]
};

StressSetup fall_onto(const Fall& fall) {
  constexpr int kSamples = 400;  // per side, to find the highest point under the ply
  StressSetup setup;
  Scene& scene = setup.scene;
  scene.mesh = rectangle_mesh(fall.length, fall.width, fall.mesh_size);
  scene.fabric = woven_fabric();
  scene.mold = fall.mold;
  scene.friction = fall.friction;
  scene.gravity = kGravity;
  scene.damping = 22;
  double top = -1e300;
  for (int i = 0; i <= kSamples; ++i) {
    for (int j = 0; j <= kSamples; ++j) {
      const double z = fall.mold.height((double(i) / kSamples - 0.5) * fall.length,
                                        (double(j) / kSamples - 0.5) * fall.width);
      if (z > top) top = z;
    }
  }
  scene.start_height = top + 0.5 * scene.fabric.thickness + fall.above;
  setup.duration = fall.duration;
  return setup;
}

StressScene fall_scene(std::string group, std::string name, const Fall& fall) {
  StressScene scene{std::move(group), std::move(name), [fall] { return fall_onto(fall); },
                    [](const StressRun& run) {
                      return std::vector{near("support over weight", support_over_weight(run), 1, 0.01)};
                    }};
  scene.most_drift = 1e-4;
  return scene;
}

Extent square(double half) {
  return {{-half, -half}, {half, half}};
}

/// A crest (or a trough) of a radius along y.
Mold parabola(double radius, double half, bool crest = true) {
  return Mold(PolynomialShape{{{2, 0, (crest ? -0.5 : 0.5) / radius}}}, square(half));
}

void add_curvature(Scenes& scenes) {
  constexpr double kCell = 0.01;
  for (const double cells : {20.0, 5.0, 2.0}) {
    const std::string radius = fmt::format("radius of {:.3g} elements", cells);
    scenes.push_back(fall_scene("curvature", "crest, " + radius, {parabola(cells * kCell, 0.3)}));
    scenes.push_back(
        fall_scene("curvature", "trough, " + radius, {parabola(cells * kCell, 0.3, false), 0.1}));
    scenes.push_back(fall_scene("curvature", "sphere, " + radius,
                                {Mold(SphereShape{{0, 0, 0}, cells * kCell}, square(0.3)), 0.1, 0.1}));
    scenes.back().otherwise = Verdict::stopped;  // what swings in below the equator is inside a height field
    scenes.back().says = "inside the mold";
  }
  scenes.push_back(fall_scene("curvature", "sphere, radius of half an element, between nodes",
                              {Mold(SphereShape{{0.005, 0.005, 0}, 0.5 * kCell}, square(0.3)), 0.1, 0.1}));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "curved";
}

/// A plateau whose wall falls like -0.05 m (x / 0.1 m)^12.
Mold plateau() {
  return Mold(PolynomialShape{{{12, 0, -0.05 / std::pow(0.1, 12)}}}, square(0.3));
}

void add_contact_stiffness(Scenes& scenes) {
  for (const double stiffness : {1e-4, 1.0, 100.0}) {
    StressScene scene =
        incline_scene("settings", fmt::format("contact stiffness {:.3g}, incline", stiffness), 30, 0.7);
    scene.build = [stiffness] {
      StressSetup setup = incline({});
      setup.scene.options.contact_stiffness = stiffness;
      return setup;
    };
    // At the highest frequency booked and stored energy differ by the square of the step.
    if (stiffness >= 1) scene.most_given = 0.05;
    if (stiffness > 1) scene.otherwise = Verdict::stopped, scene.says = "unstable";
    scenes.push_back(scene);
  }
}

void add_walls(Scenes& scenes) {
  scenes.push_back(fall_scene("steep walls", "plateau, wall of up to 80 deg", {plateau(), 0.2}));
  scenes.push_back(
      fall_scene("steep walls", "plateau, the ply hangs down a wall beyond 84 deg", {plateau(), 0.4}));
  scenes.back().otherwise = Verdict::stopped;
  scenes.back().says = "inside the mold";
  for (const double degrees : {84.0, 86.0, 89.9}) {
    scenes.push_back(
        incline_scene("steep walls", fmt::format("laid on a plane of {:.3g} deg", degrees), degrees, 0));
    if (degrees < 84.2) continue;
    scenes.back().otherwise = Verdict::refused;
    scenes.back().says = "steep";
  }
  scenes.push_back({"steep walls", "a plane of 90 deg in a case",
                    [] { return incline({"mold.angle=\"90 deg\""}); }, nullptr, Verdict::refused,
                    "/mold/angle"});
}

void add_edges(Scenes& scenes) {
  const auto extent = [](const std::string& half) {
    return fmt::format("mold.extent=[[\"-{0}\",\"{0}\"],[\"-{0}\",\"{0}\"]]", half);
  };
  scenes.push_back({"mold edge", "edge inside the ply", [=] { return incline({extent("10 mm")}); }, nullptr,
                    Verdict::refused, "extent"});
  scenes.push_back({"mold edge", "slides over the edge",
                    [=] {
                      return incline({extent("30 mm"), "friction.coefficient=0"});
                    },
                    nullptr, Verdict::stopped, "edge"});
  scenes.back().rests = false;
  scenes.back().fast = true;
  scenes.push_back({"mold edge", "no extent at all", [=] { return incline({extent("0 mm")}); }, nullptr,
                    Verdict::refused, "extent"});
}

void add_starts(Scenes& scenes) {
  const auto level = [](const std::string& height) {
    return std::vector<std::string>{"ply.start=\"level\"", "mold.angle=\"0 deg\"",
                                    fmt::format("start_height=\"{}\"", height)};
  };
  for (const std::string height : {"0.15 mm", "0.1 mm", "0 mm", "-0.2 mm"}) {
    const double deep = 1.5e-4 - std::stod(height) * 1e-3;
    scenes.push_back({"start", fmt::format("underside {:.3g} mm in the mold", 1e3 * deep),
                      [=] { return incline(level(height)); },
                      [](const StressRun& run) {
                        return std::vector{near("support over weight", support_over_weight(run), 1, 0.01)};
                      }});
    if (deep < 1e-5) continue;
    scenes.back().otherwise = Verdict::refused;
    scenes.back().says = "below the mold";
  }
  scenes.push_back({"start", "a metre below the mold", [=] { return incline(level("-1 m")); }, nullptr,
                    Verdict::refused, "below the mold"});
  scenes.push_back({"start", "falls from 0.5 m, 3 m/s",
                    [=] {
                      StressSetup setup = incline(level("500 mm"));
                      setup.scene.damping = 22;
                      setup.duration = 3;
                      return setup;
                    },
                    [](const StressRun& run) {
                      return std::vector{near("support over weight", support_over_weight(run), 1, 0.01)};
                    }});
  scenes.back().most_drift = 1e-6;
}

void add_gravity(Scenes& scenes) {
  scenes.push_back(incline_scene("gravity", "x 100, incline that sticks", 30, 0.7, 100 * kGravity));
  scenes.push_back(incline_scene("gravity", "x 100, incline that slides", 30, 0.5, 100 * kGravity, 0.1));
  StripSetup strip;
  strip.gravity = 100 * kGravity;
  scenes.push_back(strip_scene("gravity", "x 100, sag", strip, 0.02));
  scenes.back().fast = true;
  scenes.push_back({"gravity", "1e4 m/s^2 in a case", [] { return incline({"gravity=\"1e4 m/s^2\""}); },
                    nullptr, Verdict::refused, "/gravity"});
  Fall fall{parabola(0.1, 0.3)};
  scenes.push_back(fall_scene("gravity", "x 100, crest", fall));
  scenes.back().build = [fall] {
    StressSetup setup = fall_onto(fall);
    setup.scene.gravity = 100 * kGravity;
    return setup;
  };
}

/// 100 s at rest: nothing creeps.
void add_rest(Scenes& scenes) {
  constexpr double kLong = 100;  // [s]
  StripSetup strip;
  strip.along = 8, strip.across = 1;
  strip.options.mass_scaling = 1;
  scenes.push_back(strip_scene("rest of 100 s", "hinged strip", strip, 0.02));
  scenes.back().build = [strip] {
    StressSetup setup = hinged_strip(strip);
    setup.duration = kLong;
    return setup;
  };
  scenes.back().most_drift = 1e-9;
  StressScene sheet =
      incline_scene("rest of 100 s", "sheet on an incline of 30 deg, coefficient 0.7", 30, 0.7);
  sheet.build = [] { return incline({"duration=\"100 s\"", "fem.mass_scaling=100"}); };
  scenes.push_back(sheet);
}

}  // namespace

void add_mold_scenes(Scenes& scenes) {
  add_friction(scenes);
  add_curvature(scenes);
  add_walls(scenes);
  add_edges(scenes);
  add_starts(scenes);
  add_gravity(scenes);
  add_contact_stiffness(scenes);
  add_rest(scenes);
}

}  // namespace drapeplan
