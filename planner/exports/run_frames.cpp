#include "planner/exports/run_frames.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "planner/page/view_fields.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kRim = 32;  // corners of a disc: they lie within 0.5 % of its radius

std::vector<double> in_degrees(std::vector<double> angles) {
  for (double& angle : angles) angle *= kDegrees;
  return angles;
}

/// A triangle repeats one node of the four.
VtkCell cell_of(const std::array<int, 4>& quad) {
  VtkCell cell{.kind = VtkKind::quad, .points = {}};
  for (const int node : quad) {
    if (std::find(cell.points.begin(), cell.points.end(), node) == cell.points.end())
      cell.points.push_back(node);
  }
  if (cell.points.size() == 3) cell.kind = VtkKind::triangle;
  return cell;
}

/// The way from a joint to its commanded place [m].
Vector3d lag_of(const RigOptions& rig, const Schedule& schedule, const Snapshot& now, int gripper) {
  const Command command = schedule.command(gripper, now.time);
  const Vector3d& joint = now.joint[size_t(gripper)];
  Vector3d lag(0, 0, command.z - joint.z());
  if (rig.driven == Driven::xyz) lag.head<2>() = command.xy - joint.head<2>();
  return lag;
}

/// Normal of a pad, which its joint stands on; upwards where the joint lies in the pad.
Vector3d normal_of(const Snapshot& now, size_t gripper) {
  const Vector3d arm = now.joint[gripper] - now.pad[gripper];
  return arm.norm() > 0 ? Vector3d(arm.normalized()) : Vector3d::UnitZ();
}

void add_disc(const Vector3d& centre, const Vector3d& normal, double radius, VtkGrid& grid) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal);
  VtkCell disc{.kind = VtkKind::polygon, .points = {}};
  for (int k = 0; k < kRim; ++k) {
    const double angle = 2 * std::numbers::pi * k / kRim;
    disc.points.push_back(std::int64_t(grid.points.size()));
    grid.points.push_back(centre + radius * (turn * Vector3d(std::cos(angle), std::sin(angle), 0)));
  }
  grid.cells.push_back(std::move(disc));
}

}  // namespace

VtkGrid ply_grid(const RunFrames& run, const Snapshot& ply) {
  const Scene& scene = *run.scene;
  VtkGrid grid;
  grid.points = ply.position;
  for (const auto& quad : scene.mesh.quads) grid.cells.push_back(cell_of(quad));
  if (scene.mold)
    grid.point_fields.push_back({"gap_m", nodal_gaps(ply, *scene.mold, scene.fabric.thickness)});
  grid.point_fields.push_back(vtk_vectors("director", ply.director));
  grid.cell_fields = {{"shear_deg", in_degrees(ply.shear)},
                      {"warp_strain", ply.warp_strain},
                      {"weft_strain", ply.weft_strain}};
  if (run.mapping != nullptr)
    grid.cell_fields.push_back({"fibre_angle_offset_deg",
                                in_degrees(fibre_angle_offsets(scene.mesh, ply.position, run.mapping->net))});
  return grid;
}

VtkGrid gripper_grid(const RunFrames& run, const Snapshot& now) {
  const RigOptions& rig = run.scene->rig.value();
  VtkGrid grid;
  VtkField i{"gripper_i", {}}, j{"gripper_j", {}}, suction{"suction", {}};
  std::vector<Vector3d> lags;
  for (int g = 0; g < rig.count(); ++g) {
    add_disc(now.pad.at(size_t(g)), normal_of(now, size_t(g)), rig.pad_radius, grid);
    i.values.push_back(rig.indices(g)[0]);
    j.values.push_back(rig.indices(g)[1]);
    lags.push_back(lag_of(rig, *run.schedule, now, g));
    suction.values.push_back(run.schedule->released(g, now.time) ? 0 : 1);
  }
  grid.cell_fields = {i, j, vtk_vectors("lag_m", lags), {"actuator_force_N", now.actuator_force}, suction};
  return grid;
}

