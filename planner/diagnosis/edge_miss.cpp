#include "planner/diagnosis/edge_miss.hpp"

#include <algorithm>

#include "planner/diagnosis/nearest.hpp"
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
  miss.gripper = nearest_gripper(rig, miss.at);
  miss.margin = (rig.place(miss.gripper) - miss.at).norm();
  // The node in the middle of its pad, or of what of the pad is on the ply.
  const auto middle = size_t(nearest_node(mesh, rig.place(miss.gripper)));
  const Eigen::Vector3d target = mapped_point(map.net, *definition.mold, mesh.rest[middle]);
  const Eigen::Vector3d off = offset.on_edge - offset.on_boundary;
  if (offset.max > 0) miss.pad_offset = (drape.run.final.position[middle] - target).dot(off) / offset.max;
  const Eigen::Vector3d normal = definition.mold->normal(offset.on_boundary.x(), offset.on_boundary.y());
  const Eigen::Vector3d along = off - off.dot(normal) * normal;
  // Towards the edge from the gripper that is nearest to it is outwards.
  if (along.norm() < EdgeMiss::kShare * offset.max)
    miss.side = EdgeSide::above;
  else
    miss.side = along.dot(offset.on_boundary - target) < 0 ? EdgeSide::short_of : EdgeSide::beyond;
  return miss;
}

}  // namespace drapeplan
