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

/// What a user should know of a mapping before trusting anything built on it: a ply that sticks out of the
/// mold's extent, shear beyond the locking angle, a fixed gripper that would have to move in-plane to its
/// target. One sentence each.
std::vector<std::string> map_warnings(const Case& definition, const MapResult& map);

}  // namespace drapeplan
