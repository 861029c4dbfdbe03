#include "fem/model/flat_start.hpp"

#include <algorithm>

namespace drapeplan {
namespace {

/// The ply's plane in the world.
struct Plane {
  Eigen::Vector3d origin, normal = Eigen::Vector3d::UnitZ();
  Eigen::Quaterniond lean = Eigen::Quaterniond::Identity();  ///< from the x-y plane

  Plane(const Scene& scene, double height) : origin(scene.position.x(), scene.position.y(), height) {
    if (scene.start != Start::on_mold) return;
    normal = scene.mold->normal(origin.x(), origin.y());
    origin = scene.mold->point(origin.x(), origin.y()) + 0.5 * scene.fabric.thickness * normal;
    lean.setFromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  }
};

/// A state at rest with all fields that the scene needs, its nodes nowhere yet.
State empty_state(const Model& model) {
  const int n = model.node_count();
  State state;
  state.position = state.velocity = state.director = state.director_rate = VectorField(n);
  if (model.scene().friction) {
    state.anchor = VectorField(n);
    state.stuck.assign(padded(n), 0.0);
  }
  state.history.assign(model.shell().history_count(), 0.0);
  if (model.fibre_inertia()) state.edges.fill(VectorField(n));
  if (model.scene().options.step_interval > 0) state.lightness.assign(padded(n), 1.0);
  state.dt = state.dt_before = model.dt();
  state.stable_dt = model.stable_dt();
  return state;
}

}  // namespace

State flat_start(const Model& model, double height) {
  const Scene& scene = model.scene();
  const auto n = size_t(model.node_count());
  State state = empty_state(model);
  const Plane plane(scene, height);
  const Eigen::Rotation2Dd turn(scene.angle);
  for (size_t k = 0; k < padded(int(n)); ++k) {  // padding repeats the last node and has no mass
    const Eigen::Vector2d uv = turn * scene.mesh.rest[std::min(k, n - 1)];
    const Eigen::Vector3d x = plane.origin + plane.lean * Eigen::Vector3d(uv.x(), uv.y(), 0);
    const Eigen::Vector3d& d = plane.normal;
    state.position.x[k] = x.x(), state.position.y[k] = x.y(), state.position.z[k] = x.z();
    state.director.x[k] = d.x(), state.director.y[k] = d.y(), state.director.z[k] = d.z();
  }
  if (model.rig()) model.rig()->place(state, height);
  if (model.fibre_inertia()) model.fibre_inertia()->take_directions(state);
  return state;
}

}  // namespace drapeplan
