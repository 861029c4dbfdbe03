#include "planner/map_result.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drapeplan {

MapResult map_case(const Case& value) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  MapResult result;
  result.net = map_ply(*value.mold, value.ply, *value.mapping);
  result.boundary = prescribed_boundary(result.net);
  result.corners = mapped_corners(result.net);
  const int grippers = value.grippers ? value.grippers->count() : 0;
  for (int k = 0; k < grippers; ++k) {
    result.targets.push_back(mapped_point(result.net, *value.mold, value.grippers->place(k)));
  }
  const std::vector<double> shear = shear_field(result.net);
  const std::vector<double>& u = result.net.u;
  const std::vector<double>& v = result.net.v;
  double area = 0;
  for (size_t j = 0; j + 1 < v.size(); ++j) {
    for (size_t i = 0; i + 1 < u.size(); ++i) {
      const double cell = (u[i + 1] - u[i]) * (v[j + 1] - v[j]);
      const double magnitude = kDegrees * std::abs(shear[i + j * (u.size() - 1)]);
      result.max_shear_deg = std::max(result.max_shear_deg, magnitude);
      result.mean_shear_deg += cell * magnitude;
      area += cell;
    }
  }
  result.mean_shear_deg /= area;
  return result;
}

}  // namespace drapeplan
