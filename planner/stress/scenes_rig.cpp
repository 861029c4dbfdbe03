// Drapes with grippers: speeds, stops, impossible geometry, forces, releases.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

using Scenes = std::vector<StressScene>;

/// Largest distance of joints from where the schedule ends [m].
double off_command(const StressRun& run) {
  double off = 0;
  for (size_t g = 0; g < run.result.final.joint.size(); ++g)
    off = std::max(off, std::abs(run.result.final.joint[g].z() - run.setup.schedule->paths[g].back().z));
  return off;
}

/// A case of 2 x 2 grippers as a user writes it.
StressSetup small_rig(const std::vector<std::string>& overrides) {
  return from_case(R"({
    "format": "drapeplan-case 1",
    "ply": {"width": "160 mm", "height": "160 mm", "position": ["100 mm", "100 mm"]},
    "material": {"law": "linear", "thickness": "0.3 mm", "areal_density": "314 g/m^2",
      "transverse_shear_modulus": "0.2 MPa", "modulus": "1 GPa", "shear_modulus": "0.5 MPa"},
    "mold": {"shape": "sphere", "extent": [["0 mm", "200 mm"], ["0 mm", "200 mm"]],
      "centre": ["100 mm", "100 mm", "-500 mm"], "radius": "600 mm"},
    "friction": {"coefficient": 0.5},
    "mapping": {"generators": "mid_sides"},
    "grippers": {"columns": 2, "rows": 2, "spacing": "110 mm", "joint_offset": "2 mm"},
    "gravity": "9.81 m/s^2",
    "damping": {"alpha": "200 1/s"},
    "schedule": {"settle": "5 s"},
    "fem": {"mesh_size": "14 mm", "mass_scaling": 4, "time_scaling": 10}
  })",
                   overrides);
}

void add_cases(Scenes& scenes) {
  scenes.push_back({"gripper speed", "a case", [] { return small_rig({}); },
                    [](const StressRun& run) { return std::vector{weight_carried(run)}; }});
  scenes.back().most_drift = 1e-4;
  const auto refuse = [&scenes](std::string group, std::string name, std::string setting, std::string place) {
    scenes.push_back({std::move(group), std::move(name), [setting] { return small_rig({setting}); }, nullptr,
                      Verdict::refused, std::move(place)});
  };
  refuse("gripper speed", "at most 0 m/s in a case", "grippers.max_velocity=\"0 m/s\"",
         "/grippers/max_velocity");
  refuse("actuator force", "limit 0 in a case", "grippers.actuator_force_limit=\"0 N\"",
         "/grippers/actuator_force_limit");
  refuse("interlinks", "pads that overlap in a case", "grippers.pad_radius=\"60 mm\"", "/grippers/spacing");
  refuse("interlinks", "grippers off the ply in a case", "grippers.spacing=\"400 mm\"", "/grippers/spacing");
  refuse("interlinks", "a table of lengths of another grid",
         "grippers.interlinks={\"length\":[[[\"100 mm\"]],[]]}", "/grippers/interlinks/length/0");
  refuse("interlinks", "a stiffness below 0", "grippers.interlinks={\"stiffness\":\"-1 N/m\"}",
         "/grippers/interlinks/stiffness");
  refuse("interlinks", "a closing that ends before it begins", "grippers.interlinks={\"closing\":[1,0]}",
         "/grippers/interlinks/closing");
  refuse("interlinks", "a spacing of 0 in a case", "grippers.spacing=\"0 mm\"", "/grippers/spacing");
  scenes.push_back(
      {"gripper speed", "a preshape and strokes of 1 ms in a case: stretched to 0.2 m/s",
       [] {
         return small_rig({"schedule.preshape_duration=\"1 ms\"", "schedule.uniform.duration=\"1 ms\""});
       },
       [](const StressRun& run) {
         std::vector<StressCheck> checks{weight_carried(run)};
         checks.push_back(at_most("speed [m/s]", run.setup.schedule->largest_velocity(), 0.2001));
         return checks;
       }});
  scenes.back().most_drift = 1e-4;
}

