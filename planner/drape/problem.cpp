#include "planner/drape/problem.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <new>

#include "mapping/error.hpp"
#include "planner/drape/run_checks.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

constexpr int kReachStarts = 2;  // beside the targets; their agreement is reported

bool on_edge(const Eigen::AlignedBox2d& box, const Eigen::Vector2d& uv, Edge edge) {
  const double slack = 1e-9;  // [m], round-off of mesh lines
  switch (edge) {
    case Edge::left:
      return uv.x() <= box.min().x() + slack;
    case Edge::right:
      return uv.x() >= box.max().x() - slack;
    case Edge::bottom:
      return uv.y() <= box.min().y() + slack;
    case Edge::top:
      return uv.y() >= box.max().y() - slack;
  }
  return false;
}

/// Joints where their pads touch the mold at the mapped places [m].
std::vector<Eigen::Vector3d> touching_joints(const Case& definition,
                                             const std::vector<Eigen::Vector3d>& targets) {
  const double above = 0.5 * definition.material.thickness + definition.grippers->joint_offset;
  std::vector<Eigen::Vector3d> joints;
  for (const Eigen::Vector3d& target : targets) {
    joints.push_back(target + above * definition.mold->normal(target.x(), target.y()));
  }
  return joints;
}

Eigen::Vector2d start_of_joint(const Case& definition, int gripper) {
  return definition.ply.position +
         Eigen::Rotation2Dd(definition.ply.angle) * definition.grippers->place(gripper);
}

Mesh mesh_of(const Case& definition, double mesh_size) {
  std::vector<double> u,
      v;  // lines through the pads, so that these cover the same piece of ply on every mesh
  if (definition.grippers) {
    u = column_places(*definition.grippers, mesh_size);
    v = row_places(*definition.grippers, mesh_size);
  }
  if (!definition.ply.outline.empty()) return outline_mesh(definition.ply.outline, mesh_size, u, v);
  return rectangle_mesh(definition.ply.width, definition.ply.height, mesh_size, u, v);
}

/// Interlinks that are as long as the distance of their joints with both pads on their targets get that
/// length, unless they have it.
void set_mapped_interlinks(const Case& definition, const std::vector<Eigen::Vector3d>& targets,
                           RigOptions& rig) {
  const std::vector<Eigen::Vector3d> joints = touching_joints(definition, targets);
  rig.interlinks->lengths.clear();
  for (const auto& [i, j] : interlinks(rig))
    rig.interlinks->lengths.push_back((joints[size_t(i)] - joints[size_t(j)]).norm());
}

bool waits_for_mapping(const Case& definition) {
  return definition.grippers && definition.grippers->interlinks &&
         definition.interlink_length.source == InterlinkLength::Source::mapped &&
         definition.grippers->interlinks->lengths.empty();
}

/// Nodes under each pad: those that GripperRig ties to it.
std::vector<std::vector<int>> held_nodes(const RigOptions& rig, const std::vector<Eigen::Vector2d>& rest) {
  const double reach = reach_of_pads(rig, rest);
  std::vector<std::vector<int>> held(size_t(rig.count()));
  for (size_t n = 0; n < rest.size(); ++n) {
    int nearest = 0;
    for (int g = 1; g < rig.count(); ++g) {
      if ((rest[n] - rig.place(g)).norm() < (rest[n] - rig.place(nearest)).norm()) nearest = g;
    }
    if ((rest[n] - rig.place(nearest)).norm() <= reach) held[size_t(nearest)].push_back(int(n));
  }
  return held;
}

/// Holds all nodes of the mesh's edge on the given piece.
Grip grip_of(const GripOptions& options, const Mesh& mesh) {
  Grip grip{options.name, {}, options.velocity, options.ramp};
  const Eigen::Vector2d way = options.to - options.from;
  for (const int node : mesh.outline) {
    const Eigen::Vector2d offset = mesh.rest[size_t(node)] - options.from;
    const double along = std::clamp(offset.dot(way) / way.squaredNorm(), 0.0, 1.0);
    if ((offset - along * way).norm() <= kOnOutline) grip.nodes.push_back(node);
  }
  return grip;
}

}  // namespace

