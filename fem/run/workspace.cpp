#include "fem/run/workspace.hpp"

#include <stdexcept>
#include <utility>

// Entry 0 is the shell's: it always has forces and moments.
namespace drapeplan {
namespace {

namespace stdx = std::experimental;

/// Of a scene where one step is chosen for good, nothing.
StepScratch step_scratch(const Model& model) {
  return model.scene().options.step_interval > 0 ? StepScratch(model) : StepScratch();
}

/// What the scene has that the kick must know of: chosen once, so that nothing is asked node by node.
struct KickPolicy {
  bool damping, inertia, pads;
  bool others;  ///< terms beside the shell
};

// One pass over the nodes: forces are summed, velocities kicked and the work of every entry on free nodes
// booked, with the mean of both velocities. Held nodes move by other rules and are booked with theirs. In one
// piece, over 60 lines: parts of it would be calls within the loop that hand over all of its registers.
template <KickPolicy kHas>
void kick(const Model& model, State& state, Workspace& work) {
  const double h = state.kick_time(), alpha = model.alpha();
  const Lanes keep((1 - 0.5 * alpha * h) / (1 + 0.5 * alpha * h)), gain(h / (1 + 0.5 * alpha * h)), half(0.5);
  const Lanes zero(0.0);
  std::array<Lanes, kMostEntries> power;
  std::array<Vec3<Lanes>, kMostEntries> forces;
  if constexpr (kHas.others) power.fill(zero);
  Lanes internal_power(0.0), damping(0.0), added_power(0.0);
  std::array<size_t, kMostEntries> active;
  size_t count = 0;
  const Forces& shell = work.entries[0];
  for (size_t n = 0; n < size_t(model.node_count()); n += size_t(kLanes)) {
    if constexpr (kHas.others) {
      if (n % size_t(kChunk) == 0) {
        count = 0;
        for (size_t k = 1; k < work.entries.size(); ++k) {
          if (!work.entries[k].idle(n / size_t(kChunk))) active[count++] = k;
        }
      }
    }
    const Vec3<Lanes> internal = shell.force.lanes(n), internal_moment = shell.moment.lanes(n);
    Vec3<Lanes> force = internal, moment = internal_moment;
    if constexpr (kHas.others) {
      for (size_t a = 0; a < count; ++a) force = force + (forces[a] = work.entries[active[a]].force.lanes(n));
      for (const size_t k : work.turning) moment = moment + work.entries[k].moment.lanes(n);
    }
    const Vec3<Lanes> of_terms = force;
    if constexpr (kHas.inertia) force = work.force.lanes(n);
    if constexpr (kHas.pads) {
      if (work.has_tied[n / size_t(kLanes)]) {
        work.force.set_lanes(n, force);
        work.moment.set_lanes(n, moment);
      }
    }
    const Vec3<Lanes> v = state.velocity.lanes(n), w = state.director_rate.lanes(n),
                      d = state.director.lanes(n);
    const Lanes mobility = load(&model.inverse_mass()[n]), turning = load(&model.inverse_inertia()[n]);
    moment = moment - dot(moment, d) * d;  // a director cannot be stretched
    const auto kicked = [&](const Vec3<Lanes>& before, const Lanes& by_force, const Vec3<Lanes>& sum) {
      if constexpr (kHas.damping) return keep * before + (gain * by_force) * sum;
      return before + (gain * by_force) * sum;
    };
    const Vec3<Lanes> v_new = kicked(v, mobility, force), w_new = kicked(w, turning, moment);
    state.velocity.set_lanes(n, v_new);
    state.director_rate.set_lanes(n, w_new);
    Lanes free = half, free_turning = half;
    stdx::where(mobility == zero, free) = zero;
    stdx::where(turning == zero, free_turning) = zero;
    const Vec3<Lanes> mean_v = free * (v + v_new), mean_w = free_turning * (w + w_new);
    if constexpr (kHas.inertia) added_power += dot(force - of_terms, mean_v);
    internal_power += dot(internal, mean_v) + dot(internal_moment, mean_w);
    if constexpr (kHas.others) {
      for (size_t a = 0; a < count; ++a) power[active[a]] += dot(forces[a], mean_v);
      for (const size_t k : work.turning) power[k] += dot(work.entries[k].moment.lanes(n), mean_w);
    }
    if constexpr (kHas.damping)
      damping +=
          load(&model.mass()[n]) * dot(mean_v, mean_v) + load(&model.inertia()[n]) * dot(mean_w, mean_w);
  }
  work.power[0] = stdx::reduce(internal_power);
  for (size_t k = 1; k < work.entries.size(); ++k) work.power[k] = stdx::reduce(power[k]);
  work.added_power = stdx::reduce(added_power);
  work.damping = alpha * stdx::reduce(damping);
}

using Kick = void (*)(const Model&, State&, Workspace&);

/// Kicks of all policies; the bits of a place say what the scene has.
template <size_t... kPlace>
constexpr std::array<Kick, sizeof...(kPlace)> all_kicks(std::index_sequence<kPlace...> /*places*/) {
  return {kick<KickPolicy{(kPlace & 1) != 0, (kPlace & 2) != 0, (kPlace & 4) != 0, (kPlace & 8) != 0}>...};
}

}  // namespace

StepScratch::StepScratch(const Model& model)
    : others(model.node_count()), sum(model.node_count()), sections(model.shell().section_count()) {}

Workspace::Workspace(const Model& model) : step(step_scratch(model)) {
  for (const auto& term : model.terms()) {
    first.push_back(entries.size());
    for (Forces& entry : term->entries()) {
      if (!entries.empty() && !entry.moment.x.empty()) turning.push_back(entries.size());
      entries.push_back(std::move(entry));
    }
  }
  if (entries.size() > kMostEntries) throw std::logic_error("more entries of forces than kMostEntries");
  std::vector<char> has_guided(padded(model.node_count()) / size_t(kLanes), false);
  for (const int node : model.guided()) has_guided[size_t(node / kLanes)] = true;
  for (size_t block = 0; block < has_guided.size(); ++block) {
    if (has_guided[block]) guided.push_back(block * size_t(kLanes));
  }
  if (!guided.empty()) mean_v = mean_w = VectorField(model.node_count());
  if (model.fibre_inertia()) {
    inertia = model.fibre_inertia()->scratch();
    force = VectorField(model.node_count());
  }
  if (!model.rig()) return;
  rig = model.rig()->scratch();
  force = moment = VectorField(model.node_count());
  has_tied.assign(has_guided.size(), false);
  for (const int node : model.rig()->tied()) has_tied[size_t(node / kLanes)] = true;
}

void compute_forces(const Model& model, State& state, Workspace& work) {
  for (size_t k = 0; k < work.first.size(); ++k)
    model.terms()[k]->forces(state, &work.entries[work.first[k]]);
  if (model.fibre_inertia()) add_inertia(model, state, work);
}

void add_inertia(const Model& model, const State& state, Workspace& work) {
  for (size_t n = 0; n < size_t(model.node_count()); n += size_t(kLanes)) {
    Vec3<Lanes> sum = work.entries[0].force.lanes(n);
    for (size_t k = 1; k < work.entries.size(); ++k) {
      if (!work.entries[k].idle(n / size_t(kChunk))) sum = sum + work.entries[k].force.lanes(n);
    }
    work.force.set_lanes(n, sum);
  }
  model.fibre_inertia()->filter(state, work.inertia, work.force);
}

void kick_nodes(const Model& model, State& state, Workspace& work) {
  static constexpr auto kKicks = all_kicks(std::make_index_sequence<16>());
  const bool others = work.entries.size() > 1;
  kKicks[size_t(model.alpha() != 0) + 2 * size_t(model.fibre_inertia().has_value()) +
         4 * size_t(model.rig().has_value()) + 8 * size_t(others)](model, state, work);
}

void kick_pads(const Model& model, State& state, const RigDrive& drive, Workspace& work) {
  model.rig()->kick(state, drive, model.alpha(), {work.force, work.moment, work.mean_v, work.mean_w},
                    work.rig);
}

void book_work(const Model& model, State& state, const Workspace& work) {
  const double h = state.kick_time();
  std::array<Lanes, kMostEntries> on_guided;
  on_guided.fill(Lanes(0.0));
  Lanes added(0.0);
  for (const size_t n : work.guided) {
    const Vec3<Lanes> v = work.mean_v.lanes(n), w = work.mean_w.lanes(n);
    Vec3<Lanes> force{Lanes(0.0), Lanes(0.0), Lanes(0.0)};
    for (size_t k = 0; k < work.entries.size(); ++k) {
      if (work.entries[k].idle(n / size_t(kChunk))) continue;
      const Vec3<Lanes> of_term = work.entries[k].force.lanes(n);
      on_guided[k] += dot(of_term, v);
      force = force + of_term;
    }
    on_guided[0] += dot(work.entries[0].moment.lanes(n), w);
    for (const size_t k : work.turning) on_guided[k] += dot(work.entries[k].moment.lanes(n), w);
    if (model.fibre_inertia()) added += dot(work.force.lanes(n) - force, v);
  }
  std::array<double, kMostEntries> power = work.power;
  for (size_t k = 0; k < work.entries.size(); ++k) power[k] += stdx::reduce(on_guided[k]);
  const double added_power = work.added_power + stdx::reduce(added);
  for (size_t k = 0; k < work.entries.size(); ++k) state.work[size_t(work.entries[k].book)] += h * power[k];
  state.work[size_t(Book::fibre_inertia)] += h * added_power;
  state.work[size_t(Book::damping)] -= h * work.damping;
}

}  // namespace drapeplan