void add_speeds(Scenes& scenes) {
  scenes.push_back(drape_scene("gripper speed", "as usual", [](StressSetup&) {}));
  for (const double speed : {10.0, 100.0, 1e4}) {
    scenes.push_back(drape_scene("gripper speed", fmt::format("x {:.3g}", speed),
                                 [speed](StressSetup& s) { s.schedule = lay_down(s.scene, 0, speed); }));
    scenes.back().fast = speed == 100;
  }
  // Back up before it touches, at once: the ply hangs from the pads again.
  const auto up = [](const StressRun& run) {
    std::vector<StressCheck> checks{weight_carried(run)};
    checks.push_back(at_most("joints off their command [m]", off_command(run), 1e-4));
    return checks;
  };
  scenes.push_back(drape_scene("gripper speed", "reversed in the air, at once", [](StressSetup& s) {
    s.schedule->blend_time = 0;
    for (auto& path : s.schedule->paths) {
      const double top = path[0].z;
      path = {{0, top}, {1, top - 0.1}, {2, top}, {17, top}};
    }
    s.scene.mold.reset();
    s.scene.friction.reset();
  }));
  scenes.back().judge = up;
  scenes.push_back(drape_scene("gripper speed", "reversed on the mold", [](StressSetup& s) {
    for (auto& path : s.schedule->paths) {
      const double top = path[0].z, end = path[2].z;
      path = {{0, top}, {2, end}, {2.5, top + 0.1}, {17, top + 0.1}};
    }
  }));
  scenes.back().judge = up;
  scenes.push_back(drape_scene("gripper speed", "stopped at once from 0.2 m/s", [](StressSetup& s) {
    s.schedule->blend_time = 0;
    for (auto& path : s.schedule->paths)
      path = {{0, path[0].z}, {0.5, path[0].z + 0.1}, {15, path[0].z + 0.1}};
  }));
  scenes.back().judge = up;
  scenes.push_back(drape_scene("gripper speed", "jumps: two knots at one time", [](StressSetup& s) {
    s.schedule->paths[0][2].time = s.schedule->paths[0][1].time;
  }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "times";
  scenes.push_back(drape_scene("gripper speed", "a knot at no finite height", [](StressSetup& s) {
    s.schedule->paths[0][2].z = std::numeric_limits<double>::quiet_NaN();
  }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "finite";
}

/// How far the interlink that is nearest to a stop is beyond it at the end [m]; < 0 between them.
double beyond_stops(const StressRun& run) {
  const RigOptions& rig = *run.setup.scene.rig;
  double most = -std::numeric_limits<double>::infinity();
  const auto pairs = interlinks(rig);
  for (size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const std::vector<Eigen::Vector3d>& joints = run.result.final.joint;
    const double over = (joints[size_t(i)] - joints[size_t(j)]).norm() - interlink_length(rig, k);
    most = std::max({most, over - rig.interlinks->play[1], -over - rig.interlinks->play[0]});
  }
  return most;
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
      s.schedule->paths[g] = {{0, z}, {19, z}};
    }
  };
  scenes.push_back(drape_scene("interlinks", "cannot reach: 300 mm of height for a link of 120 mm", torn));
  scenes.back().fast = true;
  scenes.push_back(drape_scene("interlinks", "the same with actuators of any force", [torn](StressSetup& s) {
    torn(s);
    s.scene.rig->actuator_force_limit = std::numeric_limits<double>::infinity();
  }));
  scenes.back().most_shortening = 0.2;  // the ply between pads that links pull together is crushed
  scenes.back().otherwise = Verdict::stopped;
  scenes.back().says = "sheared by more than";
  scenes.push_back(drape_scene("interlinks", "the same with play of 5 mm", [torn](StressSetup& s) {
    torn(s);
    s.scene.rig->interlinks->play = {0.005, 0.005};
  }));
  scenes.back().judge = [judge = scenes.back().judge](const StressRun& run) {
    std::vector<StressCheck> checks = judge(run);
    checks.push_back({"beyond its stops [m]", beyond_stops(run), -1e-9, 1e-9});
    return checks;
  };
  scenes.push_back(
      drape_scene("interlinks", "pads of 1 g", [](StressSetup& s) { s.scene.rig->pad_mass = 1e-3; }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "actuators are too stiff";
  scenes.push_back(drape_scene("interlinks", "tilt limit of 0.001 deg",
                               [](StressSetup& s) { s.scene.rig->tilt_limit = 1e-3 * kDegree; }));
  // Pads that may not tilt stand on single nodes and chatter there against the stop: at the highest frequency
  // that a step can play, 2 / dt, an amplitude of a nanometre shows as this force.
  scenes.back().judge = [](const StressRun& run) {
    constexpr double kAmplitude = 1e-9;  // [m]
    const RigOptions& rig = *run.setup.scene.rig;
    const double rate = 2 / run.result.summary.dt;
    const double missing = std::abs(support_over_weight(run) - 1) * weight_of(run.setup.scene);
    return std::vector{at_most("weight not carried, in chatter [N]", missing,
                               rig.count() * rig.pad_mass * rate * rate * kAmplitude)};
  };
  scenes.push_back(drape_scene("interlinks", "joints 200 mm above pads of 20 mm", [](StressSetup& s) {
    s.scene.rig->joint_offset = 0.2;
    s.schedule = lay_down(s.scene);
  }));
  scenes.back().rests = false;  // long arms under light pads swing on
  scenes.back().judge = nullptr;
}

/// A drape with interlinks of another kind.
StressScene link_scene(const std::string& name, const std::function<void(InterlinkOptions&)>& change,
                       double speed = 1) {
  StressScene scene = drape_scene("interlinks", name, [change, speed](StressSetup& s) {
    change(*s.scene.rig->interlinks);
    if (speed != 1) s.schedule = lay_down(s.scene, 0, speed);
  });
  scene.judge = [judge = scene.judge](const StressRun& run) {
    std::vector<StressCheck> checks = judge ? judge(run) : std::vector<StressCheck>();
    if (!run.setup.scene.rig->interlinks->stiffness)
      checks.push_back(at_most("beyond its stops [m]", beyond_stops(run), 1e-9));
    return checks;
  };
  return scene;
}

void add_soft_links(Scenes& scenes) {
  for (const double speed : {1.0, 100.0}) {
    scenes.push_back(link_scene(
        fmt::format("play of 0.2 mm, stops hit at speed x {:.3g}", speed),
        [](InterlinkOptions& o) {
          o.play = {2e-4, 2e-4};
        },
        speed));
  }
  scenes.back().fast = true;
  for (const double stiffness : {0.0, 1e3, 1e6, 1e12, 1e30}) {
    scenes.push_back(link_scene(fmt::format("springs of {:.3g} N/m", stiffness),
                                [stiffness](InterlinkOptions& o) { o.stiffness = stiffness; }));
  }
  scenes.push_back(link_scene("stops on springs of 1e12 N/m, play of 0.2 mm", [](InterlinkOptions& o) {
    o.stiffness = 1e12;
    o.play = {2e-4, 2e-4};
  }));
  const auto closing = [](std::vector<double> lengths) {
    return [lengths = std::move(lengths)](InterlinkOptions& o) {
      o.lengths = lengths;
      o.closing = {0, 2};
    };
  };
  scenes.push_back(link_scene("closing by 2 %", closing(std::vector(4, 0.1176))));
  // The ply between pads that come 60 mm closer can go nowhere: it is crushed, or folds past its shear.
  scenes.push_back(link_scene("closing to half", closing(std::vector(4, 0.06))));
  scenes.back().otherwise = Verdict::stopped;
  scenes.back().says = "sheared by more than";
  scenes.push_back(link_scene("lengths that no quadrangle has", closing({0.1, 0.1, 0.1, 0.5})));
  scenes.back().otherwise = Verdict::stopped;
  scenes.back().says = "a fibre is torn";
  scenes.push_back(
      link_scene("lengths without time to close", [](InterlinkOptions& o) { o.lengths.assign(4, 0.11); }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "needs time";
}

void add_forces(Scenes& scenes) {
  scenes.push_back(drape_scene("actuator force", "limit 0: nothing holds the rig",
                               [](StressSetup& s) { s.scene.rig->actuator_force_limit = 0; }));
  // The ply's weight draws pads, which have none, down against mass damping: W / (alpha M).
  scenes.back().rests = false;
  scenes.back().judge = [](const StressRun& run) {
    const Scene& scene = run.setup.scene;
    const double ply = weight_of(scene) / kGravity * scene.options.mass_scaling;
    const double mass = ply + scene.rig->count() * scene.rig->pad_mass;
    const Snapshot &before = run.frames[run.frames.size() - 2], &after = run.frames.back();
    const double time = (after.time - before.time) / scene.options.time_scaling;
    const double speed = (before.pad[0].z() - after.pad[0].z()) / time;
    return std::vector{near("sinks with [m/s]", speed, weight_of(scene) / (run.model.alpha() * mass), 0.03)};
  };
  scenes.push_back(drape_scene("actuator force", "no limit, 20 mm into the mold", [](StressSetup& s) {
    s.scene.rig->actuator_force_limit = std::numeric_limits<double>::infinity();
    s.schedule = lay_down(s.scene, 0.02);
  }));
  scenes.push_back(drape_scene("actuator force", "1000 N a pad, 0.5 m into the mold", [](StressSetup& s) {
    s.scene.rig->actuator_force_limit = 1e3;
    s.schedule = lay_down(s.scene, 0.5);
  }));
  for (size_t k = scenes.size() - 2; k < scenes.size(); ++k) {
    scenes[k].otherwise = Verdict::stopped;
    scenes[k].says = "inside the mold";
  }
  scenes.push_back(drape_scene("actuator force", "stiffness 1e9 N/m",
                               [](StressSetup& s) { s.scene.rig->actuator_stiffness = 1e9; }));
  scenes.back().otherwise = Verdict::refused;
  scenes.back().says = "actuators are too stiff";
}

void add_releases(Scenes& scenes) {
  for (const auto& [name, time] : {std::pair{"all pads let go on the mold", 6.0},
                                   {"all pads let go in the air", 1.0},
                                   {"at the first step", 0.0}}) {
    scenes.push_back(
        drape_scene("release", name, [t = time](StressSetup& s) { s.schedule->release.assign(4, t); }));
    // Without pads the ply goes on to slide, slowly against mass damping, which bears some of it.
    scenes.back().judge = [](const StressRun& run) { return std::vector{weight_carried(run, 0.1)}; };
    scenes.back().most_drift = 2e-3;
  }
  // Contact springs sized for a pad once stayed on its light nodes: the end then hung on the step.
  scenes.push_back(drape_scene("release", "one pad lets go on the mold: as with a quarter of the step",
                               [](StressSetup& s) {
                                 s.schedule->release.assign(4, std::nullopt);
                                 s.schedule->release[3] = 6.0;
                               }));
  scenes.back().judge = [](const StressRun& run) {
    return std::vector{weight_carried(run), at_most("apart [m]", apart_from(run, safer(run)), 5e-4)};
  };
  scenes.back().most_drift = 1e-3;
}

void add_gravity_and_friction(Scenes& scenes) {
  scenes.push_back(
      drape_scene("gravity", "x 100, drape", [](StressSetup& s) { s.scene.gravity = 100 * kGravity; }));
  scenes.push_back(
      drape_scene("friction", "drape, coefficient 0", [](StressSetup& s) { s.scene.friction = 0; }));
  scenes.back().most_drift = 1e-3;  // nothing but mass damping ends its sliding
  scenes.push_back(
      drape_scene("friction", "drape, coefficient 1000", [](StressSetup& s) { s.scene.friction = 1000; }));
  scenes.push_back(
      drape_scene("mold edge", "edge inside the ply, which may not slide on", [](StressSetup& s) {
        s.scene.mold = Mold(s.scene.mold->shape(), {{0, 0}, {0.15, 0.15}});
      }));
  scenes.push_back({"mold edge", "edge inside the mapped ply",
                    [] { return small_rig({"mold.extent=[[\"0 mm\",\"150 mm\"],[\"0 mm\",\"150 mm\"]]"}); },
                    [](const StressRun& run) {
                      return std::vector{StressCheck{"warnings", double(run.setup.warnings.size()), 1, 3}};
                    }});
  scenes.back().rests = false;
}

}  // namespace

void add_rig_scenes(Scenes& scenes) {
  add_speeds(scenes);
  add_links(scenes);
  add_soft_links(scenes);
  add_forces(scenes);
  add_releases(scenes);
  add_cases(scenes);
  add_gravity_and_friction(scenes);
}

}  // namespace drapeplan