Scene scene_of(const Case& definition, const FemOptions& options) {
  Scene scene;
  const Ply& ply = definition.ply;
  scene.mesh = mesh_of(definition, options.mesh_size);
  scene.fabric = definition.material;
  scene.options = options;
  scene.position = ply.position;
  scene.angle = ply.angle;
  scene.start_height = definition.start_height;
  scene.start = definition.start;
  scene.gravity = definition.gravity;
  scene.damping = definition.damping;
  scene.rest = definition.rest;
  scene.mold = definition.mold;
  scene.friction = definition.friction;
  if (definition.tack) scene.tack = Tack{.stress = *definition.tack};
  if (definition.press) scene.press = definition.press->load;
  scene.rig = definition.grippers;
  if (waits_for_mapping(definition))
    set_mapped_interlinks(definition, map_case(definition).targets, *scene.rig);
  for (const GripOptions& grip : definition.grips) scene.grips.push_back(grip_of(grip, scene.mesh));
  const Eigen::AlignedBox2d box = bounding_box(corners_of(ply));
  for (int n = 0; n < scene.mesh.node_count(); ++n) {
    for (const Edge edge : definition.clamped) {
      if (!on_edge(box, scene.mesh.rest[size_t(n)], edge)) continue;
      scene.clamped.push_back(n);
      break;
    }
  }
  return scene;
}

Model model_of(const Case& definition, const FemOptions& options) {
  try {
    return Model(scene_of(definition, options));
  } catch (const std::bad_alloc&) {
    const double area = bounding_box(corners_of(definition.ply)).volume();
    throw NotFinished(
        fmt::format("not enough memory for about {:.0f} nodes; a larger fem.mesh_size needs less",
                    area / (options.mesh_size * options.mesh_size)));
  }
}

ReachProblem reach_problem_of(const Case& definition, const std::vector<Eigen::Vector3d>& targets) {
  const RigOptions& rig = *definition.grippers;
  ReachProblem problem{rig, *definition.mold, targets, definition.ply.position};
  if (waits_for_mapping(definition)) set_mapped_interlinks(definition, targets, problem.rig);
  // Joints stand off from the ply's mid-surface, which lies half a ply above the mold.
  problem.ply_thickness = 0.5 * definition.material.thickness;
  if (rig.fixed) {
    problem.fixed_place = start_of_joint(definition, rig.gripper_at(*rig.fixed));
  }
  return problem;
}

FloorProblem floor_problem_of(const Case& definition, const MapResult& map, double cell) {
  const RigOptions& rig = *definition.grippers;
  FloorProblem problem{rig, *definition.mold, mesh_of(definition, cell), {}, {}, {}, map.boundary};
  if (waits_for_mapping(definition)) set_mapped_interlinks(definition, map.targets, problem.rig);
  problem.held = held_nodes(rig, problem.net.rest);
  for (const Eigen::Vector2d& rest : problem.net.rest) {
    const Eigen::Vector2d inside(std::clamp(rest.x(), map.net.u.front(), map.net.u.back()),
                                 std::clamp(rest.y(), map.net.v.front(), map.net.v.back()));
    problem.mapped.push_back(mapped_point(map.net, *definition.mold, inside));
    problem.flat.push_back(definition.ply.position + Eigen::Rotation2Dd(definition.ply.angle) * rest);
  }
  if (rig.fixed) problem.fixed_place = start_of_joint(definition, rig.gripper_at(*rig.fixed));
  problem.thickness = definition.material.thickness;
  return problem;
}

DrapeProblem::DrapeProblem(Case definition)
    : case_(std::move(definition)),
      map_(map_case(case_)),
      reach_problem_(reach_problem_of(case_, map_.targets)),
      reach_(std::make_unique<Lazy<ReachResult>>()),
      ply_floor_(std::make_unique<Lazy<PlyFloor>>()),
      score_fields_(std::make_unique<Lazy<ScoreFields>>()) {
  case_.grippers = reach_problem_.rig;  // with mapped interlinks
  for (const auto& entry : case_.fidelities) {
    models_[entry.first] = std::make_unique<Lazy<Model>>();
    samplings_[entry.first] = std::make_unique<Lazy<ScoreFields::Sampling>>();
  }
  const bool reachable = case_.schedule.aim == Aim::reachable;
  if (reachable && !reach().converged) {
    throw NotFinished("the schedule aims at reachable places, but there are none: " + reach().status);
  }
  frame_.rig = *case_.grippers;
  const std::vector<Eigen::Vector3d> joints =
      reachable ? reach().joints : touching_joints(case_, map_.targets);
  for (const Eigen::Vector3d& joint : joints) frame_.target_z.push_back(joint.z());
  for (int g = 0; frame_.rig.driven == Driven::xyz && g < frame_.rig.count(); ++g) {
    frame_.start_xy.push_back(start_of_joint(case_, g));
    frame_.target_xy.push_back(joints[size_t(g)].head<2>());
  }
  frame_.options = case_.schedule;
  frame_.shortest_stroke = case_.optimise.shortest_stroke;
  frame_.longest_sequence = case_.optimise.longest_sequence;
  frame_.press = case_.press;
}

const ReachResult& DrapeProblem::reach() const {
  return reach_->get([this] { return solve_reach(reach_problem_, kReachStarts, case_.optimise.seed); });
}

