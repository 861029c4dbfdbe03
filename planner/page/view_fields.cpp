#include "planner/page/view_fields.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The cell of a line's places that holds a value; nothing beside the line.
std::optional<size_t> cell_of(const std::vector<double>& places, double value) {
  if (places.size() < 2 || !(value >= places.front() && value <= places.back())) return {};
  const auto above = std::upper_bound(places.begin(), places.end(), value);
  return std::min(size_t(above - places.begin()), places.size() - 1) - 1;
}

/// Of the net, which is bilinear in its cells; nothing beside it.
std::optional<Fibres> fibres_of(const Net& net, const Vector2d& at) {
  const std::optional<size_t> i = cell_of(net.u, at.x()), j = cell_of(net.v, at.y());
  if (!i || !j) return {};
  const double du = net.u[*i + 1] - net.u[*i], dv = net.v[*j + 1] - net.v[*j];
  const double s = (at.x() - net.u[*i]) / du, t = (at.y() - net.v[*j]) / dv;
  const auto node = [&](size_t right, size_t up) { return net.node(int(*i + right), int(*j + up)); };
  return Fibres{((1 - t) * (node(1, 0) - node(0, 0)) + t * (node(1, 1) - node(0, 1))) / du,
                ((1 - s) * (node(0, 1) - node(0, 0)) + s * (node(1, 1) - node(1, 0))) / dv};
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Of a quadrilateral in the flat ply [m^2].
double rest_area(const Mesh& mesh, const std::array<int, 4>& quad) {
  const Vector2d first = mesh.rest[size_t(quad[2])] - mesh.rest[size_t(quad[0])];
  const Vector2d second = mesh.rest[size_t(quad[3])] - mesh.rest[size_t(quad[1])];
  return 0.5 * std::abs(first.x() * second.y() - first.y() * second.x());
}

}  // namespace

Fibres element_fibres(const Mesh& mesh, const std::array<int, 4>& quad,
                      const std::vector<Vector3d>& position) {
  // Bilinear shape functions at the middle: +-1/4 along either edge of the reference square.
  constexpr std::array<double, 4> kXi{-0.25, 0.25, 0.25, -0.25}, kEta{-0.25, -0.25, 0.25, 0.25};
  Eigen::Matrix2d rest = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 3, 2> place = Eigen::Matrix<double, 3, 2>::Zero();
  for (size_t k = 0; k < 4; ++k) {
    const Eigen::RowVector2d slope(kXi[k], kEta[k]);
    rest += mesh.rest[size_t(quad[k])] * slope;
    place += position[size_t(quad[k])] * slope;
  }
  const Eigen::Matrix<double, 3, 2> gradient = place * rest.inverse();
  return {gradient.col(0), gradient.col(1)};
}

std::vector<double> nodal_means(const Mesh& mesh, const std::vector<double>& values) {
  std::vector<double> sums(mesh.rest.size(), 0.0), counts(mesh.rest.size(), 0.0);
  for (size_t e = 0; e < values.size(); ++e) {
    if (!std::isfinite(values[e])) continue;
    for (const int node : mesh.quads[e]) {
      sums[size_t(node)] += values[e];
      ++counts[size_t(node)];
    }
  }
  for (size_t n = 0; n < sums.size(); ++n) sums[n] = counts[n] > 0 ? sums[n] / counts[n] : kNaN;
  return sums;
}

std::vector<double> fibre_angle_offsets(const Mesh& mesh, const std::vector<Vector3d>& position,
                                        const Net& net) {
  std::vector<double> offsets;
  for (const auto& quad : mesh.quads) {
    Vector2d middle(0, 0);
    for (const int node : quad) middle += 0.25 * mesh.rest[size_t(node)];
    const std::optional<Fibres> mapped = fibres_of(net, middle);
    if (!mapped) {
      offsets.push_back(kNaN);
      continue;
    }
    const Fibres draped = element_fibres(mesh, quad, position);
    const Vector3d normal = mapped->warp.cross(mapped->weft).normalized();
    const auto offset = [&](const Vector3d& fibre, const Vector3d& wanted) {
      return angle_between(fibre - normal * normal.dot(fibre), wanted);
    };
    offsets.push_back(std::max(offset(draped.warp, mapped->warp), offset(draped.weft, mapped->weft)));
  }
  return offsets;
}

double share_within(const Mesh& mesh, const std::vector<double>& values, double limit) {
  double within = 0, all = 0;
  for (size_t e = 0; e < values.size(); ++e) {
    const double area = rest_area(mesh, mesh.quads[e]);
    all += area;
    if (std::abs(values[e]) <= limit) within += area;
  }
  return all > 0 ? within / all : kNaN;
}

}  // namespace drapeplan
