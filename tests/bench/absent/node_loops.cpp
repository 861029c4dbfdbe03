// In place of fem/run/workspace.cpp: the loops over nodes as they would be written if there were nothing but
// a shell. What they cost less than the real ones is what the possibility of terms, damping, pads and grips
// costs a bare sheet.
#include "fem/run/workspace.hpp"
#include "tests/bench/absent/absent.hpp"

namespace drapeplan {

StepScratch::StepScratch(const Model& model)
    : others(model.node_count()), sum(model.node_count()), sections(model.shell().section_count()) {}

Workspace::Workspace(const Model& model) : entries(model.shell().entries()), step(model) {}

void compute_forces(const Model& model, State& state, Workspace& work) {
  model.shell().forces(state, work.entries.data());
}

void kick_nodes(const Model& model, State& state, Workspace& work) {
  const Lanes h(state.kick_time()), zero(0.0);
  Lanes power(0.0);
  for (size_t n = 0; n < size_t(model.node_count()); n += size_t(kLanes)) {
    const Vec3<Lanes> force = work.entries[0].force.lanes(n), all = work.entries[0].moment.lanes(n);
    const Vec3<Lanes> v = state.velocity.lanes(n), w = state.director_rate.lanes(n),
                      d = state.director.lanes(n);
    const Lanes mobility = load(&model.inverse_mass()[n]), turning = load(&model.inverse_inertia()[n]);
    const Vec3<Lanes> moment = all - dot(all, d) * d;
    const Vec3<Lanes> v_new = v + (h * mobility) * force, w_new = w + (h * turning) * moment;
    state.velocity.set_lanes(n, v_new);
    state.director_rate.set_lanes(n, w_new);
    Lanes free(0.5), free_turning(0.5);
    std::experimental::where(mobility == zero, free) = zero;
    std::experimental::where(turning == zero, free_turning) = zero;
    power += dot(force, free * (v + v_new)) + dot(all, free_turning * (w + w_new));
  }
  work.power[0] = std::experimental::reduce(power);
}

void book_work(const Model& /*model*/, State& state, const Workspace& work) {
  state.work[size_t(Book::internal)] += state.kick_time() * work.power[0];
}

void add_inertia(const Model& /*model*/, const State& /*state*/, Workspace& /*work*/) {
  absent("fibre inertia");
}

void kick_pads(const Model& /*model*/, State& /*state*/, const RigDrive& /*drive*/, Workspace& /*work*/) {
  absent("gripper rig");
}

}  // namespace drapeplan
