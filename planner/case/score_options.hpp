// How the parts of a score become one objective: references and weights.
#pragma once

namespace drapeplan {

/// Each part is divided by its reference value and multiplied by its weight; a weight of 0 leaves it out.
struct ScoreOptions {
  double wrinkle_threshold = 0.001;       ///< [m]
  double target_gap = 0.001;              ///< reference of gaps [m]
  double target_boundary_offset = 0.002;  ///< reference of boundary offsets [m]
  double locking_angle_deg = 35;          ///< shear above it is penalised [deg]
  double strain_limit = 0.02;             ///< fibre strain above it is penalised [-]
  /// Of joints behind their commands before they touch; a schedule above it is no candidate [m].
  double lag_tolerance = 0.010;
  /// Of the ply's kinetic over its internal energy; a drape above it was thrown and has no score [-].
  double kinetic_limit = 1;
  double weight_max_gap = 1;
  double weight_rms_gap = 1;
  double weight_wrinkled_area = 1;  ///< reference: 1 % of the ply's area
  double weight_max_boundary_offset = 1;
  double weight_rms_boundary_offset = 1;
  double weight_shear = 1;     ///< per degree above the locking angle
  /// Per mm of lag above the tolerance: a schedule that is not followed gains less than that by it.
  double weight_lag = 3;
  double weight_duration = 0;  ///< per second
};

}  // namespace drapeplan
