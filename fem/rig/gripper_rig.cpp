#include "fem/rig/gripper_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;

constexpr double kServoDamping = 1;  // damping ratio of a joint on its actuator: a servo does not ring

void book(State& state, Book entry, double work) {
  state.work[size_t(entry)] += work;
}

Vector3d get(const VectorField& field, size_t n) {
  return {field.x[n], field.y[n], field.z[n]};
}

void set(VectorField& field, size_t n, const Vector3d& value) {
  field.x[n] = value.x(), field.y[n] = value.y(), field.z[n] = value.z();
}

Vec3<Lanes> lanes_of(const Vector3d& v) {
  return {Lanes(v.x()), Lanes(v.y()), Lanes(v.z())};
}

Vec3<Lanes> cross(const Vec3<Lanes>& a, const Vec3<Lanes>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vector3d sum_of(const Vec3<Lanes>& v) {
  namespace stdx = std::experimental;
  return {stdx::reduce(v.x), stdx::reduce(v.y), stdx::reduce(v.z)};
}

/// Stores lanes that are tied, and leaves others.
void set_tied(VectorField& field, size_t at, const Lanes& tied, const Vec3<Lanes>& value) {
  namespace stdx = std::experimental;
  const auto mask = tied > Lanes(0.5);
  stdx::where(mask, value.x).copy_to(&field.x[at], stdx::element_aligned);
  stdx::where(mask, value.y).copy_to(&field.y[at], stdx::element_aligned);
  stdx::where(mask, value.z).copy_to(&field.z[at], stdx::element_aligned);
}

/// Mass damping, centred: v+ = keep v- + gain force / mass.
struct Damped {
  double keep, gain;
  Damped(double dt, double alpha)
      : keep((1 - 0.5 * alpha * dt) / (1 + 0.5 * alpha * dt)), gain(dt / (1 + 0.5 * alpha * dt)) {}
};

/// The pad whose centre is nearest to a node; the first one of several. Pads that all but touch would claim
/// the same nodes.
int nearest_pad(const RigOptions& rig, const Eigen::Vector2d& node) {
  int nearest = 0;
  for (int g = 1; g < rig.count(); ++g) {
    if ((node - rig.place(g)).norm() < (node - rig.place(nearest)).norm()) nearest = g;
  }
  return nearest;
}

}  // namespace

GripperRig::GripperRig(const RigOptions& rig, const std::vector<Eigen::Vector2d>& rest,
                       const std::vector<double>& mass, const std::vector<double>& inertia,
                       std::vector<Eigen::Vector2d> place, double turn)
    : rig_(rig), links_(rig, place), stop_(rig, turn), place_(std::move(place)), turn_(turn) {
  const double reach = reach_of_pads(rig, rest);
  for (int g = 0; g < rig.count(); ++g) {
    Pad pad;
    pad.bare_mass = pad.mass = rig.pad_mass;
    pad.bare_inertia = pad.inertia = 0.5 * rig.pad_mass * rig.pad_radius * rig.pad_radius;
    pad.first = int(tied_.size());
    for (size_t n = 0; n < rest.size(); ++n) {
      const Eigen::Vector2d offset = rest[n] - rig.place(g);
      if (offset.norm() > reach || nearest_pad(rig, rest[n]) != g) continue;
      tied_.push_back(int(n));
      nodes_.push_back({{offset.x(), offset.y(), 0}, mass[n], inertia[n]});
      pad.mass += mass[n];
      pad.inertia += mass[n] * offset.squaredNorm() + inertia[n];
    }
    pad.last = int(tied_.size());
    if (pad.last == pad.first) {
      throw WrongInput(fmt::format("gripper {} has no ply node under its pad: refine the mesh", rig.name(g)));
    }
    lay_patches(pad);
    pads_.push_back(pad);
  }
}

void GripperRig::lay_patches(Pad& pad) const {
  for (auto k = size_t(pad.first); k < size_t(pad.last); ++k) {
    const auto n = size_t(tied_[k]);
    if (pad.patches.empty() || n >= pad.patches.back().at + size_t(kLanes)) {
      pad.patches.emplace_back();
      pad.patches.back().at = n;
      pad.patches.back().offset1 = pad.patches.back().offset2 = Lanes(0.0);
    }
    Patch& patch = pad.patches.back();
    const size_t lane = n - patch.at;
    patch.tied[lane] = 1;
    patch.offset1[lane] = nodes_[k].offset.x();
    patch.offset2[lane] = nodes_[k].offset.y();
  }
}

