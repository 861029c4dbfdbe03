#include "fem/gripper_rig.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace drapeplan {
namespace {

using Eigen::Vector3d;

constexpr double kServoDamping = 1;  // damping ratio of a joint on its actuator: a servo does not ring
constexpr double kRimSlack = 1e-9;   // nodes on the rim belong to the pad, whatever the round-off
constexpr double kConstraintTolerance = 1e-12;  // of the grippers' spacing
constexpr int kConstraintIterations = 20;

std::string gripper_name(const RigOptions& rig, int index) {
  return "gripper [" + std::to_string(index % rig.columns + 1) + ", " +
         std::to_string(index / rig.columns + 1) + "]";
}

/// v turned by the rotation vector `turn` (exponential map).
Vector3d turned(const Vector3d& turn, const Vector3d& v) {
  const double angle = turn.norm();
  if (angle == 0) return v;
  return Eigen::AngleAxisd(angle, turn / angle) * v;
}

void book(State& state, Book entry, double work) {
  state.work[size_t(entry)] += work;
}

}  // namespace

GripperRig::GripperRig(const RigOptions& rig, const std::vector<Eigen::Vector2d>& rest,
                       const std::vector<double>& mass, const std::vector<double>& inertia,
                       std::vector<Eigen::Vector2d> place, double turn)
    : rig_(rig), place_(std::move(place)), turn_(turn) {
  std::vector<char> taken(rest.size(), 0);
  for (int g = 0; g < rig.count(); ++g) {
    Pad pad{.mass = rig.pad_mass, .inertia = 0, .first = int(tied_.size()), .last = 0};
    double spread = 0;
    for (size_t n = 0; n < rest.size(); ++n) {
      const Eigen::Vector2d offset = rest[n] - rig.place(g);
      if (offset.norm() > rig.pad_radius * (1 + kRimSlack)) continue;
      if (taken[n])
        throw std::invalid_argument(gripper_name(rig, g) + " shares a ply node with another gripper");
      taken[n] = 1;
      tied_.push_back(int(n));
      offset_.emplace_back(offset.x(), offset.y(), 0);
      pad.mass += mass[n];
      spread += mass[n] * offset.squaredNorm() + inertia[n];
    }
    pad.last = int(tied_.size());
    if (pad.last == pad.first) {
      throw std::invalid_argument(gripper_name(rig, g) + " has no ply node under its pad: refine the mesh");
    }
    pad.inertia = std::max(0.5 * pad.mass * rig.pad_radius * rig.pad_radius, spread);
    pads_.push_back(pad);
  }
  for (const auto& [i, j] : interlinks(rig))
    rows_.push_back({.i = i, .j = j, .axis = -1, .value = rig.spacing});
  if (rig.fixed) {
    const int g = ((*rig.fixed)[1] - 1) * rig.columns + (*rig.fixed)[0] - 1;
    for (int axis = 0; axis < 2; ++axis)
      rows_.push_back({.i = g, .j = -1, .axis = axis, .value = place_[size_t(g)][axis]});
  }
  // Rows by the last gripper that they touch: their couplings then stay near the diagonal.
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const Row& a, const Row& b) { return std::max(a.i, a.j) < std::max(b.i, b.j); });
  size_t size = 0;
  for (int k = 0; k < int(rows_.size()); ++k) {
    int first = k;
    for (int l = 0; l <= k; ++l) {
      for (const int a : {rows_[size_t(k)].i, rows_[size_t(k)].j}) {
        for (const int b : {rows_[size_t(l)].i, rows_[size_t(l)].j}) {
          if (a < 0 || a != b) continue;
          const bool same = (a == rows_[size_t(k)].i) == (b == rows_[size_t(l)].i);
          couplings_.push_back({k, l, a, same ? 1.0 : -1.0});
          first = std::min(first, l);
        }
      }
    }
    envelope_.push_back(first);
    start_.push_back(size - size_t(first));
    size += size_t(k - first + 1);
  }
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
      moment += mass[n] * offset_[k];
      spread += mass[n] * offset_[k].squaredNorm() + inertia[n];
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
  s.force.resize(tied_.size());
  s.moment.resize(tied_.size());
  s.mean_v.resize(tied_.size());
  s.mean_w.resize(tied_.size());
  s.next.resize(pads_.size());
  s.arm.resize(pads_.size());
  s.next_arm.resize(pads_.size());
  for (auto* list : {&s.free_mean_v, &s.free_mean_w, &s.stop, &s.joint_v}) list->resize(pads_.size());
  s.actuator.resize(pads_.size());
  s.direction.resize(rows_.size());
  s.residual.resize(rows_.size());
  s.impulse.resize(rows_.size());
  if (!rows_.empty()) s.factor.resize(start_.back() + rows_.size());
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

