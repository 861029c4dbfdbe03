// Drapes with a rig over the article's mold, coarse and fast, that several tests share.
#pragma once

#include <algorithm>

#include "fem/rig/schedule.hpp"
#include "tests/fem/run/scenes.hpp"
#include "tests/mapping/molds.hpp"

namespace drapeplan::test {

/// A square woven ply under a square grid of grippers with interlinks; weight, damping, mold and friction.
inline Scene rig_drape(int columns, double spacing, double joint_offset, double side, double mesh_size,
                       double place) {
  Scene scene;
  RigOptions rig;
  rig.columns = rig.rows = columns;
  rig.spacing = spacing;
  rig.joint_offset = joint_offset;
  scene.rig = rig;
  scene.mesh =
      rectangle_mesh(side, side, mesh_size, column_places(rig, mesh_size), row_places(rig, mesh_size));
  scene.fabric = woven_fabric();
  scene.options.mass_scaling = 50;
  scene.options.time_scaling = 20;
  scene.position = {place, place};
  scene.gravity = 9.81;
  scene.damping = 22;
  scene.mold = article_mold();
  scene.friction = 1.5;
  return scene;
}

/// 3x3 grippers on the middle of the mold, the middle one fixed.
inline Scene middle_drape(double side, double mesh_size) {
  Scene scene = rig_drape(3, 0.1, 0.002, side, mesh_size, 0.225);
  scene.rig->fixed = {2, 2};
  return scene;
}

/// 2x2 grippers over the lower left corner of the mold.
inline Scene corner_drape(double mesh_size) {
  return rig_drape(2, 0.12, 0.005, 0.16, mesh_size, 0.1);
}

/// Height of a joint whose pad lies on the mold.
inline double joint_on_mold(const Scene& scene, int gripper) {
  const Eigen::Vector2d xy = scene.position + scene.rig->place(gripper);
  return scene.mold->height(xy.x(), xy.y()) + scene.rig->joint_offset;
}

/// Times of a drop [s], and how far above the mold it waits and below its surface it ends [m].
struct Drop {
  double above = 2, touch = 5, end = 6;
  double clearance = 0.02, depth = 0;
};

/// All grippers start `clearance` above the highest joint on the mold, wait as much above their own place,
/// then go down and stay.
inline Schedule drop(const Scene& scene, const Drop& by = {}) {
  Schedule schedule;
  schedule.blend_time = 0.1;
  double top = -1;
  for (int g = 0; g < scene.rig->count(); ++g) top = std::max(top, joint_on_mold(scene, g));
  for (int g = 0; g < scene.rig->count(); ++g) {
    const double end = joint_on_mold(scene, g);
    schedule.paths.push_back({{0, top + by.clearance},
                              {by.above, end + by.clearance},
                              {by.touch, end - by.depth},
                              {by.end, end - by.depth}});
  }
  return schedule;
}

}  // namespace drapeplan::test
