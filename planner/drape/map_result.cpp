#include "planner/drape/map_result.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// From here on a gripper is told to stand beside its target. Tilt and joint offset account for less; and on
// the shipped cases, whose plies lie as they say, a rotation is fitted to the draping that moves no gripper
// by 3 mm.
constexpr double kMisplaced = 0.010;  // [m]
// 10 mm over 100 mm of fibre. The way to a mid-side bends by up to 5 degrees on the mold of [Krogh].
constexpr double kWarpTurned = 6;  // [deg]

/// Place in plan of a ply point before draping [m].
Eigen::Vector2d flat_place(const Ply& ply, const Eigen::Vector2d& uv) {
  return ply.position + Eigen::Rotation2Dd(ply.angle) * uv;
}

/// Angle from a to b, counter-clockwise [rad]; 0 if one of them is 0.
double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

/// The larger of the angles between ply.angle and both halves of the warp at the start, signed [deg].
double warp_turn_deg(const Case& definition, const Net& net) {
  const Eigen::Vector2d start = definition.mapping->ply_start;
  const auto nearest = [](const std::vector<double>& lines, double at) {
    const auto closer = [at](double a, double b) { return std::abs(a - at) < std::abs(b - at); };
    return int(std::min_element(lines.begin(), lines.end(), closer) - lines.begin());
  };
  const int i = nearest(net.u, start.x()), j = nearest(net.v, start.y());
  const Eigen::Vector2d warp = Eigen::Rotation2Dd(definition.ply.angle) * Eigen::Vector2d::UnitX();
  double turn = 0;
  for (const int way : {1, -1}) {
    if (i + way < 0 || i + way >= int(net.u.size())) continue;
    const Eigen::Vector2d half = way * (net.node(i + way, j) - net.node(i, j)).head<2>();
    const double angle = kDegrees * angle_between(warp, half);
    if (std::abs(angle) > std::abs(turn)) turn = angle;
  }
  return turn;
}

std::string placement_warning(const Case& definition, const Placement& placement) {
  const std::string farthest = definition.grippers
                                   ? "the target of gripper " + definition.grippers->name(placement.gripper)
                                   : "a corner of the ply";
  return fmt::format(
      "the mapping lays the ply elsewhere than ply.position and ply.angle say: shifted by {:.1f} mm and "
      "turned "
      "by {:.1f} deg, its warp at the start by {:.1f} deg. Shift and turn alone move {} up to {:.1f} mm in "
      "plan; {} stands {:.1f} mm beside its flat place. Check mapping.generators, mapping.start and "
      "mapping.ply_start",
      1e3 * placement.shift, std::abs(placement.turn_deg), std::abs(placement.warp_turn_deg),
      definition.grippers ? "a gripper" : "a corner", 1e3 * placement.moved, farthest,
      1e3 * placement.farthest);
}

}  // namespace

MapResult map_case(const Case& definition) {
  MapResult result;
  try {
    result.net = map_ply(*definition.mold, definition.ply, *definition.mapping);
  } catch (const NotFinished& error) {
    throw NotFinished(fmt::format("the ply cannot be mapped: {}", error.what()));
  }
  result.boundary = prescribed_boundary(result.net, *definition.mold, definition.ply);
  result.corners = mapped_corners(result.net);
  const int grippers = definition.grippers ? definition.grippers->count() : 0;
  for (int k = 0; k < grippers; ++k) {
    result.targets.push_back(mapped_point(result.net, *definition.mold, definition.grippers->place(k)));
  }
  const std::vector<double> shear = shear_field(result.net);
  const std::vector<double>& u = result.net.u;
  const std::vector<double>& v = result.net.v;
  double area = 0;
  for (size_t j = 0; j + 1 < v.size(); ++j) {
    for (size_t i = 0; i + 1 < u.size(); ++i) {
      const Eigen::Vector2d middle(0.5 * (u[i] + u[i + 1]), 0.5 * (v[j] + v[j + 1]));
      if (!definition.ply.outline.empty() && !contains(definition.ply.outline, middle)) continue;
      const double cell = (u[i + 1] - u[i]) * (v[j + 1] - v[j]);
      const double magnitude = kDegrees * std::abs(shear[i + j * (u.size() - 1)]);
      result.max_shear_deg = std::max(result.max_shear_deg, magnitude);
      result.mean_shear_deg += cell * magnitude;
      area += cell;
    }
  }
  if (area > 0) result.mean_shear_deg /= area;  // not for a strip narrower than a cell
  return result;
}