std::vector<std::vector<int>> GripperRig::tied_by_pad() const {
  std::vector<std::vector<int>> nodes;
  for (const Pad& pad : pads_) nodes.emplace_back(tied_.begin() + pad.first, tied_.begin() + pad.last);
  return nodes;
}

// Twice the kinetic energy of the nodes of a pad at speed V and spin W is at most m V^2 + 2 e V W + j W^2
// with their mass m, their first moment e and their spread j about the centre; that of the pad is M V^2 + I
// W^2. The largest eigenvalue of the first form on the second is the inverse of the ratio.
std::vector<double> GripperRig::mass_ratios(const std::vector<double>& mass,
                                            const std::vector<double>& inertia) const {
  std::vector<double> ratios;
  for (const Pad& pad : pads_) {
    double sum = 0, spread = 0;
    Vector3d moment = Vector3d::Zero();
    for (auto k = size_t(pad.first); k < size_t(pad.last); ++k) {
      const auto n = size_t(tied_[k]);
      sum += mass[n];
      moment += mass[n] * nodes_[k].offset;
      spread += mass[n] * nodes_[k].offset.squaredNorm() + inertia[n];
    }
    const double a = sum / pad.mass, c = spread / pad.inertia;
    const double b = moment.norm() / std::sqrt(pad.mass * pad.inertia);
    const double largest = 0.5 * (a + c) + std::hypot(0.5 * (a - c), b);
    ratios.insert(ratios.end(), size_t(pad.last - pad.first), std::max(1.0, 1 / largest));
  }
  return ratios;
}

RigScratch GripperRig::scratch() const {
  RigScratch s;
  for (auto* list : {&s.free_v, &s.free_w, &s.stop, &s.joint_v, &s.actuator}) list->resize(pads_.size());
  s.links = links_.scratch();
  return s;
}

void GripperRig::place(State& state, double z) const {
  state.pads.clear();
  for (const auto& xy : place_) {
    PadState pad;
    pad.centre = {xy.x(), xy.y(), z};
    pad.rotation = Eigen::AngleAxisd(turn_, Vector3d::UnitZ());
    state.pads.push_back(pad);
  }
}

Vector3d GripperRig::actuator_force(const State& state, const RigDrive& drive, int g) const {
  const PadState& pad = state.pads[size_t(g)];
  const Vector3d place = joint(pad), speed = pad.velocity + pad.angular_velocity.cross(place - pad.centre);
  const Command command = drive.schedule->command(g, state.time * drive.time_scaling);
  const double mass = pads_[size_t(g)].mass_of(pad);
  const double damping = 2 * kServoDamping * std::sqrt(rig_.actuator_stiffness * mass);
  const auto along = [&](int axis, double to, double rate) {
    const double force =
        rig_.actuator_stiffness * (to - place[axis]) + damping * (rate * drive.time_scaling - speed[axis]);
    return std::clamp(force, -rig_.actuator_force_limit, rig_.actuator_force_limit);
  };
  Vector3d force(0, 0, along(2, command.z, command.vz));
  if (rig_.driven == Driven::xyz) {
    for (int axis = 0; axis < 2; ++axis) force[axis] = along(axis, command.xy[axis], command.v_plane[axis]);
  }
  return force;
}

double GripperRig::lag(const State& state, const RigDrive& drive, int g) const {
  const Vector3d place = joint(state.pads[size_t(g)]);
  const Command command = drive.schedule->command(g, state.time * drive.time_scaling);
  const double down = command.z - place.z();
  if (rig_.driven == Driven::z) return std::abs(down);
  return std::hypot((command.xy - place.head<2>()).norm(), down);
}

bool GripperRig::saturated(const State& state, const RigDrive& drive, int g) const {
  return actuator_force(state, drive, g).lpNorm<Eigen::Infinity>() >= rig_.actuator_force_limit;
}

/// Pads whose suction has ended at t lose their nodes. Velocities are continuous; kinetic energy is not
/// quite, since a pad's inertia counts that of its nodes about its normal for all axes: the difference is
/// booked.
void GripperRig::let_go(State& state, const RigDrive& drive) const {
  for (size_t g = 0; g < pads_.size(); ++g) {
    PadState& pad = state.pads[g];
    if (pad.released || !drive.schedule->released(int(g), state.time * drive.time_scaling)) continue;
    const Pad& body = pads_[g];
    const Eigen::Matrix3d turn = pad.rotation.toRotationMatrix();
    double change = -kinetic_energy(state, g);
    pad.released = true;
    change += 0.5 * (body.bare_mass * pad.velocity.squaredNorm() +
                     body.bare_inertia * pad.angular_velocity.squaredNorm());
    for (auto k = size_t(body.first); k < size_t(body.last); ++k) {
      const Vector3d v = pad.velocity + pad.angular_velocity.cross(turn * nodes_[k].offset);
      const Vector3d w = pad.angular_velocity.cross(turn.col(2));
      change += 0.5 * (nodes_[k].mass * v.squaredNorm() + nodes_[k].inertia * w.squaredNorm());
    }
    book(state, Book::release, change);
  }
}

