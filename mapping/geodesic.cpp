#include "mapping/geodesic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

// A point that moves along a geodesic with unit speed, with the scalar Jacobi field: the distance, per radian
// of starting angle, by which neighbouring geodesics from the same start are apart.
struct Walker {
  Eigen::Vector2d at{0, 0};        // x, y [m]
  Eigen::Vector2d velocity{0, 0};  // d(x, y) / ds [-]
  double jacobi = 0;               // [m]
  double jacobi_rate = 1;          // [-]
};

Walker moved(const Walker& from, const Walker& rate, double ds) {
  return {from.at + ds * rate.at, from.velocity + ds * rate.velocity, from.jacobi + ds * rate.jacobi,
          from.jacobi_rate + ds * rate.jacobi_rate};
}

// Geodesic equation of a height field: x'' = -zx q / w, y'' = -zy q / w with the second form
// q = zxx x'^2 + 2 zxy x' y' + zyy y'^2 and w = 1 + zx^2 + zy^2. Jacobi equation: j'' = -K j.
Walker rate_of(const Mold& mold, const Walker& walker) {
  const Jet f = mold.jet(walker.at.x(), walker.at.y());
  const double a = walker.velocity.x(), b = walker.velocity.y();
  const double q = f.zxx * a * a + 2 * f.zxy * a * b + f.zyy * b * b;
  const double w = 1 + f.zx * f.zx + f.zy * f.zy;
  const double curvature = (f.zxx * f.zyy - f.zxy * f.zxy) / (w * w);
  return {walker.velocity, -q / w * Eigen::Vector2d(f.zx, f.zy), walker.jacobi_rate,
          -curvature * walker.jacobi};
}

Walker runge_kutta_step(const Mold& mold, const Walker& w, double ds) {
  const Walker k1 = rate_of(mold, w);
  const Walker k2 = rate_of(mold, moved(w, k1, ds / 2));
  const Walker k3 = rate_of(mold, moved(w, k2, ds / 2));
  const Walker k4 = rate_of(mold, moved(w, k3, ds));
  return moved(moved(moved(moved(w, k1, ds / 6), k2, ds / 3), k3, ds / 3), k4, ds / 6);
}

bool is_finite(const Walker& w) {
  return w.at.allFinite() && w.velocity.allFinite() && std::isfinite(w.jacobi) &&
         std::isfinite(w.jacobi_rate);
}

Eigen::Vector3d tangent(const Mold& mold, const Eigen::Vector2d& at, const Eigen::Vector2d& direction) {
  const Jet f = mold.jet(at.x(), at.y());
  return Eigen::Vector3d(direction.x(), direction.y(), f.zx * direction.x() + f.zy * direction.y())
      .normalized();
}

[[noreturn]] void throw_at(const char* what, const Eigen::Vector2d& at) {
  throw NotFinished(fmt::format("{} (x, y) = ({:g}, {:g}) m", what, at.x(), at.y()));
}

// Shooting: a fixed number of steps, so that the end point is a smooth function of angle and length. 256
// steps put a path of one radian of turning within 1e-11 of its length.
constexpr int kShootingSteps = 256;
constexpr double kGoalTolerance = 1e-12;  // [m]
constexpr int kMaxShots = 60;
constexpr int kMaxHalvings = 30;

struct Shot {
  Walker end;
  Eigen::Vector2d miss;  // goal minus end in the x-y plane [m]
};

// The tangent plane at the start with orthonormal axes; a shot is an angle in it and a length.
struct Gun {
  const Mold& mold;
  Eigen::Vector2d start, goal;
  Eigen::Vector3d first, second;

  [[nodiscard]] Eigen::Vector2d velocity(double angle) const {
    return (std::cos(angle) * first + std::sin(angle) * second).head<2>();
  }
  [[nodiscard]] Shot fire(double angle, double length) const {
    Walker walker{start, velocity(angle)};
    for (int k = 0; k < kShootingSteps; ++k) walker = runge_kutta_step(mold, walker, length / kShootingSteps);
    return {walker, goal - walker.at};
  }
};

// Newton step (angle, length): the end moves along the tangent with the length and across it by the Jacobi
// field.
Eigen::Vector2d correction(const Mold& mold, const Shot& shot) {
  const Eigen::Vector3d along = tangent(mold, shot.end.at, shot.end.velocity);
  const Eigen::Vector3d across = mold.normal(shot.end.at.x(), shot.end.at.y()).cross(along);
  Eigen::Matrix2d sensitivity;
  sensitivity.col(0) = shot.end.jacobi * across.head<2>();
  sensitivity.col(1) = along.head<2>();
  return sensitivity.inverse() * shot.miss;
}

}  // namespace