double GripperRig::actuator_force(const State& state, const RigDrive& drive, int g) const {
  const PadState& pad = state.pads[size_t(g)];
  const Vector3d arm = joint(pad) - pad.centre;
  const Command command = drive.schedule->command(g, state.time * drive.time_scaling);
  const double damping = 2 * kServoDamping * std::sqrt(rig_.actuator_stiffness * pads_[size_t(g)].mass);
  const double speed = (pad.velocity + pad.angular_velocity.cross(arm)).z();
  const double force = rig_.actuator_stiffness * (command.z - pad.centre.z() - arm.z()) +
                       damping * (command.vz * drive.time_scaling - speed);
  return std::clamp(force, -rig_.actuator_force_limit, rig_.actuator_force_limit);
}

/// Velocities at t + dt/2 as if there were no constraints.
void GripperRig::free_velocities(State& state, const RigDrive& drive, double alpha, RigScratch& s) const {
  const double h = state.kick_time();
  const double keep = (1 - 0.5 * alpha * h) / (1 + 0.5 * alpha * h), gain = h / (1 + 0.5 * alpha * h);
  for (size_t g = 0; g < pads_.size(); ++g) {
    const Pad& body = pads_[g];
    const PadState& pad = state.pads[g];
    const Eigen::Matrix3d turn = pad.rotation.toRotationMatrix();
    const Vector3d normal = turn.col(2);
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    for (auto k = size_t(body.first); k < size_t(body.last); ++k) {
      force += s.force[k];
      moment += (turn * offset_[k]).cross(s.force[k]) + normal.cross(s.moment[k]);
    }
    s.arm[g] = rig_.joint_offset * normal;
    const double push = actuator_force(state, drive, int(g));
    state.record.actuator_force = std::max(state.record.actuator_force, std::abs(push));
    s.actuator[g] = push;
    force.z() += push;
    moment += s.arm[g].cross(Vector3d(0, 0, push));
    s.stop[g] = stop_moment(normal);
    moment += s.stop[g];
    s.next[g] = pad;
    s.next[g].velocity = keep * pad.velocity + gain / body.mass * force;
    s.next[g].angular_velocity = keep * pad.angular_velocity + gain / body.inertia * moment;
    s.free_mean_v[g] = 0.5 * (pad.velocity + s.next[g].velocity);
    s.free_mean_w[g] = 0.5 * (pad.angular_velocity + s.next[g].angular_velocity);
  }
}

/// Moment that turns a pad back from its tilt limit, as stiff as its actuator at the pad's rim.
Vector3d GripperRig::stop_moment(const Vector3d& normal) const {
  if (normal.z() >= std::cos(rig_.tilt_limit)) return Vector3d::Zero();
  const double beyond = std::acos(std::clamp(normal.z(), -1.0, 1.0)) - rig_.tilt_limit;
  const Vector3d axis = Vector3d::UnitZ().cross(normal).normalized();
  return -(rig_.actuator_stiffness * rig_.pad_radius * rig_.pad_radius * beyond) * axis;
}

