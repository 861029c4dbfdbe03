// Plies that stick: tack from nothing to more than any glue, on a drape that is let go, and on one that is
// held.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

using Scenes = std::vector<StressScene>;

/// When the pads of corner_drape() let go, after the press [s].
constexpr double kLetGo = 17;

/// R.m.s. way of the nodes from the instant at which the pads let go to the end [m].
double springback(const StressRun& run) {
  const Snapshot* before = nullptr;
  for (const Snapshot& frame : run.frames) {
    if (frame.time <= kLetGo) before = &frame;
  }
  double sum = 0;
  const auto& end = run.result.final.position;
  for (size_t n = 0; n < end.size(); ++n) sum += (end[n] - before->position[n]).squaredNorm();
  return std::sqrt(sum / double(end.size()));
}

/// Laid down, then let go under its own weight.
StressScene released(std::string name, double stress, double most_way) {
  StressScene scene = drape_scene("tack", std::move(name), [stress](StressSetup& s) {
    s.scene.tack = Tack{.stress = stress};
    for (auto& path : s.schedule->paths) path.push_back({2 * kLetGo, path.back().z});
    s.schedule->release.assign(4, kLetGo);
  });
  scene.judge = [most_way](const StressRun& run) {
    return std::vector{weight_carried(run, 0.1),
                       at_most("way after letting go [m]", springback(run), most_way)};
  };
  scene.most_drift = 2e-3;
  return scene;
}

void add_releases(Scenes& scenes) {
  constexpr double kAnyWay = 1, kStays = 2e-3;  // [m]: what still hangs between the places that stick moves
  scenes.push_back(released("0: let go", 0, kAnyWay));
  for (const double stress : {10.0, 1e3})
    scenes.push_back(released(fmt::format("{:.3g}", stress) + " Pa: let go", stress, kAnyWay));
  for (const double stress : {1e4, 1e5, 1e6, 1e8}) {
    scenes.push_back(released(fmt::format("{:.3g}", stress) + " Pa: let go, stays", stress, kStays));
    scenes.back().fast = stress == 1e5;
  }
  for (const auto& [name, stress] : {std::pair{"a negative stress", -1.0},
                                     {"a stress that is no number", std::nan("")},
                                     {"infinite stress", std::numeric_limits<double>::infinity()}}) {
    scenes.push_back(released(name, stress, kAnyWay));
    scenes.back().otherwise = Verdict::refused;
    scenes.back().says = "tack";
  }
}

void add_ways(Scenes& scenes) {
  // What has stuck is torn off again: at the end nothing touches.
  const auto lift = [](std::string name, double stress) {
    StressScene scene = drape_scene("tack", std::move(name), [stress](StressSetup& s) {
      s.scene.tack = Tack{.stress = stress};
      for (auto& path : s.schedule->paths) {
        const double top = path[0].z, end = path[2].z;
        path = {{0, top}, {2, end}, {4, end}, {6, top + 0.1}, {16, top + 0.1}};
      }
    });
    return scene;
  };
  scenes.push_back(lift("1 kPa: lifted off again", 1e3));
  scenes.push_back(lift("10 kPa: lifted off again", 1e4));
  scenes.push_back(lift("100 MPa: more than actuators can lift off", 1e8));
  scenes.back().judge = [](const StressRun& run) {
    double off = 1;  // [m]
    for (size_t g = 0; g < run.result.final.joint.size(); ++g)
      off = std::min(off, run.setup.schedule->paths[g].back().z - run.result.final.joint[g].z());
    return std::vector{weight_carried(run), StressCheck{"joints below their command [m]", off, 0.09, 0.2}};
  };
  scenes.push_back(drape_scene("tack", "30 kPa, pressed with 0.1 MPa, let go", [](StressSetup& s) {
    s.scene.tack = Tack{.stress = 3e4};
    s.scene.press = Press{.pressure = 1e5, .duration = 4};
    s.schedule->release.assign(4, s.schedule->duration() + 2);
  }));
  scenes.back().judge = pressed_down;
  scenes.push_back({"tack", "without friction in a case",
                    [] {
                      return from_case(R"({
    "format": "drapeplan-case 1",
    "ply": {"width": "60 mm", "height": "40 mm", "start": "on_mold"},
    "material": {"law": "linear", "thickness": "0.3 mm", "areal_density": "314 g/m^2",
      "transverse_shear_modulus": "0.2 MPa", "modulus": "1 GPa", "shear_modulus": "0.5 MPa"},
    "mold": {"shape": "plane", "extent": [["-0.2 m", "0.2 m"], ["-0.2 m", "0.2 m"]]},
    "friction": {"tack": "30 kPa"}, "duration": "1 s"})");
                    },
                    nullptr, Verdict::refused, "/friction"});
}

}  // namespace

void add_tack_scenes(Scenes& scenes) {
  add_releases(scenes);
  add_ways(scenes);
}

}  // namespace drapeplan
