#include "planner/schedule/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drapeplan {
namespace {

/// One third of the tolerance is for the pieces of a cubic, the rest for the thinning [m].
constexpr double kPieces = kMotionTolerance / 3, kThinning = kMotionTolerance - kPieces;
constexpr double kMostPieces = 200;  // of the cubic between two samples: velocities that do not fit need more
constexpr double kLevel = 1e-4;      // [m], noise of encoders and of a rig that hangs flat

template <int D>
using Place = Eigen::Matrix<double, D, 1>;

/// Points of a path, and those that have to stay: where a rest begins or ends.
template <int D>
struct Points {
  std::vector<double> time;
  std::vector<Place<D>> place;
  std::vector<bool> stays;

  void add(double t, const Place<D>& p, bool stay) {
    time.push_back(t);
    place.push_back(p);
    stays.push_back(stay);
  }
};

/// Adds points between two samples so that straight lines between them are within half of the tolerance of
/// the cubic.
template <int D>
void add_cubic(double t0, double t1, const Place<D>& p0, const Place<D>& p1, const Place<D>& v0,
               const Place<D>& v1, Points<D>& points) {
  const double step = t1 - t0;
  const Place<D> slope = (p1 - p0) / step;
  const Place<D> bend0 = (6 * slope - 4 * v0 - 2 * v1) / step, bend1 = (2 * v0 + 4 * v1 - 6 * slope) / step;
  const double bend =
      std::max(bend0.template lpNorm<Eigen::Infinity>(), bend1.template lpNorm<Eigen::Infinity>());
  const double pieces = std::clamp(std::ceil(step * std::sqrt(bend / (8 * kPieces))), 1.0, kMostPieces);
  for (int k = 1; k < int(pieces); ++k) {
    const double s = k / pieces, r = 1 - s;
    const Place<D> p = r * r * (1 + 2 * s) * p0 + s * s * (1 + 2 * r) * p1 + step * s * r * (r * v0 - s * v1);
    points.add(t0 + s * step, p, false);
  }
}

template <int D>
Points<D> curve_through(const std::vector<double>& time, const std::vector<Place<D>>& place,
                        const std::vector<Place<D>>& velocity) {
  Points<D> points;
  for (size_t k = 0; k < time.size(); ++k) {
    const bool rested = k > 0 && place[k] == place[k - 1];
    const bool rests = k + 1 < time.size() && place[k] == place[k + 1];
    points.add(time[k], place[k], rested != rests);
    if (k + 1 < time.size() && !velocity.empty() && !rests)
      add_cubic<D>(time[k], time[k + 1], place[k], place[k + 1], velocity[k], velocity[k + 1], points);
  }
  return points;
}

/// Indices of as few points as leave all others within kThinning of the lines between them, in
/// one pass: the slopes that a line from the last one kept may have narrow with every point.
template <int D>
std::vector<size_t> thinned(const Points<D>& points) {
  std::vector<size_t> kept{0};
  Place<D> low, high;
  const auto open = [&] {
    low.setConstant(-std::numeric_limits<double>::infinity());
    high.setConstant(std::numeric_limits<double>::infinity());
  };
  open();
  for (size_t k = 1; k < points.time.size(); ++k) {
    const auto slope = [&](size_t from) -> Place<D> {
      return (points.place[k] - points.place[from]) / (points.time[k] - points.time[from]);
    };
    Place<D> now = slope(kept.back());
    if (!((now.array() >= low.array()).all() && (now.array() <= high.array()).all())) {
      kept.push_back(k - 1);
      open();
      now = slope(k - 1);
    }
    const double slack = kThinning / (points.time[k] - points.time[kept.back()]);
    low = low.cwiseMax((now.array() - slack).matrix());
    high = high.cwiseMin((now.array() + slack).matrix());
    if (!points.stays[k]) continue;
    kept.push_back(k);
    open();
  }
  if (kept.back() + 1 < points.time.size()) kept.push_back(points.time.size() - 1);
  return kept;
}

std::vector<Place<1>> as_places(const std::vector<double>& values) {
  std::vector<Place<1>> places;
  places.reserve(values.size());
  for (const double value : values) places.emplace_back(Place<1>(value));
  return places;
}

/// A path whose first knot is at time 0.
/// @param knot_of  makes a knot of a time and a place.
template <int D, class KnotOf>
auto path_through(const std::vector<double>& time, const std::vector<Place<D>>& place,
                  const std::vector<Place<D>>& velocity, double start, const KnotOf& knot_of) {
  const Points<D> points = curve_through<D>(time, place, velocity);
  std::vector<decltype(knot_of(0.0, place.front()))> path;
  if (time.front() > start) path.push_back(knot_of(0.0, place.front()));
  for (const size_t k : thinned<D>(points)) path.push_back(knot_of(points.time[k] - start, points.place[k]));
  return path;
}

}  // namespace

Schedule schedule_through(const std::vector<GripperMotion>& motions) {
  double start = std::numeric_limits<double>::infinity();
  for (const GripperMotion& motion : motions) start = std::min(start, motion.time.front());
  Schedule schedule;
  for (size_t g = 0; g < motions.size(); ++g) {
    const GripperMotion& motion = motions[g];
    schedule.paths.push_back(path_through<1>(motion.time, as_places(motion.z), as_places(motion.vz), start,
                                             [](double time, const Place<1>& z) {
                                               return Knot{time, z.x()};
                                             }));
    if (!motion.xy.empty()) {
      schedule.plane_paths.push_back(
          path_through<2>(motion.time, motion.xy, motion.v_plane, start, [](double time, const Place<2>& xy) {
            return PlaneKnot{time, xy};
          }));
    }
    const auto off = std::find(motion.suction.begin(), motion.suction.end(), false);
    if (off == motion.suction.end()) continue;
    schedule.release.resize(motions.size());
    schedule.release[g] = motion.time[size_t(off - motion.suction.begin())] - start;
  }
  return schedule;
}

void level_start(const std::vector<Eigen::Vector2d>& start_xy, Schedule& schedule) {
  std::vector<double> heights;
  for (const auto& path : schedule.paths) heights.push_back(path.front().z);
  if (heights.empty()) return;
  const auto middle = heights.begin() + std::ptrdiff_t(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  for (auto& path : schedule.paths) {
    if (std::abs(path.front().z - *middle) <= kLevel) path.front().z = *middle;
  }
  for (size_t g = 0; g < schedule.plane_paths.size() && g < start_xy.size(); ++g) {
    Eigen::Vector2d& first = schedule.plane_paths[g].front().xy;
    if ((first - start_xy[g]).norm() <= kLevel) first = start_xy[g];
  }
}

}  // namespace drapeplan
