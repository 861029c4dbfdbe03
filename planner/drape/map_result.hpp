// The mapped ply as a result: gripper targets, prescribed boundary, shear.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mapping/net.hpp"
#include "planner/case/case.hpp"

namespace drapeplan {

struct MapResult {
  Net net;
  std::vector<Eigen::Vector3d> targets;   ///< mapped places of the pad centres, in the order of the rig [m]
  std::vector<Eigen::Vector3d> boundary;  ///< closed [m]
  std::vector<Eigen::Vector3d> corners;   ///< of the ply's bounding box: (-,-), (+,-), (+,+), (-,+) [m]
  double max_shear_deg = 0;               ///< largest magnitude over the cells in the ply [deg]
  double mean_shear_deg = 0;              ///< mean magnitude over the ply's area [deg]
};

/// Maps the ply of a case that has a mold and a mapping.
/// @throws NotFinished where the mold ends or a cell's minimisation fails.
MapResult map_case(const Case& definition);

/// How a mapping lays the ply down in plan, against `ply.position` and `ply.angle`. Draping bends, shears and
/// shortens the ply as seen from above, but it neither moves the start point nor turns the ply as a whole.
struct Placement {
  double shift = 0;     ///< of the start point from its place in the flat ply [m]
  double turn_deg = 0;  ///< rotation about the start that takes flat places nearest to targets, signed [deg]
  double warp_turn_deg =
      0;                ///< largest angle between ply.angle and a half of the warp at the start, signed [deg]
  double moved = 0;     ///< largest distance by which shift and turn alone move a gripper [m]
  double farthest = 0;  ///< largest distance in plan between a target and its pad's flat place [m]
  int gripper = 0;      ///< which one that is
};

/// Compares over all grippers; over the ply's corners in a case without grippers.
Placement placement_of(const Case& definition, const MapResult& map);

/// What a user should know of a mapping before trusting anything built on it: a ply that sticks out of the
/// mold's extent, shear beyond the locking angle, a mapping that turns or shifts the ply against ply.angle
/// and ply.position, a fixed gripper that would have to move in-plane to its target. One sentence each.
std::vector<std::string> map_warnings(const Case& definition, const MapResult& map);

}  // namespace drapeplan
