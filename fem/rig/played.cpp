#include "fem/rig/played.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace drapeplan {
namespace {

constexpr double kSamePlace = 1e-9;  // [m]
constexpr double kSameTime = 1e-9;   // [s]

double& place(Knot& knot) {
  return knot.z;
}
Eigen::Vector2d& place(PlaneKnot& knot) {
  return knot.xy;
}
double distance(const Knot& a, const Knot& b) {
  return std::abs(a.z - b.z);
}
double distance(const PlaneKnot& a, const PlaneKnot& b) {
  return (a.xy - b.xy).norm();
}

/// The point of a path at time t.
template <class AnyKnot>
AnyKnot point(const std::vector<AnyKnot>& path, double t) {
  const auto next =
      std::find_if(path.begin(), path.end(), [t](const AnyKnot& knot) { return knot.time > t; });
  AnyKnot at = next == path.begin() ? path.front() : *std::prev(next);
  if (next != path.begin() && next != path.end()) {
    AnyKnot to = *next;
    place(at) += (place(to) - place(at)) * ((t - at.time) / (to.time - at.time));
  }
  at.time = t;
  return at;
}

template <class AnyKnot>
std::vector<AnyKnot> path_until(const std::vector<AnyKnot>& path, double until) {
  std::vector<AnyKnot> played;
  for (const AnyKnot& knot : path) {
    if (knot.time < until) played.push_back(knot);
  }
  played.push_back(point(path, until));
  return played;
}

/// Paths are linear between knots: they are the same where they are so at the knots of both.
template <class AnyKnot>
std::string path_difference(const std::vector<AnyKnot>& path, const std::vector<AnyKnot>& other,
                            double until) {
  std::vector<double> times{until};
  for (const auto* one : {&path, &other}) {
    for (const AnyKnot& knot : *one) {
      if (knot.time < until) times.push_back(knot.time);
    }
  }
  std::sort(times.begin(), times.end());
  for (const double t : times) {
    const double apart = distance(point(path, t), point(other, t));
    if (!(apart <= kSamePlace)) return fmt::format("is {:.3g} mm off at {:.4g} s", 1e3 * apart, t);
  }
  return {};
}

template <class AnyKnot>
std::string paths_difference(const RigOptions& rig, const std::vector<std::vector<AnyKnot>>& paths,
                             const std::vector<std::vector<AnyKnot>>& others, double until) {
  if (paths.size() != others.size())
    return fmt::format("{} paths instead of {}", paths.size(), others.size());
  for (size_t g = 0; g < paths.size(); ++g) {
    const std::string difference = path_difference(paths[g], others[g], until);
    if (!difference.empty()) return fmt::format("gripper {} {}", rig.name(int(g)), difference);
  }
  return {};
}

/// When a gripper has let go; infinity if not by `until`.
double release(const Schedule& schedule, size_t gripper, double until) {
  return schedule.released(int(gripper), until) ? *schedule.release[gripper] : HUGE_VAL;
}

std::string release_difference(const RigOptions& rig, const Schedule& schedule, const Schedule& other,
                               double until) {
  for (size_t g = 0; g < schedule.paths.size(); ++g) {
    const double here = release(schedule, g, until), there = release(other, g, until);
    if (here == there || std::abs(here - there) <= kSameTime) continue;
    return fmt::format("gripper {} lets go at another time", rig.name(int(g)));
  }
  return {};
}

}  // namespace

Schedule played_until(const Schedule& schedule, double until) {
  Schedule played;
  played.blend_time = schedule.blend_time;
  for (const auto& path : schedule.paths) played.paths.push_back(path_until(path, until));
  for (const auto& path : schedule.plane_paths) played.plane_paths.push_back(path_until(path, until));
  for (const auto& time : schedule.release)
    played.release.push_back(time && *time <= until ? time : std::nullopt);
  return played;
}

std::string difference_until(const RigOptions& rig, const Schedule& schedule, const Schedule& other,
                             double until) {
  if (std::abs(schedule.blend_time - other.blend_time) > kSameTime) {
    return fmt::format("changes of velocity take {:.4g} s instead of {:.4g} s", schedule.blend_time,
                       other.blend_time);
  }
  std::string difference = paths_difference(rig, schedule.paths, other.paths, until);
  if (difference.empty()) difference = paths_difference(rig, schedule.plane_paths, other.plane_paths, until);
  return difference.empty() ? release_difference(rig, schedule, other, until) : difference;
}

}  // namespace drapeplan
