#include "fem/run/move_grips.hpp"

#include <algorithm>

namespace drapeplan {
namespace {

using Eigen::Vector3d;

/// Sum of a field over the grip's nodes.
Vector3d sum_of(const VectorField& field, const Grip& grip) {
  Vector3d sum(0, 0, 0);
  for (const int node : grip.nodes) {
    const auto n = size_t(node);
    sum += Vector3d(field.x[n], field.y[n], field.z[n]);
  }
  return sum;
}

/// Sum of all forces on the grip's nodes.
Vector3d pull(const Model& model, const Grip& grip, const Workspace& work) {
  if (model.fibre_inertia()) return sum_of(work.force, grip);
  Vector3d sum(0, 0, 0);
  for (const Forces& entry : work.entries) sum += sum_of(entry.force, grip);
  return sum;
}

void set(VectorField& field, size_t n, const Vector3d& value) {
  field.x[n] = value.x();
  field.y[n] = value.y();
  field.z[n] = value.z();
}

}  // namespace

Vector3d grip_displacement(const Grip& grip, double t) {
  // The speed rises as 3 s^2 - 2 s^3 over the ramp; its integral is s^3 - s^4 / 2.
  const double s = grip.ramp > 0 ? std::clamp(t / grip.ramp, 0.0, 1.0) : 1;
  return (grip.ramp * s * s * s * (1 - 0.5 * s) + std::max(t - grip.ramp, 0.0)) * grip.velocity;
}

void move_grips(const Model& model, State& state, Workspace& work) {
  const double scaling = model.scene().options.time_scaling;
  // kick_nodes has damped the velocities of all nodes; a grip's is given, and its mean with the next books
  // work.
  const double half = 0.5 * model.alpha() * state.kick_time(), keep = (1 - half) / (1 + half);
  for (const Grip& grip : model.scene().grips) {
    const Vector3d way = grip_displacement(grip, scaling * (state.time + state.dt)) -
                         grip_displacement(grip, scaling * state.time);
    const Vector3d next = way / state.dt;
    const auto first = size_t(grip.nodes.front());
    const Vector3d damped(state.velocity.x[first], state.velocity.y[first], state.velocity.z[first]);
    const Vector3d mean = 0.5 * (damped / keep + next);
    for (const int node : grip.nodes) {
      set(state.velocity, size_t(node), next);
      set(work.mean_v, size_t(node), mean);
    }
    state.work[size_t(Book::grip)] -= state.kick_time() * pull(model, grip, work).dot(mean);
  }
}

std::vector<Vector3d> grip_forces(const Model& model, const State& state) {
  State here = state;  // contact moves its anchors
  Workspace work(model);
  compute_forces(model, here, work);
  std::vector<Vector3d> forces;
  for (const Grip& grip : model.scene().grips) forces.push_back(-pull(model, grip, work));
  return forces;
}

}  // namespace drapeplan
