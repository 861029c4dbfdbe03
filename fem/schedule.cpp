#include "fem/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace drapeplan {
namespace {

/// Height of the piecewise linear path at t, and its integral from the first knot to t; at rest outside.
struct PathPoint {
  double z = 0, integral = 0;
};

PathPoint path_point(const std::vector<Knot>& path, double t) {
  double integral = 0;
  if (t <= path.front().time) return {path.front().z, path.front().z * (t - path.front().time)};
  for (size_t k = 1; k < path.size(); ++k) {
    const Knot& a = path[k - 1];
    const Knot& b = path[k];
    if (t < b.time) {
      const double z = a.z + (b.z - a.z) * (t - a.time) / (b.time - a.time);
      return {z, integral + 0.5 * (a.z + z) * (t - a.time)};
    }
    integral += 0.5 * (a.z + b.z) * (b.time - a.time);
  }
  return {path.back().z, integral + path.back().z * (t - path.back().time)};
}

}  // namespace

Command Schedule::command(int gripper, double t) const {
  const auto& path = paths[size_t(gripper)];
  if (blend_time <= 0) {
    constexpr double kProbe = 1e-6;  // [s], for the slope of a path without blending
    const double z = path_point(path, t).z;
    return {z, (path_point(path, t + kProbe).z - z) / kProbe};
  }
  const PathPoint now = path_point(path, t);
  const PathPoint before = path_point(path, t - blend_time);
  return {(now.integral - before.integral) / blend_time, (now.z - before.z) / blend_time};
}

double Schedule::duration() const {
  double last = 0;
  for (const auto& path : paths) last = std::max(last, path.back().time);
  return last + blend_time;
}

double Schedule::last_motion() const {
  double last = 0;
  for (const auto& path : paths) {
    for (size_t k = path.size(); k-- > 1;) {
      if (path[k].z == path[k - 1].z) continue;
      last = std::max(last, path[k].time);
      break;
    }
  }
  return last + blend_time;
}

double Schedule::largest_velocity() const {
  double largest = 0;
  for (const auto& path : paths) {
    for (size_t k = 1; k < path.size(); ++k) {
      largest = std::max(largest, std::abs((path[k].z - path[k - 1].z) / (path[k].time - path[k - 1].time)));
    }
  }
  return largest;
}

}  // namespace drapeplan