VtkGrid interlink_grid(const Scene& scene, const Snapshot& now) {
  VtkGrid grid;
  VtkField length{"length_m", {}};
  grid.points = now.joint;
  if (scene.rig && scene.rig->interlinks) {
    for (const auto& [a, b] : interlinks(*scene.rig)) {
      grid.cells.push_back({VtkKind::line, {a, b}});
      length.values.push_back((now.joint.at(size_t(b)) - now.joint.at(size_t(a))).norm());
    }
  }
  grid.cell_fields = {length};
  return grid;
}

VtkGrid mold_grid(const Mold& mold, int n) {
  if (n < 2) throw std::invalid_argument(fmt::format("mold_grid: n must be at least 2, it is {}", n));
  VtkGrid grid;
  std::vector<Vector3d> normals;
  VtkField curvature{"gaussian_curvature_per_m2", {}};
  std::vector<int> index(size_t(n) * size_t(n), -1);  // of each place among the points
  const Eigen::Vector2d lower = mold.extent().lower, size = mold.extent().upper - lower;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double x = lower.x() + size.x() * i / (n - 1), y = lower.y() + size.y() * j / (n - 1);
      const Vector3d normal = mold.normal(x, y);
      const double gaussian = mold.gaussian_curvature(x, y);
      if (!mold.point(x, y).allFinite() || !normal.allFinite() || !std::isfinite(gaussian)) continue;
      index[size_t(i + j * n)] = int(grid.points.size());
      grid.points.push_back(mold.point(x, y));
      normals.push_back(normal);
      curvature.values.push_back(gaussian);
    }
  }
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const std::array<int, 4> quad{index[size_t(i + j * n)], index[size_t(i + 1 + j * n)],
                                    index[size_t(i + 1 + (j + 1) * n)], index[size_t(i + (j + 1) * n)]};
      if (*std::min_element(quad.begin(), quad.end()) >= 0) grid.cells.push_back(cell_of(quad));
    }
  }
  grid.point_fields = {vtk_vectors("normal", normals), curvature};
  return grid;
}

VtkGrid boundary_grid(const std::vector<Vector3d>& boundary) {
  VtkGrid grid;
  VtkCell line{.kind = VtkKind::polyline, .points = {}};
  for (size_t k = 0; k < boundary.size(); ++k) line.points.push_back(std::int64_t(k));
  grid.points = boundary;
  grid.cells = {std::move(line)};
  return grid;
}

NamedFiles write_frames(const std::filesystem::path& folder, const std::string& name, const RunFrames& run) {
  const Scene& scene = *run.scene;
  const std::vector<Snapshot>& frames = *run.frames;
  std::vector<double> times;
  for (const Snapshot& frame : frames) times.push_back(frame.time);
  NamedFiles files;
  const auto write = [&](const std::string& part, const char* what, const auto& grid_of) {
    write_over_time(folder, name + part, times, [&](size_t k) { return grid_of(frames[k]); });
    files.emplace_back(name + part + ".pvd", fmt::format("{} over time, for ParaView", what));
  };
  write("", "the ply", [&](const Snapshot& now) { return ply_grid(run, now); });
  if (scene.rig)
    write("_grippers", "the grippers", [&](const Snapshot& now) { return gripper_grid(run, now); });
  if (scene.rig && scene.rig->interlinks && scene.rig->count() > 1)
    write("_interlinks", "the interlinks", [&](const Snapshot& now) { return interlink_grid(scene, now); });
  return files;
}

NamedFiles write_surroundings(const std::filesystem::path& folder, const Mold& mold,
                              const MapResult* mapping) {
  write_still(folder, "mold", mold_grid(mold));
  NamedFiles files{{"mold.pvd", "the mold, for ParaView"}};
  if (mapping == nullptr) return files;
  write_still(folder, "boundary", boundary_grid(mapping->boundary));
  files.emplace_back("boundary.pvd", "the prescribed boundary, for ParaView");
  return files;
}

}  // namespace drapeplan
