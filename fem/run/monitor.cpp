#include "fem/run/monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/run/move_grips.hpp"

namespace drapeplan {
namespace {

/// Far beyond what any carbon fibre stands (2 %): what comes here is numerics, which books alone cannot see.
constexpr double kTornStrain = 0.2;

/// Its sine is 0.98: up to there the shell tabulates the law of shear, which goes on linearly in the sine.
const double kTabulatedShear = std::asin(0.98);

/// Of the largest book. Booked and stored work differ by the square of the step; measured below 1e-4.
constexpr double kGivenShare = 0.01;

/// By which stored energy may exceed what was booked, of the largest book: where all of it rings at the
/// highest frequency, on contact springs of a hundred times the default, they differ by more than 1 %.
constexpr double kHeldShare = 0.05;

/// How far a place is off the part of the x-y plane that the mold covers, in x or y [m].
double beyond(const Extent& extent, double x, double y) {
  return std::max(
      {extent.lower.x() - x, x - extent.upper.x(), extent.lower.y() - y, y - extent.upper.y(), 0.0});
}

/// Strain of round-off, far from the origin: what a ply stores by it is nothing.
constexpr double kRoundStrain = 1e-9;

/// A ply this fast stands still [m/s]: books below its kinetic energy are round-off, which has no sign.
constexpr double kStill = 1e-9;

/// A pad touches the mold where the gap of one of its nodes is below this share of the thickness: contact is
/// a spring, so a pad that rests on it has nodes at or below zero.
constexpr double kTouchShare = 0.1;

double largest_energy(const Model& model, const State& state) {
  return std::max(state.record.energy, 0.5 * model.free_mass() * kStill * kStill);
}

}  // namespace

Monitor::Monitor(const Model& model, const RigDrive& drive)
    : model_(model), drive_(drive), above_(size_t(model.node_count()), 0.0) {
  half_ = model.flat_state(0);  // takes its room
  if (model.rig() && drive.schedule) tied_ = model.rig()->tied_by_pad();
  for (const double part : nodal_areas(model.scene().mesh)) area_ += part;
  if (!model.scene().mold) return;
  const State& flat = half_;
  for (size_t n = 0; n < size_t(model.node_count()); ++n)
    overhang_ =
        std::max(overhang_, beyond(model.scene().mold->extent(), flat.position.x[n], flat.position.y[n]));
}

Energies energies(const Model& model, const State& state) {
  const auto work = [&state](Book book) { return state.work[size_t(book)]; };
  Energies e;
  e.kinetic = kinetic_energy(model, state) - work(Book::fibre_inertia);
  e.internal = -work(Book::internal);
  e.external = work(Book::gravity) + work(Book::actuator) + work(Book::load) + work(Book::grip);
  e.friction = -work(Book::friction);
  e.contact = -work(Book::contact);
  e.damping = -work(Book::damping);
  e.constraint = -work(Book::interlink) - work(Book::stop) - work(Book::release);
  return e;
}

/// Books end half a step before the state: stored energy is taken there, too. In the first steps of a run the
/// two still differ by a share of themselves.
bool Monitor::holds_more(const State& state, double limit) {
  constexpr std::int64_t kBooksSettled = 200;
  if (state.step < kBooksSettled) return false;
  half_ = state;
  const auto back = [&state](VectorField& place, const VectorField& rate) {
    for (size_t n = 0; n < place.x.size(); ++n) {
      place.x[n] -= 0.5 * state.dt_before * rate.x[n];
      place.y[n] -= 0.5 * state.dt_before * rate.y[n];
      place.z[n] -= 0.5 * state.dt_before * rate.z[n];
    }
  };
  back(half_.position, state.velocity);
  back(half_.director, state.director_rate);
  const ShellEnergy stored = model_.shell().stored_energy(half_);
  const double rounding = 0.5 * model_.shell().fibre_inertia_stretch() * area_ * kRoundStrain * kRoundStrain;
  return stored.fabric + stored.hourglass > limit + rounding;
}

/// Springs and viscosity start empty: what the ply gave it must have taken. A step that is too long pumps
/// energy out of it, and the books of that still close.
std::string Monitor::fault_of_books(State& state) {
  RunRecord& record = state.record;
  const Energies now = energies(model_, state);
  const double balance =
      now.kinetic + now.internal + now.friction + now.contact + now.damping + now.constraint - now.external;
  for (const double part :
       {now.kinetic, now.internal, now.external, now.friction, now.contact, now.damping, now.constraint}) {
    record.energy = std::max(record.energy, std::abs(part));
  }
  if (!std::isfinite(balance)) return "energy is not finite";
  const double largest = largest_energy(model_, state);
  if (now.internal < -kGivenShare * largest)
    return "the ply gives energy that it never took: the step is unstable; lower step_safety or "
           "step_interval";
  if (holds_more(state, now.internal + kHeldShare * largest))
    return "the ply holds energy that it never took: the step was unstable; lower step_safety or "
           "step_interval";
  if (std::min(now.contact, now.friction) < -kGivenShare * largest)
    return "contact gives energy that it never took: the step is unstable; lower step_safety";
  if (state.work[size_t(Book::fibre_inertia)] > kGivenShare * largest)
    return "fibre inertia gives energy that it never took: lower fibre_mass_scaling";
  record.balance = std::max(record.balance, std::abs(balance));
  return {};
}

std::string Monitor::fault_of_nodes(const State& state) const {
  for (size_t n = 0; n < size_t(model_.node_count()); ++n) {
    for (const VectorField* field : {&state.position, &state.velocity}) {
      if (!std::isfinite(field->x[n]) || !std::isfinite(field->y[n]) || !std::isfinite(field->z[n]))
        return fmt::format("not finite at node {}", n);
    }
  }
  return {};
}

std::string Monitor::fault_of_strains(State& state) {
  RunRecord& record = state.record;
  model_.shell().strains(state, strains_);
  for (const auto* list : {&strains_.warp_strain, &strains_.weft_strain}) {
    for (const double strain : *list) {
      record.fibre_strain = std::max(record.fibre_strain, strain);
      record.fibre_compression = std::max(record.fibre_compression, -strain);
    }
  }
  if (!(std::max(record.fibre_strain, record.fibre_compression) <= kTornStrain))
    return "a fibre is torn or the step is unstable";
  double shear = 0;
  for (const double angle : strains_.shear) shear = std::max(shear, std::abs(angle));
  if (!(shear <= kTabulatedShear))
    return "an element is sheared by more than 78.5 deg, where the law of shear ends";
  return {};
}

/// A gap is never negative: a ply inside the mold would look perfectly draped.
std::string Monitor::fault_on_mold(State& state) {
  if (!model_.scene().mold) return {};
  note_penetration(state);
  const double thickness = model_.scene().fabric.thickness;
  if (state.record.penetration > thickness)
    return fmt::format("the ply came {:.3g} mm inside the mold: more than its thickness",
                       1e3 * state.record.penetration);
  if (slid_ > overhang_ + thickness)
    return fmt::format("the ply slid {:.3g} mm over the mold's edge, where its extent ends", 1e3 * slid_);
  return {};
}

bool Monitor::look(State& state, RunSummary& summary) {
  std::string fault = fault_of_books(state);
  if (fault.empty()) fault = fault_of_nodes(state);
  if (fault.empty()) fault = fault_of_strains(state);
  if (fault.empty()) fault = fault_on_mold(state);
  if (fault.empty()) note_rig(state);
  if (fault.empty()) return true;
  summary.status = RunStatus::diverged;
  summary.message = fmt::format("{}, seen at step {}, t = {:g} s", fault, state.step, state.time);
  return false;
}

// The distance to the tangent plane at the vertical foot tells who is worth
// asking.
void Monitor::note_penetration(State& state) {
  slid_ = 0;
  const Mold& mold = *model_.scene().mold;
  const double surface = 0.5 * model_.scene().fabric.thickness;
  double z[kChunk], zx[kChunk], zy[kChunk];
  for (int first = 0; first < model_.node_count(); first += kChunk) {
    const int chunk = std::min(kChunk, model_.node_count() - first);
    mold.heights(chunk, &state.position.x[size_t(first)], &state.position.y[size_t(first)], z, zx, zy);
    for (int k = 0; k < chunk; ++k) {
      const auto n = size_t(first + k);
      const double above = (state.position.z[n] - z[k]) / std::sqrt(1 + zx[k] * zx[k] + zy[k] * zy[k]);
      above_[n] = above - surface;
      if (surface - above > 0)
        slid_ = std::max(slid_, beyond(mold.extent(), state.position.x[n], state.position.y[n]));
      if (!(surface - above > state.record.penetration)) continue;  // not defined here, or no worse
      const double distance =
          mold.closest({state.position.x[n], state.position.y[n], state.position.z[n]}).signed_distance;
      state.record.penetration = std::max(state.record.penetration, surface - distance);
    }
  }
}

/// Pads on the mold stop short of a command that aims below it: only those that touch nothing lag behind.
/// Where the mold is not defined, nothing is touched.
void Monitor::note_rig(State& state) const {
  RunRecord& record = state.record;
  const double touch = kTouchShare * model_.scene().fabric.thickness;
  bool saturated = false;
  for (size_t g = 0; g < tied_.size(); ++g) {
    if (state.pads[g].released) continue;
    saturated = saturated || model_.rig()->saturated(state, drive_, int(g));
    const bool touches = model_.scene().mold && std::any_of(tied_[g].begin(), tied_[g].end(), [&](int n) {
                           return above_[size_t(n)] <= touch;
                         });
    if (!touches) record.lag = std::max(record.lag, model_.rig()->lag(state, drive_, int(g)));
  }
  if (saturated) record.saturated += state.time - record.looked;
  record.looked = state.time;
}

void Monitor::compare_energies(State& state) const {
  const double internal = -state.work[size_t(Book::internal)];
  if (!(internal > 0)) return;
  RunRecord& record = state.record;
  record.kinetic_ratio = std::max(record.kinetic_ratio, ply_kinetic_energy(model_, state) / internal);
  record.hourglass_share =
      std::max(record.hourglass_share, model_.shell().stored_energy(state).hourglass / internal);
}

void Monitor::close(State& state, RunSummary& summary) const {
  summary.energy = energies(model_, state);
  summary.energy.hourglass = model_.shell().stored_energy(state).hourglass;
  summary.energy.largest = state.record.energy;
  const double largest = largest_energy(model_, state);
  summary.energy.balance_error = largest > 0 ? state.record.balance / largest : 0;
  summary.largest_kinetic_ratio = state.record.kinetic_ratio;
  summary.largest_hourglass_share = state.record.hourglass_share;
  summary.largest_link_error = state.record.link_error;
  summary.largest_penetration = state.record.penetration;
}

Snapshot take_snapshot(const Model& model, const State& state, const RigDrive& drive) {
  Snapshot out;
  out.time = state.time * drive.time_scaling;
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    out.position.emplace_back(state.position.x[n], state.position.y[n], state.position.z[n]);
    out.director.emplace_back(state.director.x[n], state.director.y[n], state.director.z[n]);
  }
  model.shell().strains(state, out);
  if (!model.scene().grips.empty()) out.grip_force = grip_forces(model, state);
  if (model.rig() && drive.schedule) model.rig()->snapshot(state, drive, out);
  return out;
}

}  // namespace drapeplan
