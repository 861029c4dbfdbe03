// A run over time for ParaView: the ply with all that is known of it, the grippers, the interlinks; and what
// stands still meanwhile, the mold and the prescribed boundary.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/model/scene.hpp"
#include "fem/rig/schedule.hpp"
#include "planner/drape/map_result.hpp"
#include "planner/exports/vtk_file.hpp"

namespace drapeplan {

/// A run; what it points to must outlive the call.
struct RunFrames {
  const Scene* scene = nullptr;
  const std::vector<Snapshot>* frames = nullptr;
  const Schedule* schedule = nullptr;  ///< that the rig plays; null without a rig
  const MapResult* mapping = nullptr;  ///< of the ply; null without one
};

/// The ply at an instant. Of points: `gap_m`, where there is a mold, from the ply's underside (NaN where the
/// mold is not defined), and `director`, unit, towards the upper face. Of cells: `shear_deg`, > 0 where the
/// angle between warp and weft closes, `warp_strain`, `weft_strain`, nominal, all three at mid-thickness; and
/// with a mapping `fibre_angle_offset_deg`, see fibre_angle_offsets.
VtkGrid ply_grid(const RunFrames& run, const Snapshot& ply);

/// The pads as discs; needs a rig and its schedule. Of cells: `gripper_i`, `gripper_j`, from 1; `lag_m`, the
/// way from the joint to its commanded place, zero along directions that are not driven; `actuator_force_N`,
/// vertical, upwards > 0; `suction`, 1 on, 0 off.
VtkGrid gripper_grid(const RunFrames& run, const Snapshot& now);

/// The interlinks as lines from joint to joint, none without them. Of cells: `length_m`.
VtkGrid interlink_grid(const Scene& scene, const Snapshot& now);

/// The mold's extent as n-by-n points with `normal` and `gaussian_curvature_per_m2`; cells with a corner
/// where the mold is not defined are left out. n >= 2.
VtkGrid mold_grid(const Mold& mold, int n = 101);

/// A closed line, one cell. @param boundary  the first point repeated at the end [m].
VtkGrid boundary_grid(const std::vector<Eigen::Vector3d>& boundary);

/// Writes the run as NAME.pvd (the ply), and with a rig NAME_grippers.pvd and NAME_interlinks.pvd, each with
/// a VTU file per frame.
/// @return the collections.
NamedFiles write_frames(const std::filesystem::path& folder, const std::string& name, const RunFrames& run);

/// Writes what stands still: mold.pvd and, with a mapping, boundary.pvd, each with its VTU file.
/// @return the collections.
NamedFiles write_surroundings(const std::filesystem::path& folder, const Mold& mold,
                              const MapResult* mapping);

}  // namespace drapeplan
