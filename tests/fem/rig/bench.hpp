// A rig by itself: what the tests of rigs, interlinks and stops share.
#pragma once

#include <optional>
#include <vector>

#include "fem/rig/gripper_rig.hpp"

namespace drapeplan::test {

/// A rig without a ply: one node of no mass under each pad. Forces go to the pads' centres.
struct RigBench {
  RigOptions options;
  Schedule schedule;
  std::optional<GripperRig> rig;
  State state;
  RigScratch scratch;
  VectorField force, moment, mean_v, mean_w;
  double dt = 1e-5;  // [s]

  void build() {
    std::vector<Eigen::Vector2d> nodes;
    for (int g = 0; g < options.count(); ++g) nodes.push_back(options.place(g));
    const std::vector<double> none(nodes.size(), 0.0);
    rig.emplace(options, nodes, none, none, nodes, 0.0);
    const int count = options.count();
    state = {};
    state.position = state.velocity = state.director = state.director_rate = VectorField(count);
    rig->place(state, 0);
    scratch = rig->scratch();
    force = moment = mean_v = mean_w = VectorField(count);
    rig->drift(state);  // with a step of 0, nodes take their places
    if (!schedule.paths.empty()) return;
    schedule.paths.assign(size_t(count), {{0, options.joint_offset}});
    schedule.blend_time = 0.1;
  }
  void step() {
    state.dt = state.dt_before = dt;
    rig->let_go(state, {&schedule, 1});
    rig->kick(state, {&schedule, 1}, 0, {force, moment, mean_v, mean_w}, scratch);
    rig->drift(state);
    state.time = double(++state.step) * dt;
  }
};

}  // namespace drapeplan::test
