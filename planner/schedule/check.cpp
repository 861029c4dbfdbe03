#include "planner/schedule/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

constexpr double kRounding = 1e-3;  // of a limit: times and heights of a schedule are rounded
constexpr double kScatter = 0.02;   // of a limit: a logged motion scatters
/// Shortest time over which velocities of a sampled motion are taken: encoders do not resolve less [s].
constexpr double kShortestWindow = 0.02;

Eigen::Vector3d place(const Knot& knot) {
  return {0, 0, knot.z};
}
Eigen::Vector3d place(const PlaneKnot& knot) {
  return {knot.xy.x(), knot.xy.y(), 0};
}

/// Largest change of velocity within one blend [m/s]: corners that are closer together than it add up.
template <class AnyKnot>
double largest_change(const std::vector<AnyKnot>& path, double blend_time,
                      const std::function<double(const Eigen::Vector3d&)>& norm) {
  struct Corner {
    double time;
    Eigen::Vector3d change;
  };
  std::vector<Corner> corners;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (size_t k = 0; k < path.size(); ++k) {
    Eigen::Vector3d after = Eigen::Vector3d::Zero();
    if (k + 1 < path.size())
      after = (place(path[k + 1]) - place(path[k])) / (path[k + 1].time - path[k].time);
    corners.push_back({path[k].time, after - before});
    before = after;
  }
  double largest = 0;
  for (size_t first = 0; first < corners.size(); ++first) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (size_t k = first; k < corners.size() && corners[k].time < corners[first].time + blend_time; ++k) {
      sum += corners[k].change;
      largest = std::max(largest, norm(sum));
    }
    largest = std::max(largest, norm(corners[first].change));
  }
  return largest;
}

/// What one gripper's motion is judged by.
struct Extremes {
  double velocity = 0;      ///< [m/s]
  double acceleration = 0;  ///< [m/s^2]
  double along_axis = 0;    ///< the same, largest component
};

/// Of what a rig can do, what a motion exceeds. @param slack  share of a limit that is no excess.
void add_excess(int gripper, const Extremes& extremes, double change_time, double slack,
                const RigOptions& rig, std::vector<std::string>& refusals) {
  if (rig.max_acceleration && extremes.acceleration > *rig.max_acceleration * (1 + slack))
    refusals.push_back(
        fmt::format("gripper {} accelerates by {:g} m/s^2, more than grippers.max_acceleration ({:g} m/s^2)",
                    rig.name(gripper), extremes.acceleration, *rig.max_acceleration));
  const double force = rig.pad_mass * extremes.along_axis;
  if (force > rig.actuator_force_limit * (1 + slack))
    refusals.push_back(fmt::format(
        "gripper {} needs {:g} N to change its velocity within the blend time of {:g} s, more than "
        "grippers.actuator_force_limit ({:g} N)",
        rig.name(gripper), force, change_time, rig.actuator_force_limit));
}

void add_velocity(double fastest, double slack, const RigOptions& rig, std::vector<std::string>& refusals) {
  if (fastest > rig.max_velocity * (1 + slack))
    refusals.push_back(fmt::format("moves at up to {:g} m/s, more than grippers.max_velocity ({:g} m/s)",
                                   fastest, rig.max_velocity));
}

template <class AnyKnot>
void add_accelerations(const std::vector<std::vector<AnyKnot>>& paths, double blend_time,
                       const RigOptions& rig, std::vector<std::string>& refusals) {
  for (size_t g = 0; g < paths.size(); ++g) {
    const auto length = [](const Eigen::Vector3d& v) { return v.norm(); };
    const auto along_axes = [](const Eigen::Vector3d& v) { return v.lpNorm<Eigen::Infinity>(); };
    const Extremes extremes{.acceleration = largest_change(paths[g], blend_time, length) / blend_time,
                            .along_axis = largest_change(paths[g], blend_time, along_axes) / blend_time};
    add_excess(int(g), extremes, blend_time, kRounding, rig, refusals);
  }
}

/// Central differences over `window` of a path without blends. They are piecewise linear in time, so they are
/// largest where one of their places is a knot.
/// @param at  place at a time.
template <class AnyKnot>
Extremes differences(const std::vector<AnyKnot>& path, double window,
                     const std::function<Eigen::Vector3d(double)>& at) {
  const double step = 0.5 * window;
  Extremes largest;
  for (const AnyKnot& knot : path) {
    for (const double time : {knot.time - step, knot.time, knot.time + step}) {
      const Eigen::Vector3d before = at(time - step), now = at(time), after = at(time + step);
      const Eigen::Vector3d change = (after - 2 * now + before) / (step * step);
      largest.velocity = std::max(largest.velocity, (after - before).norm() / window);
      largest.acceleration = std::max(largest.acceleration, change.norm());
      largest.along_axis = std::max(largest.along_axis, change.lpNorm<Eigen::Infinity>());
    }
  }
  return largest;
}

