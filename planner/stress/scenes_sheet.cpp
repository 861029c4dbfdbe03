// Sheets without mold and grippers: compression, thickness, meshes, ends of tables, rates, sizes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

using Scenes = std::vector<StressScene>;

/// A strip clamped at one end whose weight bends it. @return its tip's drop over its length.
double tip_drop(const StressRun& run) {
  const Mesh& mesh = run.setup.scene.mesh;
  double lower = 0, upper = 0, z = 0;
  for (size_t n = 0; n < mesh.rest.size(); ++n) {
    lower = std::min(lower, mesh.rest[n].x());
    if (mesh.rest[n].x() <= upper) continue;
    upper = mesh.rest[n].x();
    z = run.result.final.position[n].z() - run.frames.front().position[n].z();
  }
  return -z / (upper - lower);
}

/// The elastica case of the user, with overrides.
StressSetup elastica(const std::vector<std::string>& overrides) {
  return from_case(R"({
    "format": "drapeplan-case 1",
    "ply": {"width": "150 mm", "height": "25 mm"},
    "material": {"law": "linear", "thickness": "0.3 mm", "areal_density": "314 g/m^2",
      "transverse_shear_modulus": "10 MPa", "modulus": "0.69 GPa", "shear_modulus": "20 MPa"},
    "gravity": "9.81 m/s^2",
    "damping": {"by": "strip", "length": "150 mm"},
    "supports": {"clamped": ["left"]},
    "duration": "3 s",
    "fem": {"mesh_size": "6.25 mm", "mass_scaling": 1}
  })",
                   overrides);
}

StressScene elastica_scene(std::string group, std::string name, const std::vector<std::string>& overrides,
                           double beta) {
  return {std::move(group), std::move(name), [overrides] { return elastica(overrides); },
          [beta](const StressRun& run) {
            return std::vector{near("tip drop over length", tip_drop(run), elastica_drop(beta), 0.01)};
          }};
}

/// w L^3 / D of the elastica case with another modulus.
double beta_of(double modulus) {
  return 0.314 * kGravity * std::pow(0.15, 3) / (modulus * std::pow(3e-4, 3) / 12);
}

void add_compression(Scenes& scenes) {
  for (const double share : {0.0, 1e-6, 1e-3, 0.1, 1.0}) {
    StripSetup strip;
    strip.compression_share = share;
    scenes.push_back(
        strip_scene("compression", fmt::format("compression / tension {:.3g}: sag", share), strip));
    scenes.back().fast = share == 0;
  }
  // Without stiffness in compression nothing resists bending: a chain that hangs from its root.
  scenes.push_back({"compression", "none at all: a cantilever hangs down",
                    [] {
                      StressSetup setup = elastica({"fem.mass_scaling=1"});
                      const Fabric fabric = linear_fabric(0.69e9, 20e6, 10e6, 0);
                      setup.scene.fabric.compression = fabric.compression;
                      return setup;
                    },
                    [](const StressRun& run) {
                      return std::vector{near("tip drop over length", tip_drop(run), 1, 0.05)};
                    }});
}

void add_thickness(Scenes& scenes) {
  for (const double share : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    StripSetup strip;
    strip.thickness = share * strip.length;
    scenes.push_back(strip_scene("thickness", fmt::format("thickness / length {:.3g}: sag", share), strip));
    scenes.back().fast = share == 1e-1;
  }
  scenes.push_back(
      elastica_scene("thickness", "heavy elastica, thickness / length 0.002", {}, beta_of(0.69e9)));
  scenes.push_back({"thickness", "thickness 0", [] { return elastica({"material.thickness=\"0 mm\""}); },
                    nullptr, Verdict::refused, "/material/thickness"});
}

void add_meshes(Scenes& scenes) {
  for (const double aspect : {1.0, 10.0, 50.0}) {
    StripSetup strip;
    strip.width = strip.across * strip.length / strip.along / aspect;
    scenes.push_back(strip_scene("mesh", fmt::format("aspect {:.3g}, long along the warp", aspect), strip));
    StripSetup wide;
    wide.along = 50, wide.across = 1;
    wide.width = aspect * wide.length / wide.along;
    scenes.push_back(strip_scene("mesh", fmt::format("aspect {:.3g}, long along the weft", aspect), wide));
    scenes.back().fast = aspect == 50;
  }
  for (const double distortion : {0.1, 0.2, 0.3, 0.4}) {
    StripSetup strip;
    strip.across = 4;
    strip.distortion = distortion;
    scenes.push_back(
        strip_scene("mesh", fmt::format("distorted by {:.3g} of a cell", distortion), strip, 0.02));
  }
  StripSetup folded;
  folded.across = 4;
  folded.distortion = 1.2;
  scenes.push_back(strip_scene("mesh", "distorted by 1.2 of a cell: turned inside out", folded));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "element";
  scenes.push_back({"mesh", "cells larger than the ply",
                    [] {
                      return elastica({"fem.mesh_size=\"1 m\"", "duration=\"10 s\""});
                    },
                    [](const StressRun& run) {  // one element bends by the moment in its middle
                      return std::vector{StressCheck{"tip drop over length", tip_drop(run), 0.2, 1}};
                    }});
  scenes.push_back({"mesh", "every node is held",
                    [] {
                      return elastica({"supports.clamped=[\"left\",\"right\"]", "fem.mesh_size=\"1 m\""});
                    },
                    nullptr, Verdict::refused, "every node"});
  scenes.push_back({"mesh", "more cells than memory", [] { return elastica({"fem.mesh_size=\"1 um\""}); },
                    nullptr, Verdict::refused, "/fem/mesh_size"});
}

