#include "fem/rig/interlinks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drapeplan {
namespace {

using Eigen::Vector3d;

constexpr double kTolerance = 1e-12;  // of the grippers' spacing
constexpr int kIterations = 20;

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
    : pads_(rig.count()), tolerance_(kTolerance * rig.spacing) {
  for (const auto& [i, j] : interlinks(rig))
    rows_.push_back({.i = i, .j = j, .axis = -1, .value = rig.spacing});
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
  return s;
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

/// Cholesky factor of G M^-1 G^T within its envelope.
void LinkSystem::factorise(LinkScratch& s) const {
  std::fill(s.factor.begin(), s.factor.end(), 0.0);
  for (const Coupling& c : couplings_) {
    const LinkBody& body = s.bodies[size_t(c.pad)];
    const Vector3d& uk = s.direction[size_t(c.k)];
    const Vector3d& ul = s.direction[size_t(c.l)];
    s.factor[start_[size_t(c.k)] + size_t(c.l)] +=
        c.sign *
        (body.inverse_mass * uk.dot(ul) + body.inverse_inertia * body.arm.cross(uk).dot(body.arm.cross(ul)));
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
        row.j >= 0 ? (a - s.bodies[size_t(row.j)].joint).norm() - row.value : a[row.axis] - row.value;
    largest = std::max(largest, std::abs(s.residual[k]));
    if (!std::isfinite(s.residual[k])) return s.residual[k];
  }
  return largest;
}

LinkSystem::Outcome LinkSystem::meet(double dt, LinkScratch& s) const {
  if (rows_.empty()) return {};
  set_directions(s);
  std::fill(s.impulse.begin(), s.impulse.end(), 0.0);
  factorise(s);
  Outcome outcome;
  const double round_off = 4 * std::numeric_limits<double>::epsilon() * s.bodies.front().centre.norm();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    outcome.error = residuals(dt, s);
    if (outcome.error <= tolerance_ + round_off) return outcome;
    solve(s);
    for (size_t k = 0; k < rows_.size(); ++k) {
      const double impulse = -s.residual[k] / dt;
      s.impulse[k] += impulse;
      push(s.bodies[size_t(rows_[k].i)], impulse * s.direction[k]);
      if (rows_[k].j >= 0) push(s.bodies[size_t(rows_[k].j)], -impulse * s.direction[k]);
    }
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
