#include "planner/diagnosis/edge_miss.hpp"

#include <algorithm>

#include "planner/score/scoring.hpp"

namespace drapeplan {

EdgeMiss edge_miss_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity) {
  const Case& definition = problem.definition();
  const RigOptions& rig = *definition.grippers;
  const Mesh& mesh = problem.model(fidelity).scene().mesh;
  const MapResult& map = problem.mapping();
  const std::vector<Eigen::Vector3d> edge = ply_edge(mesh, drape.run.final, definition.material.thickness);
  const BoundaryOffset offset = boundary_offset(edge, map.boundary);
  EdgeMiss miss;
  miss.offset = offset.max;
  const auto nearest = std::min_element(edge.begin(), edge.end(), [&](const auto& a, const auto& b) {
    return (a - offset.on_edge).squaredNorm() < (b - offset.on_edge).squaredNorm();
  });
  const size_t place =
      size_t(nearest - edge.begin()) % mesh.outline.size();  // the first node ends the edge, too
  miss.at = mesh.rest[size_t(mesh.outline[place])];
  for (int g = 1; g < rig.count(); ++g) {
    if ((rig.place(g) - miss.at).norm() < (rig.place(miss.gripper) - miss.at).norm()) miss.gripper = g;
  }
  miss.margin = (rig.place(miss.gripper) - miss.at).norm();
  // The node in the middle of its pad, or of what of the pad is on the ply.
  const auto middle = std::min_element(mesh.rest.begin(), mesh.rest.end(), [&](const auto& a, const auto& b) {
    return (a - rig.place(miss.gripper)).squaredNorm() < (b - rig.place(miss.gripper)).squaredNorm();
  });
  const Eigen::Vector3d target = mapped_point(map.net, *definition.mold, *middle);
  const Eigen::Vector3d off = offset.on_edge - offset.on_boundary;
  // Towards the edge from the gripper that is nearest to it is outwards.
  miss.short_of = off.dot(offset.on_boundary - target) < 0;
  const Eigen::Vector3d pad_off = drape.run.final.position[size_t(middle - mesh.rest.begin())] - target;
  if (offset.max > 0) miss.pad_offset = pad_off.dot(off) / offset.max;
  return miss;
}

}  // namespace drapeplan