constexpr double kPulledLength = 0.06, kPulledWidth = 0.02;  // [m]

/// A strip between two clamps that are pulled apart smoothly to a strain, or by a force all at once.
StressSetup pulled_strip(const Fabric& fabric, double strain, bool at_once) {
  constexpr int kAlong = 6;
  constexpr double kWaves = 60;  // times that a wave runs along the strip
  StressSetup setup;
  Scene& scene = setup.scene;
  scene.mesh = grid_mesh(
      kAlong, 1, [](double u, double v) { return Eigen::Vector2d(u * kPulledLength, v * kPulledWidth); });
  scene.fabric = fabric;
  scene.options.mass_scaling = 1;
  const double speed =
      std::sqrt(fabric.tension.slowest().smallest_slope() * fabric.thickness / fabric.areal_density);
  scene.damping = 3 * speed / kPulledLength;  // about twice the lowest frequency
  setup.duration = kWaves * kPulledLength / speed;
  const std::vector<int> left{0, kAlong + 1}, right{kAlong, 2 * kAlong + 1};
  if (at_once) {
    scene.pinned = left;
    const double force = 0.5 * fabric.tension.slowest()(strain) * kPulledWidth * fabric.thickness;
    scene.loads = Loads{.forces = {{right[0], {force, 0, 0}}, {right[1], {force, 0, 0}}}};
    return setup;
  }
  const double ramp = 0.1 * setup.duration;  // half of it is lost
  const double velocity = strain * kPulledLength / (setup.duration - 0.5 * ramp);
  scene.grips = {{"foot", left, {0, 0, 0}, ramp}, {"head", right, {velocity, 0, 0}, ramp}};
  return setup;
}

StressScene pull_scene(std::string name, double strain, bool at_once = false) {
  StressScene scene{
      "ends of tables", std::move(name), [=] { return pulled_strip(woven_fabric(), strain, at_once); },
      [=](const StressRun& run) {
        const auto& all = run.result.final.warp_strain;
        const double mean = std::accumulate(all.begin(), all.end(), 0.0) / double(all.size());
        std::vector<StressCheck> checks{near("fibre strain", mean, strain, 0.01)};
        if (at_once) return checks;
        const double force = run.result.final.grip_force[1].x();
        checks.push_back(near("stress [Pa]", force / (kPulledWidth * run.setup.scene.fabric.thickness),
                              run.setup.scene.fabric.tension.slowest()(strain), 0.02));
        return checks;
      }};
  scene.rests = at_once;
  scene.most_strain = 2 * strain;  // under a sudden force it swings before it rests
  return scene;
}

void add_table_ends(Scenes& scenes) {
  scenes.push_back(pull_scene("tension to three times the table's end", 0.02));
  scenes.back().fast = true;
  scenes.push_back(pull_scene("tension to 15 times the table's end", 0.1));
  scenes.push_back(pull_scene("tension to 0.3: torn", 0.3));
  scenes.back().otherwise = Verdict::stopped;
  scenes.back().says = "fibre is torn";
  for (const double strain : {0.02, 0.1, 0.3}) {
    const size_t k = scenes.size() - (strain == 0.02 ? 3 : strain == 0.1 ? 2 : 1);
    scenes[k].build = [strain] {
      StressSetup setup = pulled_strip(woven_fabric(), strain, false);
      setup.scene.options.step_interval = 0;
      return setup;
    };
  }
  // The step is chosen for the strains of the moment: a blow that stiffens fibres faster needs one for all.
  scenes.push_back(pull_scene("the same within 2 ms, the step follows the strains", 0.1));
  scenes.back().otherwise = Verdict::stopped;
  scenes.back().says = "step_interval";
  scenes.push_back(pull_scene("force at once, up the curve within three steps", 0.006, true));
  scenes.back().otherwise = Verdict::stopped;
  scenes.back().says = "step_interval";
  scenes.push_back(pull_scene("the same, one step for all strains", 0.006, true));
  scenes.back().build = [] {
    StressSetup setup = pulled_strip(woven_fabric(), 0.006, true);
    setup.scene.options.step_interval = 0;
    return setup;
  };
  const std::string law =
      R"(material={"law":"tables","thickness":"0.3 mm","areal_density":"314 g/m^2",)"
      R"("transverse_shear_modulus":"10 MPa","tension":{"points":[["%","MPa"],[0,0],[END,700]]},)"
      R"("compression":{"points":[["%","MPa"],[0,0],[1,7]]},"shear":{"points":[["deg","MPa"],[0,0],[50,20]]}})";
  const auto ending = [law](const std::string& percent) {
    std::string text = law;
    return text.replace(text.find("END"), 3, percent);
  };
  scenes.push_back({"ends of tables", "a table that ends at a strain of 1e12 %",
                    [ending] {
                      return elastica({ending("1e12"), "damping={\"alpha\":\"22 1/s\"}"});
                    },
                    nullptr, Verdict::refused, "/material/tension"});
}

