// The mapped ply as files, and how close the rig can come to it.
#pragma once

#include <filesystem>
#include <vector>

#include "fem/rig/rig.hpp"
#include "mapping/net.hpp"
#include "planner/drape/map_result.hpp"
#include "planner/exports/vtk_file.hpp"
#include "planner/reach/reach.hpp"

namespace drapeplan {

/// The mapped net. Of points: `u_m`, `v_m`, the place in the flat ply; of cells: `shear_deg`, > 0 where the
/// angle between warp and weft closes.
VtkGrid net_grid(const Net& net);

/// Mapped places of the pad centres. Of points: `gripper_i`, `gripper_j`, from 1.
VtkGrid target_grid(const RigOptions& rig, const std::vector<Eigen::Vector3d>& targets);

/// The pad centres that come as near to the targets as the rig allows, each with a line to its target. Of
/// lines: `gripper_i`, `gripper_j`, and `distance_m`, its length.
VtkGrid reachable_grid(const ReachProblem& problem, const ReachResult& reach);

/// Writes net.csv, one row `u,v,x,y,z,shear_deg` per node [m, deg], shear as the mean of the cells around it;
/// and for ParaView net.pvd, boundary.pvd and, with a rig, targets.pvd, each with its VTU file.
void write_mapping(const std::filesystem::path& folder, const MapResult& mapping,
                   const std::optional<RigOptions>& rig);

/// Writes targets.pvd and, where the solver has found it, reachable.pvd, each with its VTU file.
void write_reach(const std::filesystem::path& folder, const ReachProblem& problem, const ReachResult& reach);

}  // namespace drapeplan
