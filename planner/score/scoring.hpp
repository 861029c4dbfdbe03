// From the end of a run to its score: gaps, wrinkles, boundary offset, limits of the material, one objective.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/mesh/mesh.hpp"
#include "mapping/mold.hpp"
#include "planner/case/score_options.hpp"
#include "planner/score/score.hpp"

namespace drapeplan {

/// A failed run is worth this much; the objective of a valid one saturates at `kLargestValidObjective`, so
/// that a failure is always worse, whatever the weights, and optimisers still see a finite number.
inline constexpr double kFailedObjective = 2e4;
inline constexpr double kLargestValidObjective = 1e4;

/// What scoring needs to know of the whole run, not only of its end.
struct RunExtremes {
  double max_actuator_force = 0;     ///< largest |force| of a gripper [N]
  double max_lag = 0;                ///< of a joint from its command while its pad touches nothing [m]
  double saturated = 0;              ///< how long some actuator was at its limit, schedule's clock [s]
  double max_fibre_strain = 0;       ///< largest tension; the end of the run is looked at in any case [-]
  double max_fibre_compression = 0;  ///< the same in compression, magnitude [-]
  double duration = 0;               ///< of the schedule [s]
};

/// Gap between the ply's underside and the mold at every node [m], >= 0: the signed distance of the
/// mid-surface minus half the thickness, clipped at zero. Where Newton's method for the closest point does
/// not converge, the vertical distance stands in (never smaller than the true one); it is NaN where the mold
/// is not defined.
std::vector<double> nodal_gaps(const Snapshot& end, const Mold& mold, double thickness);
/// The same before clipping: negative inside the mold [m].
std::vector<double> signed_gaps(const Snapshot& end, const Mold& mold, double thickness);
/// Of one place of the mid-surface [m].
double signed_gap(const Eigen::Vector3d& place, const Mold& mold, double thickness);

/// Nodes whose gap is a taut fibre over a hollow, not a wrinkle: along warp or weft the mold's normal
/// curvature at the node's foot is > 0 AND the mean nominal strain of the elements around the node is > 0
/// along that fibre (both by a small tolerance, see scoring.cpp). Pressing such a ply down would need longer
/// fibres. A bridge that is wider than its hollow is told apart only where the mold below is hollow; the rest
/// of it counts as a wrinkle.
std::vector<bool> bridging(const Mesh& mesh, const Snapshot& end, const Mold& mold);
/// The same as a number: by how much the strain of the tautest fibre over a hollow exceeds that tolerance, at
/// least -1 %, which stands for no hollow [-]. Above zero the node bridges.
std::vector<double> bridging_strain(const Mesh& mesh, const Snapshot& end, const Mold& mold);

/// Distance between the ply's edge and the prescribed boundary.
struct BoundaryOffset {
  double max = 0;                    ///< Hausdorff distance: the larger of both ways [m]
  double rms = 0;                    ///< of the edge from the boundary, weighted with arc length [m]
  Eigen::Vector3d on_edge{0, 0, 0};  ///< the two points that are `max` apart [m]
  Eigen::Vector3d on_boundary{0, 0, 0};
};

/// @param edge, boundary  closed polylines, first point repeated at the end, at least two points each [m].
/// Both are sampled every 0.5 mm, vertices included, so `max` is at most 0.25 mm too small.
BoundaryOffset boundary_offset(const std::vector<Eigen::Vector3d>& edge,
                               const std::vector<Eigen::Vector3d>& boundary);

/// Share of the edge's length that is farther than `limit` [m] from the boundary [-]; arguments as above.
double share_beyond(const std::vector<Eigen::Vector3d>& edge, const std::vector<Eigen::Vector3d>& boundary,
                    double limit);

/// The ply's deformed edge on its underside, closed [m]: a perfectly draped ply lies on the prescribed
/// boundary.
std::vector<Eigen::Vector3d> ply_edge(const Mesh& mesh, const Snapshot& end, double thickness);

/// Scores the end of a run. Not-finite input gives an invalid score that names the place, never NaN.
/// @param prescribed_boundary  closed, on the mold [m];  @param thickness  of the ply [m].
/// @throws std::invalid_argument if the sizes of mesh and snapshot differ or the boundary has no length.
Score score_drape(const Mesh& mesh, const Snapshot& end, const Mold& mold,
                  const std::vector<Eigen::Vector3d>& prescribed_boundary, double thickness,
                  const ScoreOptions& options, const RunExtremes& run);

/// Score of a run that failed: `kFailedObjective` with its reason.
Score failed_score(const std::string& reason);

/// Weighted sum of the parts over their references. Fibre strain above its limit counts as excess over limit
/// and shares the weight of the shear excess: both are limits of the material.
/// @param ply_area  rest area [m^2], > 0.
double objective(const Score& score, const ScoreOptions& options, double ply_area);

}  // namespace drapeplan