constexpr double kRateSide = 0.01;  // [m]

/// Two elements pulled by grips at a steady rate, with tables from 1e-15 to 1e6 per second. Their mass is
/// such that a wave crosses them a thousand times, whatever the rate.
StressSetup steady_rate(double rate) {
  constexpr double kStrain = 0.005, kModulus = 1e9, kCrossings = 1000;
  constexpr double kLongest = 0.2;  // of the simulation's clock [s]
  StressSetup setup;
  Scene& scene = setup.scene;
  scene.mesh =
      grid_mesh(2, 1, [](double u, double v) { return Eigen::Vector2d(2 * kRateSide * u, kRateSide * v); });
  scene.fabric = linear_fabric(kModulus, 1e7, 1e7);
  StressTable table;
  double factor = 1;
  for (const double at : {1e-15, 1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    table.rates.push_back(at);
    table.curves.push_back(Curve{{0, 0.01}, {0, 0.01 * kModulus * factor}});
    factor += 0.2;
  }
  scene.fabric.tension = table;
  scene.fabric.rate_floor = std::max(1e-6, 1e-2 * rate);
  scene.options.mass_scaling = 1;
  const double time = kStrain / rate;  // true [s]
  scene.options.time_scaling = std::max(1.0, time / kLongest);
  const double played = time / scene.options.time_scaling;
  scene.fabric.areal_density =
      kModulus * scene.fabric.thickness * std::pow(played / (kCrossings * 2 * kRateSide), 2);
  scene.fabric.rate_filter = 0.02 * time;
  Grip foot{"foot", {0, 3}, {0, 0, 0}, 0.1 * time},
      head{"head", {2, 5}, {2 * rate * kRateSide, 0, 0}, 0.1 * time};
  scene.grips = {foot, head};
  setup.duration = time;
  return setup;
}

void add_rates(Scenes& scenes) {
  for (const double rate : {1e-15, 1e-9, 1e-4, 1e-1, 1e2, 1e4, 1e6}) {
    StressScene scene{
        "rates", fmt::format("pulled at {:.3g} / s", rate), [rate] { return steady_rate(rate); },
        [rate](const StressRun& run) {
          const Fabric& fabric = run.setup.scene.fabric;
          const double strain = run.result.final.warp_strain[0];
          const double right = fabric.tension(strain, rate, fabric.rate_floor);
          const double force = run.result.final.grip_force[1].x();
          return std::vector{near("stress [Pa]", force / (kRateSide * fabric.thickness), right, 0.02),
                             StressCheck{"strain", strain, 0.004, 0.006}};
        }};
    scene.rests = false;
    scene.fast = rate == 1e-15;
    scenes.push_back(scene);
  }
}

void add_sizes(Scenes& scenes) {
  const auto fall = [](int cells, double duration) {
    StressSetup setup;
    setup.scene.mesh = rectangle_mesh(0.005 * cells, 0.005 * cells, 0.005);
    setup.scene.fabric = woven_fabric();
    setup.scene.options.mass_scaling = 1;
    setup.scene.gravity = kGravity;
    setup.duration = duration;
    return setup;
  };
  const auto falls = [](const StressRun& run) {
    const double way = 0.5 * kGravity * std::pow(run.setup.duration, 2);
    double lowest = 0, highest = -1e300;
    for (const Eigen::Vector3d& x : run.result.final.position) {
      lowest = std::min(lowest, x.z());
      highest = std::max(highest, x.z());
    }
    return std::vector{near("fall [m]", -mean_displacement(run).z(), way, 1e-2),
                       at_most("height differences [m]", highest - lowest, 1e-9 * way)};
  };
  for (const auto& [cells, duration] : {std::pair{1, 0.1}, {200, 1e-3}}) {
    const std::string size = fmt::format("{0} x {0} elements fall freely", cells);
    scenes.push_back({"size", size, [fall, c = cells, d = duration] { return fall(c, d); }, falls});
    scenes.back().rests = false;
    scenes.back().fast = cells == 1;
  }
  StripSetup row;
  row.across = 1;
  scenes.push_back(strip_scene("size", "one row", row));
  StripSetup two;
  two.along = 2, two.across = 1;
  scenes.push_back(strip_scene("size", "two elements", two, 0.1));  // coarse: a triangle for a parabola
  StripSetup many;
  many.along = 100, many.across = 1, many.width = 3e-3;
  many.options.mass_scaling = 1;
  scenes.push_back(strip_scene("size", "one row of 100", many));
}

}  // namespace

void add_sheet_scenes(Scenes& scenes) {
  add_compression(scenes);
  add_thickness(scenes);
  add_meshes(scenes);
  add_table_ends(scenes);
  add_rates(scenes);
  add_sizes(scenes);
}

}  // namespace drapeplan
