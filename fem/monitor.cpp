#include "fem/monitor.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace drapeplan {
namespace {

/// Far beyond what any carbon fibre bears (2 %): what comes here is numerics, which books alone cannot see.
constexpr double kTornStrain = 0.2;

}  // namespace

Energies energies(const Model& model, const State& state) {
  const auto work = [&state](Book book) { return state.work[size_t(book)]; };
  Energies e;
  e.kinetic = kinetic_energy(model, state);
  e.internal = -work(Book::internal);
  e.external = work(Book::gravity) + work(Book::actuator) + work(Book::grip);
  e.friction = -work(Book::friction);
  e.contact = -work(Book::contact);
  e.damping = -work(Book::damping);
  e.constraint = -work(Book::interlink) - work(Book::stop);
  return e;
}

bool Monitor::look(const State& state, RunResult& result) {
  RunReport& report = result.report;
  const Energies now = energies(model_, state);
  const double balance =
      now.kinetic + now.internal + now.friction + now.contact + now.damping + now.constraint - now.external;
  double largest = report.energy.largest;
  for (const double part :
       {now.kinetic, now.internal, now.external, now.friction, now.contact, now.damping, now.constraint}) {
    largest = std::max(largest, std::abs(part));
  }
  if (!std::isfinite(balance)) return fail(state, "energy is not finite", result);
  largest_balance_ = std::max(largest_balance_, std::abs(balance));
  report.energy = now;
  report.energy.largest = largest;
  report.energy.balance_error = largest > 0 ? largest_balance_ / largest : 0;
  for (size_t n = 0; n < size_t(model_.node_count()); ++n) {
    if (std::isfinite(state.x.x[n]) && std::isfinite(state.x.y[n]) && std::isfinite(state.x.z[n]) &&
        std::isfinite(state.v.x[n]) && std::isfinite(state.v.y[n]) && std::isfinite(state.v.z[n])) {
      continue;
    }
    return fail(state, "not finite at node " + std::to_string(n), result);
  }
  Snapshot strains;
  model_.shell().strains(state, strains);
  for (const auto* list : {&strains.warp_strain, &strains.weft_strain}) {
    for (const double strain : *list) {
      result.largest_fibre_strain = std::max(result.largest_fibre_strain, strain);
      result.largest_fibre_compression = std::max(result.largest_fibre_compression, -strain);
    }
  }
  if (!(std::max(result.largest_fibre_strain, result.largest_fibre_compression) <= kTornStrain))
    return fail(state, "a fibre is torn or the step is unstable", result);
  return true;
}

bool Monitor::fail(const State& state, const std::string& what, RunResult& result) {
  std::ostringstream text;
  text << what << ", seen at step " << state.step << ", t = " << state.time << " s";
  result.report.status = RunStatus::diverged;
  result.report.message = text.str();
  return false;
}

void Monitor::note_kinetic_ratio(const State& state, RunResult& result) const {
  const double internal = -state.work[size_t(Book::internal)];
  if (!(internal > 0)) return;
  const double ratio = ply_kinetic_energy(model_, state) / internal;
  result.report.largest_kinetic_ratio = std::max(result.report.largest_kinetic_ratio, ratio);
}

void Monitor::close(const State& state, RunResult& result) const {
  result.report.energy.hourglass = model_.shell().stored_energy(state).hourglass;
  if (!model_.scene().mold) return;
  for (size_t n = 0; n < size_t(model_.node_count()); ++n) {
    const ClosestPoint foot = model_.scene().mold->closest({state.x.x[n], state.x.y[n], state.x.z[n]});
    const double gap = foot.signed_distance - 0.5 * model_.scene().fabric.thickness;
    result.report.largest_penetration = std::max(result.report.largest_penetration, -gap);
  }
}

Snapshot take_snapshot(const Model& model, const State& state, const RigDrive& drive) {
  Snapshot out;
  out.time = state.time * drive.time_scaling;
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    out.position.emplace_back(state.x.x[n], state.x.y[n], state.x.z[n]);
    out.director.emplace_back(state.d.x[n], state.d.y[n], state.d.z[n]);
  }
  model.shell().strains(state, out);
  if (!model.scene().grips.empty()) out.grip_force = grip_forces(model, state);
  if (model.rig() && drive.schedule) model.rig()->snapshot(state, drive, out);
  return out;
}

}  // namespace drapeplan