Geodesic shoot_geodesic(const Mold& mold, const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                        double step, int count) {
  if (!(step > 0)) throw std::invalid_argument("shoot_geodesic: step must be > 0 m");
  if (!(direction.norm() > 0)) throw std::invalid_argument("shoot_geodesic: direction has no length");
  Geodesic line;
  line.points.reserve(count > 0 ? static_cast<size_t>(count) + 1 : 1);
  Walker walker{start, tangent(mold, start, direction).head<2>()};
  line.points.push_back(mold.point(start.x(), start.y()));
  if (!is_finite(walker) || !line.points.back().allFinite())
    throw_at("geodesic: no mold at the start", start);
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector2d before = walker.at;
    walker = runge_kutta_step(mold, walker, step);
    const Eigen::Vector3d point = mold.point(walker.at.x(), walker.at.y());
    if (!is_finite(walker) || !point.allFinite()) throw_at("geodesic: the mold ends beyond", before);
    line.points.push_back(point);
  }
  line.end_direction = tangent(mold, walker.at, walker.velocity);
  return line;
}

Eigen::Vector2d geodesic_direction(const Mold& mold, const Eigen::Vector2d& start,
                                   const Eigen::Vector2d& goal) {
  const Eigen::Vector3d from = mold.point(start.x(), start.y());
  const Eigen::Vector3d to = mold.point(goal.x(), goal.y());
  if (!from.allFinite()) throw_at("geodesic: no mold at the start", start);
  if (!to.allFinite()) throw_at("geodesic: no mold at the goal", goal);
  if (!((goal - start).norm() > kGoalTolerance)) throw_at("geodesic: start and goal coincide at", goal);

  const Eigen::Vector3d first = tangent(mold, start, goal - start);
  const Gun gun{mold, start, goal, first, mold.normal(start.x(), start.y()).cross(first)};
  double angle = 0, length = (to - from).norm();
  Shot shot = gun.fire(angle, length);
  for (int k = 0; k < kMaxHalvings && !is_finite(shot.end); ++k) shot = gun.fire(angle, length /= 2);
  for (int k = 0; k < kMaxShots && !(shot.miss.norm() <= kGoalTolerance); ++k) {
    const Eigen::Vector2d change = correction(mold, shot);
    double factor = 1;
    Shot next = gun.fire(angle + change.x(), length + change.y());
    for (int h = 0; h < kMaxHalvings && !(next.miss.norm() < shot.miss.norm()); ++h) {
      factor /= 2;
      next = gun.fire(angle + factor * change.x(), length + factor * change.y());
    }
    if (!(next.miss.norm() < shot.miss.norm())) throw_at("geodesic: found no line to", goal);
    angle += factor * change.x();
    length += factor * change.y();
    shot = next;
  }
  if (!(shot.miss.norm() <= kGoalTolerance)) throw_at("geodesic: found no line to", goal);
  return gun.velocity(angle).normalized();
}

TrackWalker::TrackWalker(const Mold& mold, std::vector<Eigen::Vector2d> track)
    : mold_(mold), track_(std::move(track)), lengths_{0} {
  if (track_.size() < 2) throw std::invalid_argument("TrackWalker: a track has two points at least");
  for (size_t k = 1; k < track_.size(); ++k)
    lengths_.push_back(lengths_.back() + (track_[k] - track_[k - 1]).norm());
  heading_ = (track_[1] - track_[0]).normalized();
}

Eigen::Vector3d TrackWalker::next(const Eigen::Vector3d& from, double chord) {
  constexpr int kParts = 8, kBisections = 60;
  double near = at_, far = at_;
  const auto apart = [&](double at) { return (place(at) - from).norm(); };
  while (apart(far) < chord) {
    near = far;
    far += chord / kParts;
  }
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (near + far);
    (apart(middle) < chord ? near : far) = middle;
  }
  at_ = far;
  return place(far);
}

Eigen::Vector3d TrackWalker::place(double at) {
  const auto after = std::lower_bound(lengths_.begin() + 1, lengths_.end(), at);
  const size_t k = std::min(size_t(after - lengths_.begin()), track_.size() - 1) - 1;
  heading_ = (track_[k + 1] - track_[k]).normalized();
  if (after == lengths_.end()) {
    const Geodesic line = shoot_geodesic(mold_, track_.back(), heading_, at - lengths_.back(), 1);
    heading_ = line.end_direction.head<2>();
    return line.points.back();
  }
  const Eigen::Vector2d xy = track_[k] + (at - lengths_[k]) * heading_;
  const Eigen::Vector3d point = mold_.point(xy.x(), xy.y());
  if (!point.allFinite()) throw_at("no mold under the track at", xy);
  return point;
}

}  // namespace drapeplan
