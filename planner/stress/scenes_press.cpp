// Plies that are pressed: from no pressure to far beyond an autoclave, at once, in the air, with pads let go.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

using Scenes = std::vector<StressScene>;

/// R.m.s. distance of the last positions to those before pressing [m].
double moved_by_press(const StressRun& run) {
  if (!run.result.unpressed) return std::nan("");
  double sum = 0;
  const auto &a = run.result.final.position, &b = run.result.unpressed->position;
  for (size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]).squaredNorm();
  return std::sqrt(sum / double(a.size()));
}

StressScene press_scene(std::string name, double pressure,
                        std::function<void(StressSetup&)> change = nullptr) {
  StressScene scene = drape_scene("press", std::move(name), [=](StressSetup& s) {
    s.scene.press = Press{.pressure = pressure, .duration = 4};
    if (change) change(s);
  });
  scene.judge = pressed_down;
  return scene;
}

void add_pressures(Scenes& scenes) {
  scenes.push_back(press_scene("0 Pa: stays as it lies", 0));
  scenes.back().judge = [](const StressRun& run) {
    return std::vector{weight_carried(run), at_most("moved [m]", moved_by_press(run), 1e-4)};
  };
  for (const double pressure : {10.0, 1e3, 3e4, 1e5, 3e5, 1e6, 1e7}) {
    scenes.push_back(press_scene(fmt::format("{:.3g} Pa", pressure), pressure));
    scenes.back().fast = pressure == 1e6;
  }
  for (const auto& [name, pressure] : {std::pair{"a negative pressure", -1.0},
                                       {"a pressure that is no number", std::nan("")},
                                       {"infinite pressure", std::numeric_limits<double>::infinity()}}) {
    scenes.push_back(press_scene(name, pressure));
    scenes.back().otherwise = Verdict::refused;
    scenes.back().says = "press";
  }
}

void into_the_air(StressSetup& setup) {
  setup.scene.mold.reset();
  setup.scene.friction.reset();
}

void add_ways(Scenes& scenes) {
  scenes.push_back(
      press_scene("0.1 MPa within 1 ms", 1e5, [](StressSetup& s) { s.scene.press->ramp = 1e-3; }));
  scenes.push_back(press_scene("30 kPa while it is still being laid down", 3e4, [](StressSetup& s) {
    s.scene.press->delay = 0;
    for (auto& path : s.schedule->paths) path[2].time -= 1;
  }));
  scenes.push_back(press_scene("30 kPa, all pads let go at full pressure", 3e4, [](StressSetup& s) {
    s.schedule->release.assign(4, s.schedule->duration() + s.scene.press->ramp);
  }));
  scenes.push_back(press_scene("30 kPa without friction", 3e4, [](StressSetup& s) { s.scene.friction = 0; }));
  scenes.back().most_drift = 2e-3;  // nothing but mass damping ends its sliding
  // Actuators bear it all; nothing keeps it from sailing away sideways.
  scenes.push_back(press_scene("300 Pa in the air", 300, into_the_air));
  scenes.back().rests = false;
  scenes.back().judge = [](const StressRun& run) {
    const double weight = weight_of(run.setup.scene);
    return std::vector{near("forces that bear the ply [N]", support_over_weight(run) * weight,
                            weight + 300 * covered_area(run.setup.scene.mesh, run.result.final), 0.02)};
  };
  scenes.push_back(
      press_scene("0.1 MPa in the air: falls against all that actuators hold", 1e5, into_the_air));
  scenes.back().rests = false;
  scenes.back().judge = [](const StressRun& run) {
    return std::vector{near("forces that bear the ply [N]",
                            support_over_weight(run) * weight_of(run.setup.scene),
                            4 * run.setup.scene.rig->actuator_force_limit, 1e-9)};
  };
}

}  // namespace

void add_press_scenes(Scenes& scenes) {
  add_pressures(scenes);
  add_ways(scenes);
}

}  // namespace drapeplan
