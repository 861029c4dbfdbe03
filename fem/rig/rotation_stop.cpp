#include "fem/rig/rotation_stop.hpp"

#include <algorithm>
#include <cmath>

namespace drapeplan {
namespace {

using Eigen::Vector3d;

// Angle per step of a pad on its stop. An undamped mode is stable up to 2, whose square adds up with that of
// the ply under the pad, at most (2 step_safety)^2 times the ply's share of the inertia: 0.5 always fits.
constexpr double kStopStep = 0.5;

}  // namespace

RotationStop::RotationStop(const RigOptions& rig, double turn)
    : tilt_limit_(rig.tilt_limit),
      cosine_(std::cos(rig.tilt_limit)),
      limits_(rig.rotation_limits),
      warp_(std::cos(turn), std::sin(turn), 0),
      weft_(-std::sin(turn), std::cos(turn), 0) {}

/// Hands over the limits that are exceeded; of two opposite limits only one can be.
template <class Visit>
void RotationStop::for_each_limit(const Vector3d& n, Visit visit) const {
  if (n.z() < cosine_) {
    const Vector3d axis = Vector3d::UnitZ().cross(n);
    const double sine = axis.norm();
    if (sine > 0) visit(Limit{std::atan2(sine, n.z()) - tilt_limit_, axis / sine});
  }
  if (!limits_) return;
  // angle = atan2(a, n_z) with a = s n . e; a turn w changes n by w x n, so the gradient is n x d angle / d
  // n.
  const auto about = [&](const Vector3d& e, double s, const Eigen::Vector2d& range) {
    const double a = s * n.dot(e), squared = a * a + n.z() * n.z();
    const double angle = std::atan2(a, n.z());
    if (angle >= range[0] && angle <= range[1]) return;
    const Vector3d gradient = n.cross((n.z() * s * e - a * Vector3d::UnitZ()) / squared);
    if (angle > range[1]) visit(Limit{angle - range[1], gradient});
    if (angle < range[0]) visit(Limit{range[0] - angle, -gradient});
  };
  about(weft_, -1, limits_->about_warp);
  about(warp_, 1, limits_->about_weft);
}

Vector3d RotationStop::stop(const Kick& kick, Vector3d& after) const {
  Vector3d moment = Vector3d::Zero();
  const double frequency = kStopStep / kick.dt;
  for_each_limit(kick.normal, [&](const Limit& limit) {
    // Along the gradient g the pad has the inertia J / |g|^2. Critical damping with the mean of both
    // velocities costs no step; it is solved for the new velocity, linear in the push.
    const double rates = limit.gradient.dot(kick.before + after);
    const double acceleration =
        (frequency * frequency * limit.excess + frequency * rates) / (1 + frequency * kick.gain);
    if (!(acceleration > 0)) return;
    const Vector3d push = -kick.inertia * acceleration / limit.gradient.squaredNorm() * limit.gradient;
    after += kick.gain / kick.inertia * push;
    moment += push;
  });
  return moment;
}

}  // namespace drapeplan
