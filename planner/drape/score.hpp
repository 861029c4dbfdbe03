// What a draped ply is worth: named parts with units; weights are applied last.
#pragma once

#include <string>

namespace drapeplan {

/// Parts of the score (SI). Everything is evaluated at the end of the run, except forces and strains.
struct Score {
  double max_gap = 0;  ///< largest gap between ply underside and mold [m]
  double rms_gap = 0;  ///< area-weighted [m]
  double wrinkled_area =
      0;  ///< area with a gap above the threshold where the ply is not bridging a hollow [m^2]
  double max_boundary_offset =
      0;  ///< largest distance between ply edge and prescribed boundary, both ways [m]
  double rms_boundary_offset = 0;  ///< of the ply edge from the prescribed boundary [m]
  double max_shear_deg = 0;        ///< [deg]
  double max_fibre_strain = 0;     ///< largest tension along a fibre at mid-thickness, nominal strain [-]
  /// Largest shortening along a fibre at mid-thickness, magnitude of the nominal strain [-]. It comes from
  /// folds: with a fibre that is soft in compression the neutral axis moves off the middle, and folds finer
  /// than the mesh shorten it.
  double max_fibre_compression = 0;
  double max_actuator_force = 0;  ///< over the run [N]
  double duration = 0;            ///< of the schedule [s]
  double objective = 0;           ///< weighted sum, lower is better
  bool valid = false;             ///< false: the run failed, `reason` says why, `objective` is the penalty
  std::string reason;
};

}  // namespace drapeplan
