#include "fem/run/workspace.hpp"

// Positions follow velocities; what the ply's motion is worth.
namespace drapeplan {

void drift_nodes(const Model& model, State& state) {
  const Lanes dt(state.dt), one(1.0);
  for (size_t n = 0; n < size_t(model.node_count()); n += size_t(kLanes)) {
    state.position.set_lanes(n, state.position.lanes(n) + dt * state.velocity.lanes(n));
    // The director turns along a great circle by the angle |w| dt, and its rate with it: |d| and |w| keep
    // their values. Series of sine and cosine: angles of a step are far below 1, the first term left out is
    // below 1e-16 up to 0.03.
    const Vec3<Lanes> d = state.director.lanes(n), w = state.director_rate.lanes(n);
    const Lanes w2 = dot(w, w), a2 = w2 * dt * dt;
    const Lanes sine =
        one - a2 * Lanes(1.0 / 6) * (one - a2 * Lanes(1.0 / 20) * (one - a2 * Lanes(1.0 / 42)));
    const Lanes cosine =
        one - a2 * Lanes(0.5) *
                  (one - a2 * Lanes(1.0 / 12) * (one - a2 * Lanes(1.0 / 30) * (one - a2 * Lanes(1.0 / 56))));
    const Vec3<Lanes> turned = cosine * d + (sine * dt) * w;
    const Lanes unit =
        Lanes(1.5) - Lanes(0.5) * dot(turned, turned);  // Newton step towards length 1: only round-off
    state.director.set_lanes(n, unit * turned);
    state.director_rate.set_lanes(n, cosine * w - (sine * dt * w2) * d);
  }
}

void advance_clock(State& state) {
  state.time += state.dt;
  state.dt_before = state.dt;
  ++state.step;
}

double ply_kinetic_energy(const Model& model, const State& state) {
  Lanes sum(0.0);
  for (size_t n = 0; n < size_t(model.node_count()); n += size_t(kLanes)) {
    const Vec3<Lanes> v = state.velocity.lanes(n), w = state.director_rate.lanes(n);
    sum += load(&model.mass()[n]) * dot(v, v) + load(&model.inertia()[n]) * dot(w, w);
  }
  return 0.5 * std::experimental::reduce(sum);
}

double kinetic_energy(const Model& model, const State& state) {
  return ply_kinetic_energy(model, state) + (model.rig() ? model.rig()->kinetic_energy(state) : 0.0);
}

}  // namespace drapeplan
