// The ply beside the mold along a line, as a scanner or a section shows it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/mesh/mesh.hpp"
#include "mapping/mold.hpp"
#include "planner/case/case.hpp"

namespace drapeplan {

/// Points of a profile, equally spaced along its line, both ends included.
inline constexpr int kProfilePoints = 401;

struct ProfilePoint {
  double along = 0;                ///< from the first end of the line, in the line's own plane [m]
  Eigen::Vector3d place{0, 0, 0};  ///< of the ply's mid-surface [m]
  double mold = 0;                 ///< height of the mold below [m]; NaN without a mold
  double gap = 0;                  ///< of the underside to the mold, negative inside [m]; NaN without a mold
};

/// The ply along a line of the case. Where a fold lies over itself in the world's plane, its highest layer is
/// taken, as seen from above. Points without ply are left out. [Krogh], Figure 20, has such a profile of
/// constant x.
/// @param mold  null without one.  @param thickness  of the ply [m].
std::vector<ProfilePoint> profile_of(const Profile& line, const Mesh& mesh, const Snapshot& ply,
                                     const Mold* mold, double thickness);

}  // namespace drapeplan