Placement placement_of(const Case& definition, const MapResult& map) {
  const Ply& ply = definition.ply;
  std::vector<Eigen::Vector2d> flat;
  if (definition.grippers) {
    for (int k = 0; k < definition.grippers->count(); ++k)
      flat.push_back(flat_place(ply, definition.grippers->place(k)));
  } else {
    const Eigen::AlignedBox2d box = bounding_box(corners_of(ply));
    for (const auto corner : {box.BottomLeft, box.BottomRight, box.TopRight, box.TopLeft})
      flat.push_back(flat_place(ply, box.corner(corner)));
  }
  const std::vector<Eigen::Vector3d>& mapped = definition.grippers ? map.targets : map.corners;
  const Eigen::Vector2d flat_start = flat_place(ply, definition.mapping->ply_start);
  const Eigen::Vector2d start = definition.mapping->start;

  // The rotation that fits best in least squares, of places about the start.
  double along = 0, across = 0;
  for (size_t k = 0; k < flat.size(); ++k) {
    const Eigen::Vector2d from = flat[k] - flat_start, to = mapped[k].head<2>() - start;
    along += from.dot(to);
    across += from.x() * to.y() - from.y() * to.x();
  }
  const double turn = std::atan2(across, along);

  Placement placement;
  placement.shift = (start - flat_start).norm();
  placement.turn_deg = kDegrees * turn;
  placement.warp_turn_deg = warp_turn_deg(definition, map.net);
  for (size_t k = 0; k < flat.size(); ++k) {
    const Eigen::Vector2d rigid = start + Eigen::Rotation2Dd(turn) * (flat[k] - flat_start);
    placement.moved = std::max(placement.moved, (rigid - flat[k]).norm());
    const double apart = (mapped[k].head<2>() - flat[k]).norm();
    if (!(apart > placement.farthest)) continue;
    placement.farthest = apart;
    placement.gripper = int(k);
  }
  return placement;
}

std::vector<std::string> map_warnings(const Case& definition, const MapResult& map) {
  std::vector<std::string> warnings;
  if (!map.net.converged)
    warnings.emplace_back("the mapping of a cell has not converged: its shear is not exact");
  const Extent& extent = definition.mold->extent();
  double beyond = 0;
  for (const Eigen::Vector3d& p : map.boundary) {
    const Eigen::Vector2d xy = p.head<2>();
    beyond = std::max({beyond, (extent.lower - xy).maxCoeff(), (xy - extent.upper).maxCoeff()});
  }
  if (beyond > 0) {
    warnings.push_back(
        fmt::format("the mapped ply reaches {:.1f} mm beyond mold.extent; the mold's formula goes on there",
                    1e3 * beyond));
  }
  if (map.max_shear_deg > definition.score.locking_angle_deg) {
    warnings.push_back(
        fmt::format("the mapping needs {:.1f} deg of shear, more than score.locking_angle ({:.1f} deg)",
                    map.max_shear_deg, definition.score.locking_angle_deg));
  }
  const Placement placement = placement_of(definition, map);
  if (placement.moved > kMisplaced || std::abs(placement.warp_turn_deg) > kWarpTurned)
    warnings.push_back(placement_warning(definition, placement));
  if (definition.grippers && definition.grippers->fixed) {
    const int index = definition.grippers->gripper_at(*definition.grippers->fixed);
    const Eigen::Vector2d place = flat_place(definition.ply, definition.grippers->place(index));
    const double apart = (map.targets[size_t(index)].head<2>() - place).norm();
    if (apart > kMisplaced) {
      warnings.push_back(
          fmt::format("the fixed gripper {} stands {:.1f} mm beside its target in plan: check ply.position "
                      "and mapping.start",
                      definition.grippers->name(index), 1e3 * apart));
    }
  }
  return warnings;
}

}  // namespace drapeplan
