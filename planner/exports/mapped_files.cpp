#include "planner/exports/mapped_files.hpp"

#include <Eigen/Core>
#include <numbers>

#include "fem/mesh/mesh.hpp"
#include "planner/base/text.hpp"
#include "planner/exports/run_frames.hpp"
#include "planner/page/view_fields.hpp"

namespace drapeplan {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// The flat net: its cells in the order of shear_field.
Mesh mesh_of(const Net& net) {
  Mesh mesh;
  const int columns = int(net.u.size());
  for (const double v : net.v)
    for (const double u : net.u) mesh.rest.emplace_back(u, v);
  for (int j = 0; j + 1 < int(net.v.size()); ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const int at = i + j * columns;
      mesh.quads.push_back({at, at + 1, at + 1 + columns, at + columns});
    }
  }
  return mesh;
}

std::vector<double> shear_in_degrees(const Net& net) {
  std::vector<double> shear = shear_field(net);
  for (double& angle : shear) angle *= kDegrees;
  return shear;
}

std::string net_csv(const Net& net) {
  const Mesh mesh = mesh_of(net);
  const std::vector<double> shear = nodal_means(mesh, shear_in_degrees(net));
  std::string text = "u,v,x,y,z,shear_deg\n";
  for (size_t n = 0; n < net.nodes.size(); ++n) {
    const Eigen::Vector3d& p = net.nodes[n];
    for (const double value : {mesh.rest[n].x(), mesh.rest[n].y(), p.x(), p.y(), p.z()})
      text += exact(value) + ',';
    text += exact(shear[n]) + '\n';
  }
  return text;
}

/// gripper_i and gripper_j of all grippers.
std::vector<VtkField> gripper_fields(const RigOptions& rig) {
  VtkField i{"gripper_i", {}}, j{"gripper_j", {}};
  for (int g = 0; g < rig.count(); ++g) {
    i.values.push_back(rig.indices(g)[0]);
    j.values.push_back(rig.indices(g)[1]);
  }
  return {i, j};
}

}  // namespace

VtkGrid net_grid(const Net& net) {
  const Mesh mesh = mesh_of(net);
  VtkGrid grid;
  VtkField u{"u_m", {}}, v{"v_m", {}};
  grid.points = net.nodes;
  for (const Eigen::Vector2d& rest : mesh.rest) {
    u.values.push_back(rest.x());
    v.values.push_back(rest.y());
  }
  for (const auto& quad : mesh.quads) grid.cells.push_back({VtkKind::quad, {quad.begin(), quad.end()}});
  grid.point_fields = {u, v};
  grid.cell_fields = {{"shear_deg", shear_in_degrees(net)}};
  return grid;
}

VtkGrid target_grid(const RigOptions& rig, const std::vector<Eigen::Vector3d>& targets) {
  VtkGrid grid;
  grid.points = targets;
  for (size_t g = 0; g < targets.size(); ++g) grid.cells.push_back({VtkKind::vertex, {std::int64_t(g)}});
  grid.point_fields = gripper_fields(rig);
  return grid;
}

VtkGrid reachable_grid(const ReachProblem& problem, const ReachResult& reach) {
  VtkGrid grid;
  grid.points = reach.positions;
  grid.points.insert(grid.points.end(), problem.targets.begin(), problem.targets.end());
  const auto count = std::int64_t(problem.targets.size());
  for (std::int64_t g = 0; g < count; ++g) grid.cells.push_back({VtkKind::line, {g, g + count}});
  grid.cell_fields = gripper_fields(problem.rig);
  grid.cell_fields.push_back({"distance_m", reach.per_gripper});
  return grid;
}

void write_mapping(const std::filesystem::path& folder, const MapResult& mapping,
                   const std::optional<RigOptions>& rig) {
  write_text(folder / "net.csv", net_csv(mapping.net));
  write_still(folder, "net", net_grid(mapping.net));
  write_still(folder, "boundary", boundary_grid(mapping.boundary));
  if (rig) write_still(folder, "targets", target_grid(*rig, mapping.targets));
}

void write_reach(const std::filesystem::path& folder, const ReachProblem& problem, const ReachResult& reach) {
  write_still(folder, "targets", target_grid(problem.rig, problem.targets));
  if (reach.converged) write_still(folder, "reachable", reachable_grid(problem, reach));
}

}  // namespace drapeplan