void add_sampled(const Schedule& schedule, const RigOptions& rig, std::vector<std::string>& refusals) {
  const double window = std::max(rig.blend_time, kShortestWindow);
  std::vector<std::string> accelerations;
  double fastest = 0;
  const auto see = [&](int g, const Extremes& extremes) {
    fastest = std::max(fastest, extremes.velocity);
    add_excess(g, extremes, window, kScatter, rig, accelerations);
  };
  for (int g = 0; g < int(schedule.paths.size()); ++g) {
    see(g, differences(schedule.paths[size_t(g)], window,
                       [&](double t) { return Eigen::Vector3d(0, 0, schedule.command(g, t).z); }));
    if (schedule.plane_paths.empty()) continue;
    see(g, differences(schedule.plane_paths[size_t(g)], window, [&](double t) {
          const Eigen::Vector2d xy = schedule.command(g, t).xy;
          return Eigen::Vector3d(xy.x(), xy.y(), 0);
        }));
  }
  add_velocity(fastest, kScatter, rig, refusals);
  refusals.insert(refusals.end(), accelerations.begin(), accelerations.end());
}

void add_blended(const Schedule& schedule, const RigOptions& rig, std::vector<std::string>& refusals) {
  const double fastest = schedule.largest_velocity();
  add_velocity(fastest, kRounding, rig, refusals);
  if (schedule.blend_time > 0) {
    add_accelerations(schedule.paths, schedule.blend_time, rig, refusals);
    add_accelerations(schedule.plane_paths, schedule.blend_time, rig, refusals);
  } else if (rig.max_acceleration && fastest > 0) {
    refusals.emplace_back(
        "changes its velocities at once: without a blend time no acceleration is small enough for "
        "grippers.max_acceleration");
  }
}

/// The longest that an interlink is at any time [m].
double longest(const RigOptions& rig, size_t link) {
  return std::max(rig.spacing, interlink_length(rig, link)) + rig.interlinks->play[1];
}

/// By how much the command of gripper a is above that of b.
Knot above(const Schedule& schedule, int a, int b, double time, double& rate) {
  const Command high = schedule.command(a, time), low = schedule.command(b, time);
  rate = high.vz - low.vz;
  return {time, high.z - low.z};
}

/// The instant at which two grippers are furthest apart in height, and by how much. Commanded heights are
/// parabolas between knots and ends of blends, and so are their differences: these are looked at at their
/// ends and vertices.
Knot furthest_apart(const Schedule& schedule, int a, int b, const std::set<double>& times) {
  Knot furthest{}, before{};
  double rate_before = 0;
  const auto look = [&](const Knot& at) {
    if (std::abs(at.z) > std::abs(furthest.z)) furthest = at;
  };
  for (const double time : times) {
    double rate = 0;
    const Knot now = above(schedule, a, b, time, rate);
    if (rate * rate_before < 0) {
      double none = 0;
      const double vertex = before.time + (time - before.time) * rate_before / (rate_before - rate);
      look(above(schedule, a, b, vertex, none));
    }
    look(now);
    before = now;
    rate_before = rate;
  }
  return furthest;
}

void add_stretched_interlinks(const Schedule& schedule, const RigOptions& rig,
                              std::vector<std::string>& refusals) {
  if (!rig.interlinks || rig.interlinks->stiffness) return;
  const auto links = interlinks(rig);
  for (size_t k = 0; k < links.size(); ++k) {
    const auto [a, b] = links[k];
    std::set<double> times;
    for (const int g : {a, b}) {
      for (const Knot& knot : schedule.paths[size_t(g)])
        times.insert({knot.time, knot.time + schedule.blend_time});
    }
    const Knot apart = furthest_apart(schedule, a, b, times);
    if (!(std::abs(apart.z) > longest(rig, k) * (1 + kRounding))) continue;
    refusals.push_back(
        fmt::format("grippers {} and {} are to be {:.1f} mm apart in height at {:.2f} s: their interlink is "
                    "{:.1f} mm long",
                    rig.name(a), rig.name(b), 1e3 * std::abs(apart.z), apart.time, 1e3 * longest(rig, k)));
  }
}

}  // namespace

std::vector<std::string> rig_refusals(const Schedule& schedule, const RigOptions& rig, PathKind kind) {
  std::vector<std::string> refusals;
  if (kind == PathKind::sampled)
    add_sampled(schedule, rig, refusals);
  else
    add_blended(schedule, rig, refusals);
  add_stretched_interlinks(schedule, rig, refusals);
  return refusals;
}

void require_playable(const Schedule& schedule, const RigOptions& rig) {
  if (const auto refusals = rig_refusals(schedule, rig); !refusals.empty())
    throw WrongInput(refusals.front());
}

}  // namespace drapeplan
