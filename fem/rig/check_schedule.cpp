// Which schedules a rig takes.
#include <fmt/format.h>

#include <cmath>

#include "fem/rig/gripper_rig.hpp"
#include "mapping/error.hpp"

namespace drapeplan {
namespace {

constexpr double kStartSlack = 1e-6;  // [m]; a schedule is rounded to it

bool is_finite(const Knot& knot) {
  return std::isfinite(knot.time) && std::isfinite(knot.z);
}
bool is_finite(const PlaneKnot& knot) {
  return std::isfinite(knot.time) && knot.xy.allFinite();
}

/// Files are checked when they are read; schedules may come from elsewhere.
template <class AnyKnot>
void check_knots(const RigOptions& rig, const std::vector<std::vector<AnyKnot>>& paths) {
  for (size_t g = 0; g < paths.size(); ++g) {
    const auto fail = [&](const char* what) {
      throw WrongInput(fmt::format("the path of gripper {} {}", rig.name(int(g)), what));
    };
    if (paths[g].empty()) fail("has no knots");
    for (size_t k = 0; k < paths[g].size(); ++k) {
      if (!is_finite(paths[g][k])) fail("has a knot that is not finite");
      if (k > 0 && !(paths[g][k].time > paths[g][k - 1].time)) fail("has times that do not increase");
    }
  }
}

}  // namespace

void GripperRig::check(const Schedule& schedule) const {
  check_knots(rig_, schedule.paths);
  check_knots(rig_, schedule.plane_paths);
  if (int(schedule.paths.size()) != rig_.count()) {
    throw WrongInput(
        fmt::format("the schedule has {} grippers, the rig {}", schedule.paths.size(), rig_.count()));
  }
  for (const auto& path : schedule.paths) {
    if (path.front().z != schedule.paths.front().front().z)
      throw WrongInput("joints must start at one height");
  }
  if (rig_.driven == Driven::z) {
    if (!schedule.plane_paths.empty())
      throw WrongInput("the schedule has in-plane paths, the rig drives its joints in z only");
    return;
  }
  if (schedule.plane_paths.size() != schedule.paths.size())
    throw WrongInput("the rig drives its joints in x, y and z: the schedule needs in-plane paths");
  for (int g = 0; g < rig_.count(); ++g) {
    const Eigen::Vector2d apart = schedule.plane_paths[size_t(g)].front().xy - place_[size_t(g)];
    if (apart.norm() <= kStartSlack) continue;
    throw WrongInput(fmt::format(
        "the in-plane path of gripper {} starts {:f} mm off its joint's place, ({:f}, {:f}) mm", rig_.name(g),
        1e3 * apart.norm(), 1e3 * place_[size_t(g)].x(), 1e3 * place_[size_t(g)].y()));
  }
}

}  // namespace drapeplan
