#include "planner/drape/map_result.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "mapping/error.hpp"

namespace drapeplan {

MapResult map_case(const Case& definition) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  MapResult result;
  try {
    result.net = map_ply(*definition.mold, definition.ply, *definition.mapping);
  } catch (const NotFinished& error) {
    throw NotFinished(std::string("the ply cannot be mapped: ") + error.what());
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

std::vector<std::string> map_warnings(const Case& definition, const MapResult& map) {
  constexpr double kMisplaced = 0.010;  // [m]; tilt and joint offset account for less
  std::vector<std::string> warnings;
  char text[300];
  if (!map.net.converged)
    warnings.emplace_back("the mapping of a cell has not converged: its shear is not exact");
  const Extent& extent = definition.mold->extent();
  double beyond = 0;
  for (const Eigen::Vector3d& p : map.boundary) {
    const Eigen::Vector2d xy = p.head<2>();
    beyond = std::max({beyond, (extent.lower - xy).maxCoeff(), (xy - extent.upper).maxCoeff()});
  }
  if (beyond > 0) {
    std::snprintf(text, sizeof text,
                  "the mapped ply reaches %.1f mm beyond mold.extent; the mold's formula goes on there",
                  1e3 * beyond);
    warnings.emplace_back(text);
  }
  if (map.max_shear_deg > definition.score.locking_angle_deg) {
    std::snprintf(text, sizeof text,
                  "the mapping needs %.1f deg of shear, more than score.locking_angle (%.1f deg)",
                  map.max_shear_deg, definition.score.locking_angle_deg);
    warnings.emplace_back(text);
  }
  if (definition.grippers && definition.grippers->fixed) {
    const int index = definition.grippers->gripper_at(*definition.grippers->fixed);
    const Eigen::Vector2d place = definition.ply.position + Eigen::Rotation2Dd(definition.ply.angle) *
                                                                definition.grippers->place(index);
    const double apart = (map.targets[size_t(index)].head<2>() - place).norm();
    if (apart > kMisplaced) {
      std::snprintf(text, sizeof text,
                    "the fixed gripper %s stands %.1f mm beside its target in plan: check ply.position and "
                    "mapping.start",
                    definition.grippers->name(index).c_str(), 1e3 * apart);
      warnings.emplace_back(text);
    }
  }
  return warnings;
}

}  // namespace drapeplan