const PlyFloor& DrapeProblem::ply_floor() const {
  return ply_floor_->get([this]() -> PlyFloor {
    try {
      const FloorProblem problem = floor_problem_of(case_, map_);
      FloorOptions options;
      options.random_starts = 0;
      options.seed = case_.optimise.seed;
      FloorFront front = solve_floor(problem, options);
      std::string meaning = explain_floor(problem, front);
      return {std::move(front), std::move(meaning)};
    } catch (const WrongInput& error) {  // the outline needs smaller cells
      return {{}, std::string("The floor of the ply was not looked for: ") + error.what()};
    }
  });
}

const Model& DrapeProblem::model(const std::string& fidelity) const {
  return models_.at(fidelity)->get([&] { return model_of(case_, case_.fidelities.at(fidelity)); });
}

const ScoreFields& DrapeProblem::score_fields() const {
  return score_fields_->get([this] {
    double cell = case_.fidelities.at(kReport).mesh_size;
    for (const char* name : kSearched) {
      if (const auto found = case_.fidelities.find(name); found != case_.fidelities.end())
        cell = std::max(cell, found->second.mesh_size);
    }
    return ScoreFields(mesh_of(case_, cell), *case_.mold, map_.boundary, case_.material.thickness,
                       case_.score);
  });
}

std::vector<float> DrapeProblem::score_fields_of(const Drape& drape, const std::string& fidelity) const {
  if (!drape.score.valid) return {};
  const Mesh& mesh = model(fidelity).scene().mesh;
  const ScoreFields& fields = score_fields();
  const ScoreFields::Sampling& sampling = samplings_.at(fidelity)->get([&] { return fields.sampling(mesh); });
  const bool before = drape.other && !drape.other->before;
  return fields.measure(mesh, sampling, before ? *drape.run.unpressed : drape.run.final, drape.score);
}

Drape DrapeProblem::run(const Schedule& schedule, const std::string& fidelity, int frames,
                        RunPart part) const {
  return run_on(model(fidelity), schedule, frames, std::move(part));
}

Drape DrapeProblem::run_on(const Model& model, const Schedule& schedule, int frames, RunPart part) const {
  Drape drape;
  RunRequest request;
  request.schedule = &schedule;
  request.frames = frames;
  request.from = part.from;
  request.pause = part.pause;
  request.press = part.press;
  request.samples = part.samples;
  request.sample = std::move(part.sample);
  if (frames > 0) request.observe = [&drape](const Snapshot& frame) { drape.frames.push_back(frame); };
  drape.run = simulate(model, request);
  drape.gap = nodal_gaps(drape.run.final, *case_.mold, case_.material.thickness);
  const double duration = schedule.duration();
  drape.score = score_at(model, drape.run, drape.run.final, drape.run.state.record, duration);
  if (!drape.run.unpressed) return drape;
  const Score before =
      score_at(model, drape.run, *drape.run.unpressed, drape.run.state.unpressed_record, duration);
  const bool takes_after = case_.press->objective == PressOptions::Objective::after;
  drape.other = OtherScore{takes_after, takes_after ? before : drape.score};
  if (!takes_after) drape.score = before;
  return drape;
}

Drape DrapeProblem::run_for_objective(const Schedule& schedule, const std::string& fidelity) const {
  const bool before = case_.press && case_.press->objective == PressOptions::Objective::before;
  return run(schedule, fidelity, 0, {.press = fidelity == kReport || !before});
}

Score DrapeProblem::score_at(const Model& model, const RunResult& run, const Snapshot& ply,
                             const RunRecord& seen, double duration) const {
  if (run.summary.status != RunStatus::done) return failed_score(run.summary.message);
  if (seen.kinetic_ratio > case_.score.kinetic_limit && fabric_takes_part(run.summary))
    return failed_score(thrown_text(seen.kinetic_ratio, case_.score.kinetic_limit));
  // A gap is never negative: a ply that ended inside the mold would look perfectly draped.
  if (run.summary.largest_penetration > case_.material.thickness)
    return failed_score(fmt::format("the ply came {:f} mm inside the mold: more than its thickness",
                                    1e3 * run.summary.largest_penetration));
  const RunExtremes extremes{.max_actuator_force = seen.actuator_force,
                             .max_lag = seen.lag,
                             .saturated = seen.saturated * model.scene().options.time_scaling,
                             .max_fibre_strain = seen.fibre_strain,
                             .max_fibre_compression = seen.fibre_compression,
                             .duration = duration};
  return score_drape(model.scene().mesh, ply, *case_.mold, map_.boundary, case_.material.thickness,
                     case_.score, extremes);
}

}  // namespace drapeplan