/// Lengths and coordinates at t + dt less what they should be, for the velocities in s.next. Returns the
/// largest.
double GripperRig::residuals(const State& state, RigScratch& s) const {
  const double dt = state.dt;
  for (size_t g = 0; g < pads_.size(); ++g) {
    s.next[g].centre = state.pads[g].centre + dt * s.next[g].velocity;
    s.next_arm[g] = turned(dt * s.next[g].angular_velocity, s.arm[g]);
  }
  double largest = 0;
  for (size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    const Vector3d a = s.next[size_t(row.i)].centre + s.next_arm[size_t(row.i)];
    if (row.j >= 0) {
      const Vector3d b = s.next[size_t(row.j)].centre + s.next_arm[size_t(row.j)];
      s.residual[k] = (a - b).norm() - row.value;
    } else {
      s.residual[k] = a[row.axis] - row.value;
    }
    largest = std::max(largest, std::abs(s.residual[k]));
    if (!std::isfinite(s.residual[k])) return s.residual[k];
  }
  return largest;
}

/// Cholesky factor of G M^-1 G^T within its envelope.
void GripperRig::factorise(RigScratch& s) const {
  std::fill(s.factor.begin(), s.factor.end(), 0.0);
  for (const Coupling& c : couplings_) {
    const Pad& body = pads_[size_t(c.pad)];
    const Vector3d& uk = s.direction[size_t(c.k)];
    const Vector3d& ul = s.direction[size_t(c.l)];
    const Vector3d& arm = s.arm[size_t(c.pad)];
    s.factor[start_[size_t(c.k)] + size_t(c.l)] +=
        c.sign * (uk.dot(ul) / body.mass + arm.cross(uk).dot(arm.cross(ul)) / body.inertia);
  }
  for (size_t k = 0; k < rows_.size(); ++k) {
    for (auto l = size_t(envelope_[k]); l <= k; ++l) {
      double sum = s.factor[start_[k] + l];
      for (size_t m = size_t(std::max(envelope_[k], envelope_[l])); m < l; ++m) {
        sum -= s.factor[start_[k] + m] * s.factor[start_[l] + m];
      }
      s.factor[start_[k] + l] = l == k ? std::sqrt(sum) : sum / s.factor[start_[l] + l];
    }
  }
}

/// Newton's method for the impulses that meet all rows at t + dt; the matrix stays that of t.
void GripperRig::meet_constraints(State& state, RigScratch& s) const {
  for (size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    const auto i = size_t(row.i);
    s.direction[k] = row.j < 0 ? Vector3d(Vector3d::Unit(row.axis))
                               : Vector3d((state.pads[i].centre + s.arm[i] -
                                           state.pads[size_t(row.j)].centre - s.arm[size_t(row.j)])
                                              .normalized());
    s.impulse[k] = 0;
  }
  factorise(s);
  double error = 0;
  const double round_off = 4 * std::numeric_limits<double>::epsilon() * state.pads.front().centre.norm();
  for (int iteration = 0; iteration < kConstraintIterations; ++iteration) {
    error = residuals(state, s);
    if (error <= kConstraintTolerance * rig_.spacing + round_off) {
      state.record.link_error = std::max(state.record.link_error, error);
      return;
    }
    for (size_t k = 0; k < rows_.size(); ++k) {  // forward
      for (auto l = size_t(envelope_[k]); l < k; ++l)
        s.residual[k] -= s.factor[start_[k] + l] * s.residual[l];
      s.residual[k] /= s.factor[start_[k] + k];
    }
    for (size_t k = rows_.size(); k-- > 0;) {  // backward
      s.residual[k] /= s.factor[start_[k] + k];
      for (auto l = size_t(envelope_[k]); l < k; ++l)
        s.residual[l] -= s.factor[start_[k] + l] * s.residual[k];
    }
    for (size_t k = 0; k < rows_.size(); ++k) {
      const double impulse = -s.residual[k] / state.dt;
      s.impulse[k] += impulse;
      push(s, rows_[k].i, impulse * s.direction[k]);
      if (rows_[k].j >= 0) push(s, rows_[k].j, -impulse * s.direction[k]);
    }
  }
  state.record.link_error = std::max(state.record.link_error, error);
  s.converged = false;
}