/// Velocities at t + dt/2 as if there were no constraints.
void GripperRig::free_velocities(State& state, const RigDrive& drive, double alpha, const TiedFields& tied,
                                 RigScratch& s) const {
  const double h = state.kick_time();
  const Damped damped(h, alpha);
  for (size_t g = 0; g < pads_.size(); ++g) {
    const Pad& body = pads_[g];
    const PadState& pad = state.pads[g];
    const Eigen::Matrix3d turn = pad.rotation.toRotationMatrix();
    const Vector3d normal = turn.col(2), arm = rig_.joint_offset * normal;
    const double mass = body.mass_of(pad), inertia = body.inertia_of(pad);
    s.actuator[g] = actuator_force(state, drive, int(g));
    state.record.actuator_force =
        std::max(state.record.actuator_force, s.actuator[g].lpNorm<Eigen::Infinity>());
    Vector3d force = s.actuator[g], moment = arm.cross(s.actuator[g]);
    if (!pad.released) {
      Vec3<Lanes> of_nodes = lanes_of(Vector3d::Zero()), about = of_nodes, on_directors = of_nodes;
      for (const Patch& patch : body.patches) {
        const Vec3<Lanes> f = patch.tied * tied.force.lanes(patch.at);
        of_nodes = of_nodes + f;
        about = about + cross(state.position.lanes(patch.at) - lanes_of(pad.centre), f);
        on_directors = on_directors + patch.tied * tied.moment.lanes(patch.at);
      }
      force += sum_of(of_nodes);
      moment += sum_of(about) + normal.cross(sum_of(on_directors));
    }
    LinkBody& next = s.links.bodies[g];
    next = {.inverse_mass = 1 / mass, .inverse_inertia = 1 / inertia, .centre = pad.centre, .arm = arm};
    next.velocity = damped.keep * pad.velocity + damped.gain / mass * force;
    next.angular_velocity = damped.keep * pad.angular_velocity + damped.gain / inertia * moment;
    s.stop[g] = stop_.stop({normal, pad.angular_velocity, inertia, std::max(h, state.dt), damped.gain},
                           next.angular_velocity);
    s.free_v[g] = 0.5 * (pad.velocity + next.velocity);
    s.free_w[g] = 0.5 * (pad.angular_velocity + next.angular_velocity);
  }
}

/// Nodes of a released pad move on their own. `kick_nodes` has damped their velocities already, as of any
/// node.
void GripperRig::kick_released(State& state, const Pad& body, double alpha, const TiedFields& tied) const {
  const double h = state.kick_time();
  const Damped damped(h, alpha);
  double damping = 0;
  for (auto k = size_t(body.first); k < size_t(body.last); ++k) {
    const auto n = size_t(tied_[k]);
    const Tied& node = nodes_[k];
    const Vector3d d = get(state.director, n), v = get(state.velocity, n), w = get(state.director_rate, n);
    const Vector3d all = get(tied.moment, n), moment = all - all.dot(d) * d;
    const Vector3d v_new = v + damped.gain / node.mass * get(tied.force, n);
    const Vector3d w_new = w + damped.gain / node.inertia * moment;
    const Vector3d mean_v = 0.5 * (v / damped.keep + v_new), mean_w = 0.5 * (w / damped.keep + w_new);
    damping += node.mass * mean_v.squaredNorm() + node.inertia * mean_w.squaredNorm();
    set(tied.mean_v, n, mean_v);
    set(tied.mean_w, n, mean_w);
    set(state.velocity, n, v_new);
    set(state.director_rate, n, w_new);
  }
  book(state, Book::damping, -h * alpha * damping);
}

