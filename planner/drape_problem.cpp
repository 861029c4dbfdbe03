#include "planner/drape_problem.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "planner/scoring.hpp"

namespace drapeplan {
namespace {

constexpr int kReachStarts = 2;  // beside the targets; their agreement is reported

bool on_edge(const Ply& ply, const Eigen::Vector2d& uv, Edge edge) {
  const double slack = 1e-9;  // [m], round-off of mesh lines
  switch (edge) {
    case Edge::left:
      return uv.x() <= -0.5 * ply.width + slack;
    case Edge::right:
      return uv.x() >= 0.5 * ply.width - slack;
    case Edge::bottom:
      return uv.y() <= -0.5 * ply.height + slack;
    case Edge::top:
      return uv.y() >= 0.5 * ply.height - slack;
  }
  return false;
}

/// Heights of joints where their pads touch the mold, at the mapped or at the reachable places.
std::vector<double> touch_heights(const Case& value, const std::vector<Eigen::Vector3d>& targets,
                                  const ReachResult& reach) {
  std::vector<double> heights;
  if (value.schedule.aim == Aim::reachable) {
    for (const Eigen::Vector3d& joint : reach.joints) heights.push_back(joint.z());
    return heights;
  }
  const double above = 0.5 * value.material.thickness + value.grippers->joint_offset;
  for (const Eigen::Vector3d& target : targets) {
    heights.push_back(target.z() + above * value.mold->normal(target.x(), target.y()).z());
  }
  return heights;
}

}  // namespace

Scene scene_of(const Case& value, const FemOptions& options) {
  Scene scene;
  const Ply& ply = value.ply;
  if (value.grippers) {
    scene.mesh = rectangle_mesh(ply.width, ply.height, options.mesh_size, column_places(*value.grippers),
                                row_places(*value.grippers));
  } else {
    scene.mesh = rectangle_mesh(ply.width, ply.height, options.mesh_size);
  }
  scene.fabric = value.material;
  scene.options = options;
  scene.position = ply.position;
  scene.angle = ply.angle;
  scene.start_height = value.start_height;
  scene.start = value.start;
  scene.gravity = value.gravity;
  scene.damping = value.damping;
  scene.rest = value.rest;
  scene.mold = value.mold;
  scene.friction = value.friction;
  scene.rig = value.grippers;
  for (int n = 0; n < scene.mesh.node_count(); ++n) {
    for (const Edge edge : value.clamped) {
      if (!on_edge(ply, scene.mesh.rest[size_t(n)], edge)) continue;
      scene.clamped.push_back(n);
      break;
    }
  }
  return scene;
}

ReachProblem reach_problem_of(const Case& value, const std::vector<Eigen::Vector3d>& targets) {
  const RigOptions& rig = *value.grippers;
  ReachProblem problem{rig, *value.mold, targets, value.ply.position};
  // Joints stand off from the ply's mid-surface, which lies half a ply above the mold.
  problem.ply_thickness = 0.5 * value.material.thickness;
  if (rig.fixed) {
    const int index = ((*rig.fixed)[1] - 1) * rig.columns + (*rig.fixed)[0] - 1;
    problem.fixed_place += Eigen::Rotation2Dd(value.ply.angle) * rig.place(index);
  }
  return problem;
}

DrapeProblem::DrapeProblem(Case value)
    : case_(std::move(value)),
      map_(map_case(case_)),
      reach_problem_(reach_problem_of(case_, map_.targets)),
      reach_(solve_reach(reach_problem_, kReachStarts, case_.optimise.seed)) {
  if (case_.schedule.aim == Aim::reachable && !reach_.converged) {
    throw std::domain_error("the schedule aims at reachable places, but there are none: " + reach_.status);
  }
  frame_.rig = *case_.grippers;
  frame_.target_z = touch_heights(case_, map_.targets, reach_);
  frame_.options = case_.schedule;
  frame_.shortest_stroke = case_.optimise.shortest_stroke;
  frame_.longest_sequence = case_.optimise.longest_sequence;
  for (const auto& [name, options] : case_.fidelities) {
    models_[name] = std::make_unique<const Model>(scene_of(case_, options));
  }
}

Drape DrapeProblem::run(const Schedule& schedule, const std::string& fidelity, int frames) const {
  const Model& model = *models_.at(fidelity);
  Drape drape;
  RunRequest request{.schedule = &schedule, .duration = 0, .frames = frames, .observe = nullptr};
  if (frames > 0) request.observe = [&drape](const Snapshot& frame) { drape.frames.push_back(frame); };
  drape.run = simulate(model, request);
  drape.separation = separations(drape.run.final, *case_.mold, case_.material.thickness);
  if (drape.run.report.status == RunStatus::diverged) {
    drape.score = failed_score(drape.run.report.message);
    return drape;
  }
  // A gap is never negative: a ply that ended inside the mold would look perfectly draped.
  if (drape.run.report.largest_penetration > case_.material.thickness) {
    drape.score = failed_score("the ply came " + std::to_string(1e3 * drape.run.report.largest_penetration) +
                               " mm inside the mold: more than its thickness");
    return drape;
  }
  const RunRecord& record = drape.run.state.record;
  const RunExtremes extremes{record.actuator_force, record.fibre_strain, record.fibre_compression,
                             schedule.duration()};
  drape.score = score_drape(model.scene().mesh, drape.run.final, *case_.mold, map_.boundary,
                            case_.material.thickness, case_.score, extremes);
  return drape;
}

}  // namespace drapeplan