/// Impulse [N s] on the joint of gripper g.
void GripperRig::push(RigScratch& s, int g, const Vector3d& impulse) const {
  s.next[size_t(g)].velocity += impulse / pads_[size_t(g)].mass;
  s.next[size_t(g)].angular_velocity += s.arm[size_t(g)].cross(impulse) / pads_[size_t(g)].inertia;
}

void GripperRig::kick(State& state, const RigDrive& drive, double alpha, RigScratch& s) const {
  free_velocities(state, drive, alpha, s);
  meet_constraints(state, s);
  const double h = state.kick_time();
  for (size_t g = 0; g < pads_.size(); ++g) {
    PadState& pad = state.pads[g];
    const Vector3d mean_v = 0.5 * (pad.velocity + s.next[g].velocity);
    const Vector3d mean_w = 0.5 * (pad.angular_velocity + s.next[g].angular_velocity);
    const Vector3d joint_v = mean_v + mean_w.cross(s.arm[g]);
    book(state, Book::actuator, h * s.actuator[g] * joint_v.z());
    book(state, Book::stop, h * s.stop[g].dot(mean_w));
    book(
        state, Book::damping,
        -h * alpha *
            (pads_[g].mass * s.free_mean_v[g].dot(mean_v) + pads_[g].inertia * s.free_mean_w[g].dot(mean_w)));
    const Eigen::Matrix3d turn = pad.rotation.toRotationMatrix();
    for (auto k = size_t(pads_[g].first); k < size_t(pads_[g].last); ++k) {
      s.mean_v[k] = mean_v + mean_w.cross(turn * offset_[k]);
      s.mean_w[k] = mean_w.cross(turn.col(2));
    }
    s.joint_v[g] = joint_v;
    pad.velocity = s.next[g].velocity;
    pad.angular_velocity = s.next[g].angular_velocity;
  }
  double work = 0;
  for (size_t k = 0; k < rows_.size(); ++k) {
    const Vector3d other = rows_[k].j < 0 ? Vector3d::Zero() : s.joint_v[size_t(rows_[k].j)];
    work += s.impulse[k] * s.direction[k].dot(s.joint_v[size_t(rows_[k].i)] - other);
  }
  book(state, Book::interlink, work);
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
    const Eigen::Matrix3d rotation = pad.rotation.toRotationMatrix();
    for (auto k = size_t(pads_[g].first); k < size_t(pads_[g].last); ++k) {
      const auto n = size_t(tied_[k]);
      const Vector3d x = pad.centre + rotation * offset_[k];
      const Vector3d v = pad.velocity + pad.angular_velocity.cross(rotation * offset_[k]);
      const Vector3d d = rotation.col(2), w = pad.angular_velocity.cross(d);
      state.x.x[n] = x.x(), state.x.y[n] = x.y(), state.x.z[n] = x.z();
      state.v.x[n] = v.x(), state.v.y[n] = v.y(), state.v.z[n] = v.z();
      state.d.x[n] = d.x(), state.d.y[n] = d.y(), state.d.z[n] = d.z();
      state.w.x[n] = w.x(), state.w.y[n] = w.y(), state.w.z[n] = w.z();
    }
  }
}

double GripperRig::kinetic_energy(const State& state) const {
  double sum = 0;
  for (size_t g = 0; g < pads_.size(); ++g) {
    sum += 0.5 * (pads_[g].mass * state.pads[g].velocity.squaredNorm() +
                  pads_[g].inertia * state.pads[g].angular_velocity.squaredNorm());
  }
  return sum;
}

void GripperRig::snapshot(const State& state, const RigDrive& drive, Snapshot& out) const {
  for (int g = 0; g < int(pads_.size()); ++g) {
    out.pad.push_back(state.pads[size_t(g)].centre);
    out.joint.push_back(joint(state.pads[size_t(g)]));
    out.actuator_force.push_back(actuator_force(state, drive, g));
  }
}

}  // namespace drapeplan
