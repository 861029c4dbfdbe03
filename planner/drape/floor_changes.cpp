#include "planner/drape/floor_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mapping/error.hpp"
#include "planner/drape/problem.hpp"

namespace drapeplan {
namespace {

constexpr double kPlay = 0.002;        // [m]: of a simple hinge or a slotted bar
constexpr double kStartShift = 0.010;  // [m]: of the mapping's start
constexpr double kSmallPad = 0.25;     // of the pad's radius
constexpr double kTold = 1e-4;         // [m]: changes that lower the floor by less are not told

bool has_rigid_links(const RigOptions& rig) {
  return rig.interlinks && !rig.interlinks->stiffness && !interlinks(rig).empty();
}

/// One more line of grippers across the shorter side of the grid over the same extent, and as many across the
/// other side as fit in its own; the fixed joint goes to the gripper nearest to its place.
RigOptions denser(RigOptions rig) {
  const RigOptions before = rig;
  const int few = std::min(rig.columns, rig.rows) > 1 ? std::min(rig.columns, rig.rows)
                                                      : std::max(rig.columns, rig.rows);
  const double factor = double(few - 1) / few;  // of the spacing
  constexpr double kRoundOff = 1e-9;
  const auto finer = [&](int count) { return 1 + int(std::floor((count - 1) / factor + kRoundOff)); };
  rig.spacing *= factor;
  rig.columns = finer(rig.columns), rig.rows = finer(rig.rows);
  if (rig.fixed) {
    const Eigen::Vector2d place = before.place(before.gripper_at(*rig.fixed)) / rig.spacing;
    const auto nearest = [](double from_middle, int count) {
      return std::clamp(1 + int(std::lround(from_middle + 0.5 * (count - 1))), 1, count);
    };
    rig.fixed = {nearest(place.x(), rig.columns), nearest(place.y(), rig.rows)};
  }
  if (rig.interlinks) rig.interlinks->lengths.clear();
  return rig;
}

std::string millimetres(double length) {
  return fmt::format("{:.1f} mm", 1e3 * length);
}

}  // namespace

std::vector<FloorChange> floor_changes(const Case& definition) {
  std::vector<FloorChange> changes;
  const auto add = [&](const std::string& name, const std::string& words, auto change) {
    changes.push_back({name, words, definition});
    change(changes.back().definition);
  };
  const RigOptions& rig = *definition.grippers;
  if (has_rigid_links(rig)) {
    if (definition.interlink_length.source != InterlinkLength::Source::mapped) {
      add("mapped_interlinks", "interlinks as long as mapped", [](Case& c) {
        c.interlink_length = {};
        c.interlink_length.source = InterlinkLength::Source::mapped;
        c.grippers->interlinks->lengths.clear();
      });
    }
    add("play", "a play of +-" + millimetres(kPlay) + " in the interlinks", [](Case& c) {
      c.grippers->interlinks->play = {kPlay, kPlay};
    });
  }
  if (rig.joint_offset > 0) {
    add("joint_offset", "joints at the ply instead of " + millimetres(rig.joint_offset) + " above it",
        [](Case& c) { c.grippers->joint_offset = 0; });
  }
  add("small_pads", "pads of " + millimetres(kSmallPad * rig.pad_radius) + " radius",
      [](Case& c) { c.grippers->pad_radius *= kSmallPad; });
  if (std::max(rig.columns, rig.rows) > 1) {
    const RigOptions more = denser(rig);
    add("more_grippers",
        fmt::format("{} x {} grippers every {}", more.columns, more.rows, millimetres(more.spacing)),
        [&](Case& c) {
          c.grippers = more;
          if (c.interlink_length.source == InterlinkLength::Source::given) c.interlink_length = {};
        });
  }
  if (rig.fixed) {
    add("no_fixed_joint", "no joint fixed in-plane (at the best place and turn of the ply)",
        [](Case& c) { c.grippers->fixed.reset(); });
  }
  for (const Eigen::Vector2d& way : {Eigen::Vector2d(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
    const Eigen::Vector2d shift = kStartShift * way;
    add(fmt::format("mapping_start_{:+.0f}_{:+.0f}_mm", 1e3 * shift.x(), 1e3 * shift.y()),
        fmt::format("ply and mapping's start shifted by ({:.0f}, {:.0f}) mm", 1e3 * shift.x(),
                    1e3 * shift.y()),
        [&](Case& c) { c.mapping->start += shift, c.ply.position += shift; });
  }
  return changes;
}

std::vector<ChangedFloor> solve_changes(const std::vector<FloorChange>& changes, double tolerance,
                                        double cell, double fibre_strain) {
  std::vector<ChangedFloor> floors;
  for (const FloorChange& change : changes) {
    ChangedFloor floor{change.name, change.words, {}};
    floor.point.boundary_tolerance = tolerance;
    floor.point.gap = floor.point.rms_gap = floor.point.boundary_offset = NAN;
    try {
      FloorProblem problem = floor_problem_of(change.definition, map_case(change.definition), cell);
      problem.fibre_strain = fibre_strain;
      FloorOptions options;
      options.tolerances = {tolerance};
      options.random_starts = 0;
      floor.point = solve_floor(problem, options).points.front();
    } catch (const WrongInput& error) {
      floor.point.status = error.what();
    } catch (const NotFinished& error) {
      floor.point.status = error.what();
    }
    floors.push_back(std::move(floor));
  }
  return floors;
}

std::string explain_changes(const FloorPoint& floor, const std::vector<ChangedFloor>& changes) {
  std::vector<const ChangedFloor*> sorted;
  for (const ChangedFloor& change : changes) {
    const bool lower = change.point.converged && (!floor.converged || change.point.gap < floor.gap - kTold);
    if (lower) sorted.push_back(&change);
  }
  if (sorted.empty()) return "";
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto* a, const auto* b) { return a->point.gap < b->point.gap; });
  std::string text;
  for (const ChangedFloor* change : sorted) {
    text += (text.empty() ? "The floor would be " : ", ") + millimetres(change->point.gap) + " with " +
            change->words;
  }
  return text + ".";
}

}  // namespace drapeplan
