#include "fem/rig/interlinks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;

constexpr double kTolerance = 1e-12;  // of the grippers' spacing
constexpr int kIterations = 20;
constexpr int kIterationsWithStops = 60;  // stops are hit and let go one after another

/// v turned by the rotation vector `turn` (exponential map).
Vector3d turned(const Vector3d& turn, const Vector3d& v) {
  const double angle = turn.norm();
  if (angle == 0) return v;
  return Eigen::AngleAxisd(angle, turn / angle) * v;
}

/// Impulse [N s] on the joint of a body.
void push(LinkBody& body, const Vector3d& impulse) {
  body.velocity += body.inverse_mass * impulse;
  body.angular_velocity += body.inverse_inertia * body.arm.cross(impulse);
}

}  // namespace

LinkSystem::LinkSystem(const RigOptions& rig, const std::vector<Eigen::Vector2d>& place)
    : pads_(rig.count()),
      tolerance_(kTolerance * rig.spacing),
      options_(rig.interlinks.value_or(InterlinkOptions())),
      closes_(!options_.lengths.empty()),
      springs_(options_.stiffness.has_value()),
      play_(options_.has_play()) {
  const std::vector<std::array<int, 2>> pairs = interlinks(rig);
  if (closes_ && options_.lengths.size() != pairs.size())
    throw WrongInput(fmt::format("{} lengths for {} interlinks", options_.lengths.size(), pairs.size()));
  if (closes_ && !(options_.closing[0] < options_.closing[1]))
    throw WrongInput("interlinks cannot jump to their lengths: the closing needs time");
  if (springs_) damping_ = 2 * options_.damping_ratio * std::sqrt(*options_.stiffness * 0.5 * rig.pad_mass);
  const bool loose = springs_ && !(*options_.stiffness > 0);
  for (size_t k = 0; k < pairs.size() && !loose; ++k)
    rows_.push_back({pairs[k][0], pairs[k][1], -1, rig.spacing, interlink_length(rig, k)});
  if (rig.fixed) {
    const int g = rig.gripper_at(*rig.fixed);
    for (int axis = 0; axis < 2; ++axis)
      rows_.push_back({.i = g, .j = -1, .axis = axis, .value = place[size_t(g)][axis]});
  }
  // Rows by the last gripper that they touch: their couplings then stay near the diagonal.
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const Row& a, const Row& b) { return std::max(a.i, a.j) < std::max(b.i, b.j); });
  couple();
}