/// Takes over the velocities that meet the constraints; books work; gives tied nodes their mean velocities.
void GripperRig::book_pad(State& state, size_t g, double alpha, const TiedFields& tied, RigScratch& s) const {
  const double h = state.kick_time();
  const Pad& body = pads_[g];
  PadState& pad = state.pads[g];
  const LinkBody& next = s.links.bodies[g];
  const Vector3d mean_v = 0.5 * (pad.velocity + next.velocity);
  const Vector3d mean_w = 0.5 * (pad.angular_velocity + next.angular_velocity);
  s.joint_v[g] = mean_v + mean_w.cross(next.arm);
  book(state, Book::actuator, h * s.actuator[g].dot(s.joint_v[g]));
  book(state, Book::stop, h * s.stop[g].dot(mean_w));
  book(state, Book::damping,
       -h * alpha *
           (body.mass_of(pad) * s.free_v[g].dot(mean_v) + body.inertia_of(pad) * s.free_w[g].dot(mean_w)));
  pad.velocity = next.velocity;
  pad.angular_velocity = next.angular_velocity;
  if (pad.released) return kick_released(state, body, alpha, tied);
  const Vec3<Lanes> v = lanes_of(mean_v), w = lanes_of(mean_w), centre = lanes_of(pad.centre);
  const Vec3<Lanes> turn = lanes_of(mean_w.cross(pad.rotation * Vector3d::UnitZ()));
  for (const Patch& patch : body.patches) {
    set_tied(tied.mean_v, patch.at, patch.tied, v + cross(w, state.position.lanes(patch.at) - centre));
    set_tied(tied.mean_w, patch.at, patch.tied, turn);
  }
}

void GripperRig::kick(State& state, const RigDrive& drive, double alpha, const TiedFields& tied,
                      RigScratch& s) const {
  free_velocities(state, drive, alpha, tied, s);
  const LinkSystem::Outcome links = links_.meet(state.dt, drive.time_scaling * state.time,
                                                drive.time_scaling * (state.time + state.dt), s.links);
  state.record.link_error = std::max(state.record.link_error, links.error);
  s.converged = s.converged && links.converged;
  for (size_t g = 0; g < pads_.size(); ++g) book_pad(state, g, alpha, tied, s);
  book(state, Book::interlink, links_.work(s.links, s.joint_v));
}

void GripperRig::drift(State& state) const {
  const double dt = state.dt;
  for (size_t g = 0; g < pads_.size(); ++g) {
    PadState& pad = state.pads[g];
    pad.centre += dt * pad.velocity;
    const Vector3d turn = dt * pad.angular_velocity;
    const double angle = turn.norm();
    if (angle > 0)
      pad.rotation = (Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * pad.rotation).normalized();
    if (pad.released) continue;  // drift_nodes has moved its nodes
    const Eigen::Matrix3d rotation = pad.rotation.toRotationMatrix();
    const Vector3d d = rotation.col(2);
    const Vec3<Lanes> along1 = lanes_of(rotation.col(0)), along2 = lanes_of(rotation.col(1));
    const Vec3<Lanes> centre = lanes_of(pad.centre), v = lanes_of(pad.velocity),
                      spin = lanes_of(pad.angular_velocity);
    const Vec3<Lanes> normal = lanes_of(d), w = lanes_of(pad.angular_velocity.cross(d));
    for (const Patch& patch : pads_[g].patches) {
      const Vec3<Lanes> offset = patch.offset1 * along1 + patch.offset2 * along2;
      set_tied(state.position, patch.at, patch.tied, centre + offset);
      set_tied(state.velocity, patch.at, patch.tied, v + cross(spin, offset));
      set_tied(state.director, patch.at, patch.tied, normal);
      set_tied(state.director_rate, patch.at, patch.tied, w);
    }
  }
}

double GripperRig::kinetic_energy(const State& state, size_t g) const {
  const PadState& pad = state.pads[g];
  const Pad& body = pads_[g];
  double twice = body.mass_of(pad) * pad.velocity.squaredNorm() +
                 body.inertia_of(pad) * pad.angular_velocity.squaredNorm();
  for (auto k = size_t(body.first); pad.released && k < size_t(body.last); ++k) {
    const auto n = size_t(tied_[k]);
    twice += nodes_[k].mass * get(state.velocity, n).squaredNorm() +
             nodes_[k].inertia * get(state.director_rate, n).squaredNorm();
  }
  return 0.5 * twice;
}

double GripperRig::kinetic_energy(const State& state) const {
  double sum = 0;
  for (size_t g = 0; g < pads_.size(); ++g) sum += kinetic_energy(state, g);
  return sum;
}

void GripperRig::snapshot(const State& state, const RigDrive& drive, Snapshot& out) const {
  for (int g = 0; g < int(pads_.size()); ++g) {
    out.pad.push_back(state.pads[size_t(g)].centre);
    out.joint.push_back(joint(state.pads[size_t(g)]));
    out.actuator_force.push_back(actuator_force(state, drive, g).z());
  }
}

}  // namespace drapeplan
