#include "planner/views/profile.hpp"

#include <limits>

#include "fem/mesh/foot.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<ProfilePoint> profile_of(const Profile& line, const Mesh& mesh, const Snapshot& ply,
                                     const Mold* mold, double thickness) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vector2d> plane = mesh.rest;
  if (line.frame == Profile::Frame::world) {
    for (size_t n = 0; n < plane.size(); ++n) plane[n] = ply.position[n].head<2>();
  }
  std::vector<ProfilePoint> profile;
  Snapshot points;
  for (int k = 0; k < kProfilePoints; ++k) {
    const Vector2d way = double(k) / (kProfilePoints - 1) * (line.to - line.from);
    std::optional<Vector3d> highest;
    for (const Foot& foot : feet_of(mesh, plane, line.from + way)) {
      const Vector3d place = place_of(mesh, foot, ply.position);
      if (!highest || place.z() > highest->z()) highest = place;
    }
    if (!highest) continue;
    const double below = mold != nullptr ? mold->height(highest->x(), highest->y()) : kNaN;
    profile.push_back({way.norm(), *highest, below, kNaN});
    points.position.push_back(*highest);
  }
  if (mold == nullptr) return profile;
  const std::vector<double> gaps = signed_gaps(points, *mold, thickness);
  for (size_t k = 0; k < profile.size(); ++k) profile[k].gap = gaps[k];
  return profile;
}

}  // namespace drapeplan