void LinkSystem::couple() {
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

LinkScratch LinkSystem::scratch() const {
  LinkScratch s;
  s.bodies.resize(size_t(pads_));
  s.direction.resize(rows_.size());
  s.residual.resize(rows_.size());
  s.impulse.resize(rows_.size());
  if (!rows_.empty()) s.factor.resize(start_.back() + rows_.size());
  for (const Row& row : rows_) s.value.push_back(row.value);
  if (play_) s.side.resize(rows_.size());
  if (springs_) s.at_start.resize(rows_.size());
  return s;
}

/// Lengths of interlinks that close, at a time of the schedule; the second derivative is continuous.
void LinkSystem::set_values(double time, LinkScratch& s) const {
  const double x =
      std::clamp((time - options_.closing[0]) / (options_.closing[1] - options_.closing[0]), 0.0, 1.0);
  const double share = x * x * x * (10 - 15 * x + 6 * x * x);
  for (size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    if (row.j >= 0) s.value[k] = row.value + share * (row.closed - row.value);
  }
}

/// Directions of all rows at t.
void LinkSystem::set_directions(LinkScratch& s) const {
  for (size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    if (row.j < 0) {
      s.direction[k] = Vector3d::Unit(row.axis);
      continue;
    }
    const LinkBody &a = s.bodies[size_t(row.i)], &b = s.bodies[size_t(row.j)];
    s.direction[k] = (a.centre + a.arm - b.centre - b.arm).normalized();
  }
}

// The force at the end of the step damps as a dashpot of stiffness times dt would (backward Euler): the
// dashpot is less by that, so that a spring damps by its own ratio where the step resolves it.
LinkSystem::Spring LinkSystem::spring_of(double dt) const {
  if (!springs_) return {};
  const double by_step = *options_.stiffness * dt;
  return {1 / std::max(by_step, damping_), std::max(0.0, damping_ - by_step)};
}

/// What the dashpots count from: lengths at t beyond those at rest. `s.value` holds the lengths at t.
void LinkSystem::set_springs(double dt, LinkScratch& s) const {
  const Spring spring = spring_of(dt);
  for (size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    if (row.j < 0) continue;
    const LinkBody &a = s.bodies[size_t(row.i)], &b = s.bodies[size_t(row.j)];
    const double over = (a.centre + a.arm - b.centre - b.arm).norm() - s.value[k];
    s.at_start[k] = spring.give * spring.dashpot *
                    (std::max(0.0, over - options_.play[1]) + std::min(0.0, over + options_.play[0]));
  }
}

bool LinkSystem::acts(const LinkScratch& s, size_t row) const {
  return !play_ || rows_[row].j < 0 || s.side[row] != 0;
}

/// Cholesky factor of G M^-1 G^T, and on its diagonal what springs give way, within its envelope. Stops that
/// do not act have a row of their own, with 1 on the diagonal.
void LinkSystem::factorise(double dt, LinkScratch& s) const {
  std::fill(s.factor.begin(), s.factor.end(), 0.0);
  for (const Coupling& c : couplings_) {
    if (play_ && !(acts(s, size_t(c.k)) && acts(s, size_t(c.l)))) continue;
    const LinkBody& body = s.bodies[size_t(c.pad)];
    const Vector3d& uk = s.direction[size_t(c.k)];
    const Vector3d& ul = s.direction[size_t(c.l)];
    s.factor[start_[size_t(c.k)] + size_t(c.l)] +=
        c.sign *
        (body.inverse_mass * uk.dot(ul) + body.inverse_inertia * body.arm.cross(uk).dot(body.arm.cross(ul)));
  }
  if (springs_ || play_) {
    const double give = spring_of(dt).give / dt;
    for (size_t k = 0; k < rows_.size(); ++k) {
      double& diagonal = s.factor[start_[k] + k];
      if (!acts(s, k)) diagonal = 1;
      if (rows_[k].j >= 0 && acts(s, k)) diagonal += give;
    }
  }
  eliminate(s);
}

void LinkSystem::eliminate(LinkScratch& s) const {
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

/// s.residual becomes the solution of the system with s.residual on the right.
void LinkSystem::solve(LinkScratch& s) const {
  for (size_t k = 0; k < rows_.size(); ++k) {  // forward
    for (auto l = size_t(envelope_[k]); l < k; ++l) s.residual[k] -= s.factor[start_[k] + l] * s.residual[l];
    s.residual[k] /= s.factor[start_[k] + k];
  }
  for (size_t k = rows_.size(); k-- > 0;) {  // backward
    s.residual[k] /= s.factor[start_[k] + k];
    for (auto l = size_t(envelope_[k]); l < k; ++l) s.residual[l] -= s.factor[start_[k] + l] * s.residual[k];
  }
}

void LinkSystem::push_apart(size_t k, double impulse, LinkScratch& s) const {
  s.impulse[k] += impulse;
  push(s.bodies[size_t(rows_[k].i)], impulse * s.direction[k]);
  if (rows_[k].j >= 0) push(s.bodies[size_t(rows_[k].j)], -impulse * s.direction[k]);
}

/// Lengths and coordinates at t + dt less what they should be, for the bodies' velocities. Returns the
/// largest, or what is not finite.
double LinkSystem::residuals(double dt, LinkScratch& s) const {
  for (LinkBody& body : s.bodies) {
    body.joint = body.centre + dt * body.velocity + turned(dt * body.angular_velocity, body.arm);
  }
  double largest = 0;
  for (size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    const Vector3d& a = s.bodies[size_t(row.i)].joint;
    s.residual[k] =
        row.j >= 0 ? (a - s.bodies[size_t(row.j)].joint).norm() - s.value[k] : a[row.axis] - s.value[k];
    largest = std::max(largest, std::abs(s.residual[k]));
    if (!std::isfinite(s.residual[k])) return s.residual[k];
  }
  return largest;
}

/// Residuals of springs and stops out of those of bars. A stop is hit where the length passes it, and lets go
/// where it would have to hold back; `changed` says that one did.
double LinkSystem::soften(double dt, LinkScratch& s, bool& changed) const {
  const double give = spring_of(dt).give;
  double largest = 0;
  for (size_t k = 0; k < rows_.size(); ++k) {
    if (rows_[k].j >= 0 && play_) {
      const double over = s.residual[k];
      int side = s.side[k];
      if (side != 0 && side * s.impulse[k] > 0) side = 0;
      if (side == 0 && over > options_.play[1] + tolerance_) side = 1;
      if (side == 0 && over < -options_.play[0] - tolerance_) side = -1;
      if (side != s.side[k]) {
        changed = true;
        push_apart(k, -s.impulse[k], s);
        s.side[k] = side;
      }
      s.residual[k] = side > 0 ? over - options_.play[1] : side < 0 ? over + options_.play[0] : 0;
    }
    if (rows_[k].j >= 0 && springs_ && acts(s, k)) s.residual[k] += give * s.impulse[k] - s.at_start[k];
    largest = std::max(largest, std::abs(s.residual[k]));
    if (!std::isfinite(s.residual[k])) return s.residual[k];
  }
  return largest;
}

LinkSystem::Outcome LinkSystem::meet(double dt, double from, double to, LinkScratch& s) const {
  if (rows_.empty()) return {};
  set_directions(s);
  std::fill(s.impulse.begin(), s.impulse.end(), 0.0);
  std::fill(s.side.begin(), s.side.end(), 0);
  if (closes_ && springs_) set_values(from, s);
  if (springs_) set_springs(dt, s);
  if (closes_) set_values(to, s);
  factorise(dt, s);
  Outcome outcome;
  const double round_off = 4 * std::numeric_limits<double>::epsilon() * s.bodies.front().centre.norm();
  const int iterations = play_ ? kIterationsWithStops : kIterations;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    outcome.error = residuals(dt, s);
    if (springs_ || play_) {
      bool changed = false;
      outcome.error = soften(dt, s, changed);
      if (changed) {
        factorise(dt, s);
        continue;
      }
    }
    if (outcome.error <= tolerance_ + round_off) return outcome;
    solve(s);
    for (size_t k = 0; k < rows_.size(); ++k) push_apart(k, -s.residual[k] / dt, s);
  }
  outcome.converged = false;
  return outcome;
}

double LinkSystem::work(const LinkScratch& s, const std::vector<Vector3d>& joint_v) const {
  double work = 0;
  for (size_t k = 0; k < rows_.size(); ++k) {
    const Vector3d other = rows_[k].j < 0 ? Vector3d::Zero() : joint_v[size_t(rows_[k].j)];
    work += s.impulse[k] * s.direction[k].dot(joint_v[size_t(rows_[k].i)] - other);
  }
  return work;
}

}  // namespace drapeplan
