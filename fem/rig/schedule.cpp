#include "fem/rig/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace drapeplan {
namespace {

double place(const Knot& knot) {
  return knot.z;
}
const Eigen::Vector2d& place(const PlaneKnot& knot) {
  return knot.xy;
}

/// Place on the piecewise linear path at t, and its integral from the first knot to t; at rest outside.
template <class Value>
struct PathPoint {
  Value place, integral;
};

template <class Value, class AnyKnot>
PathPoint<Value> path_point(const std::vector<AnyKnot>& path, double t) {
  if (t <= path.front().time) return {place(path.front()), place(path.front()) * (t - path.front().time)};
  Value integral = 0 * place(path.front());
  for (size_t k = 1; k < path.size(); ++k) {
    const AnyKnot& a = path[k - 1];
    const AnyKnot& b = path[k];
    if (t < b.time) {
      const Value at = place(a) + (place(b) - place(a)) * (t - a.time) / (b.time - a.time);
      return {at, integral + 0.5 * (place(a) + at) * (t - a.time)};
    }
    integral += 0.5 * (place(a) + place(b)) * (b.time - a.time);
  }
  return {place(path.back()), integral + place(path.back()) * (t - path.back().time)};
}

/// Place on the piecewise linear path at t, of paths with thousands of knots, too; at rest outside.
template <class Value, class AnyKnot>
Value place_at(const std::vector<AnyKnot>& path, double t) {
  const auto next = std::upper_bound(path.begin(), path.end(), t,
                                     [](double time, const AnyKnot& knot) { return time < knot.time; });
  if (next == path.begin()) return place(path.front());
  if (next == path.end()) return place(path.back());
  const AnyKnot& a = *(next - 1);
  return place(a) + (place(*next) - place(a)) * (t - a.time) / (next->time - a.time);
}

/// Moving average over the last `blend_time`, and its rate.
template <class Value, class AnyKnot>
void blend(const std::vector<AnyKnot>& path, double t, double blend_time, Value& at, Value& rate) {
  if (blend_time <= 0) {
    constexpr double kProbe = 1e-6;  // [s], for the slope of a path without blending
    at = place_at<Value>(path, t);
    rate = (place_at<Value>(path, t + kProbe) - at) / kProbe;
    return;
  }
  const PathPoint<Value> now = path_point<Value>(path, t);
  const PathPoint<Value> before = path_point<Value>(path, t - blend_time);
  at = (now.integral - before.integral) / blend_time;
  rate = (now.place - before.place) / blend_time;
}

double length(double v) {
  return std::abs(v);
}
double length(const Eigen::Vector2d& v) {
  return v.norm();
}

template <class AnyKnot>
double largest_speed(const std::vector<std::vector<AnyKnot>>& paths) {
  double largest = 0;
  for (const auto& path : paths) {
    for (size_t k = 1; k < path.size(); ++k) {
      const double way = length(place(path[k]) - place(path[k - 1]));
      largest = std::max(largest, way / (path[k].time - path[k - 1].time));
    }
  }
  return largest;
}

/// Time of the last knot that differs from the one before it [s].
template <class AnyKnot>
double last_change(const std::vector<std::vector<AnyKnot>>& paths) {
  double last = 0;
  for (const auto& path : paths) {
    for (size_t k = path.size(); k-- > 1;) {
      if (place(path[k]) == place(path[k - 1])) continue;
      last = std::max(last, path[k].time);
      break;
    }
  }
  return last;
}

}  // namespace

Command Schedule::command(int gripper, double t) const {
  Command command;
  blend(paths[size_t(gripper)], t, blend_time, command.z, command.vz);
  if (!plane_paths.empty()) {
    blend(plane_paths[size_t(gripper)], t, blend_time, command.xy, command.v_plane);
  }
  return command;
}

bool Schedule::released(int gripper, double t) const {
  return size_t(gripper) < release.size() && release[size_t(gripper)] && t >= *release[size_t(gripper)];
}

double Schedule::duration() const {
  double last = 0;
  for (const auto& path : paths) last = std::max(last, path.back().time);
  for (const auto& path : plane_paths) last = std::max(last, path.back().time);
  return last + blend_time;
}

double Schedule::last_stroke() const {
  return std::max(last_change(paths), last_change(plane_paths)) + blend_time;
}

double Schedule::last_motion() const {
  double last = last_stroke();
  for (const auto& time : release) last = std::max(last, time.value_or(0));
  return last;
}

double Schedule::largest_velocity() const {
  return std::max(largest_speed(paths), largest_speed(plane_paths));
}

}  // namespace drapeplan
