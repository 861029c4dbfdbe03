// Drapes with grippers: speeds, stops, impossible geometry, forces, releases.
#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/stress_kit.hpp"

namespace drapeplan {
namespace {

using Scenes = std::vector<StressScene>;

/// At rest actuators and mold bear the ply, whatever its shape.
std::vector<StressCheck> borne(const StressRun& run) {
  return {near("support over weight", support_over_weight(run), 1, 0.02)};
}

/// Largest distance of joints from where the schedule ends [m].
double off_command(const StressRun& run) {
  double off = 0;
  for (size_t g = 0; g < run.result.final.joint.size(); ++g)
    off = std::max(off, std::abs(run.result.final.joint[g].z() - run.setup.schedule->paths[g].back().z));
  return off;
}

StressScene drape(std::string group, std::string name, std::function<void(StressSetup&)> change) {
  StressScene scene{std::move(group), std::move(name),
                    [change] {
                      StressSetup setup = corner_drape();
                      change(setup);
                      return setup;
                    },
                    borne};
  scene.most_drift = 1e-4;
  return scene;
}

void add_speeds(Scenes& scenes) {
  scenes.push_back(drape("gripper speed", "as usual", [](StressSetup&) {}));
  for (const double speed : {10.0, 100.0, 1e4}) {
    scenes.push_back(drape("gripper speed", "x " + number_text(speed),
                           [speed](StressSetup& s) { s.schedule = lay_down(s.scene, 0, speed); }));
    scenes.back().fast = speed == 100;
  }
  // Back up before it touches, at once: the ply hangs from the pads again.
  const auto up = [](const StressRun& run) {
    std::vector<StressCheck> checks = borne(run);
    checks.push_back(at_most("joints off their command [m]", off_command(run), 1e-4));
    return checks;
  };
  scenes.push_back(drape("gripper speed", "reversed in the air, at once", [](StressSetup& s) {
    s.schedule->blend_time = 0;
    for (auto& path : s.schedule->paths) {
      const double top = path[0].z;
      path = {{0, top}, {1, top - 0.1}, {2, top}, {7, top}};
    }
    s.scene.mold.reset();
    s.scene.friction.reset();
  }));
  scenes.back().judge = up;
  scenes.push_back(drape("gripper speed", "reversed on the mold", [](StressSetup& s) {
    for (auto& path : s.schedule->paths) {
      const double top = path[0].z, end = path[2].z;
      path = {{0, top}, {2, end}, {2.5, top + 0.1}, {7, top + 0.1}};
    }
  }));
  scenes.back().judge = up;
  scenes.push_back(drape("gripper speed", "stopped at once from 0.2 m/s", [](StressSetup& s) {
    s.schedule->blend_time = 0;
    for (auto& path : s.schedule->paths)
      path = {{0, path[0].z}, {0.5, path[0].z + 0.1}, {5, path[0].z + 0.1}};
  }));
  scenes.back().judge = up;
  scenes.push_back(drape("gripper speed", "jumps: two knots at one time", [](StressSetup& s) {
    s.schedule->paths[0][2].time = s.schedule->paths[0][1].time;
  }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "times";
  scenes.push_back(drape("gripper speed", "a knot at no finite height", [](StressSetup& s) {
    s.schedule->paths[0][2].z = std::numeric_limits<double>::quiet_NaN();
  }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "finite";
}

void add_links(Scenes& scenes) {
  // Neighbours 120 mm apart are sent 300 mm apart in height: links stand upright, actuators pull in vain.
  const auto torn = [](StressSetup& s) {
    s.scene.mold.reset();
    s.scene.friction.reset();
    s.schedule->paths[0] = {{0, s.schedule->paths[0][0].z},
                            {4, s.schedule->paths[0][0].z + 0.3},
                            {9, s.schedule->paths[0][0].z + 0.3}};
    for (size_t g = 1; g < 4; ++g) {
      const double z = s.schedule->paths[g][0].z;
      s.schedule->paths[g] = {{0, z}, {9, z}};
    }
  };
  scenes.push_back(drape("interlinks", "cannot reach: 300 mm of height for a link of 120 mm", torn));
  scenes.back().fast = true;
  scenes.push_back(drape("interlinks", "the same with actuators of any force", [torn](StressSetup& s) {
    torn(s);
    s.scene.rig->actuator_force_limit = std::numeric_limits<double>::infinity();
  }));
  scenes.push_back(drape("interlinks", "pads of 1 g", [](StressSetup& s) { s.scene.rig->pad_mass = 1e-3; }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "actuators are too stiff";
  scenes.push_back(drape("interlinks", "tilt limit of 0.001 deg",
                         [](StressSetup& s) { s.scene.rig->tilt_limit = 1e-3 * kDegree; }));
  scenes.push_back(drape("interlinks", "joints 200 mm above pads of 20 mm", [](StressSetup& s) {
    s.scene.rig->joint_offset = 0.2;
    s.schedule = lay_down(s.scene);
  }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "actuators are too stiff";
}

void add_forces(Scenes& scenes) {
  scenes.push_back(drape("actuator force", "limit 0: nothing holds the rig",
                         [](StressSetup& s) { s.scene.rig->actuator_force_limit = 0; }));
  scenes.push_back(drape("actuator force", "no limit, 20 mm into the mold", [](StressSetup& s) {
    s.scene.rig->actuator_force_limit = std::numeric_limits<double>::infinity();
    s.schedule = lay_down(s.scene, 0.02);
  }));
  scenes.push_back(drape("actuator force", "1000 N a pad, 0.5 m into the mold", [](StressSetup& s) {
    s.scene.rig->actuator_force_limit = 1e3;
    s.schedule = lay_down(s.scene, 0.5);
  }));
  for (size_t k = scenes.size() - 2; k < scenes.size(); ++k) {
    scenes[k].otherwise = Verdict::stopped;
    scenes[k].says = "inside the mold";
  }
  scenes.push_back(drape("actuator force", "stiffness 1e9 N/m",
                         [](StressSetup& s) { s.scene.rig->actuator_stiffness = 1e9; }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "actuators are too stiff";
}

void add_releases(Scenes& scenes) {
  scenes.push_back(drape("release", "all pads let go on the mold",
                         [](StressSetup& s) { s.schedule->release.assign(4, 6.0); }));
  scenes.push_back(drape("release", "all pads let go in the air",
                         [](StressSetup& s) { s.schedule->release.assign(4, 1.0); }));
  scenes.push_back(
      drape("release", "at the first step", [](StressSetup& s) { s.schedule->release.assign(4, 0.0); }));
}

void add_gravity_and_friction(Scenes& scenes) {
  scenes.push_back(
      drape("gravity", "x 100, drape", [](StressSetup& s) { s.scene.gravity = 100 * kGravity; }));
  scenes.push_back(drape("friction", "drape, coefficient 0", [](StressSetup& s) { s.scene.friction = 0; }));
  scenes.push_back(
      drape("friction", "drape, coefficient 1000", [](StressSetup& s) { s.scene.friction = 1000; }));
  scenes.push_back(drape("mold edge", "edge inside the draped ply", [](StressSetup& s) {
    s.scene.mold = Mold(s.scene.mold->shape(), {{0, 0}, {0.15, 0.15}});
  }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "extent";
}

}  // namespace

void add_rig_scenes(Scenes& scenes) {
  add_speeds(scenes);
  add_links(scenes);
  add_forces(scenes);
  add_releases(scenes);
  add_gravity_and_friction(scenes);
}

}  // namespace drapeplan
